/* Motions: asked for, kept going by signs of life, followed to their end, and stopped. */
#include "client_can.h"
#include "client_modbus.h"
#include "command.h"

#include <poll.h>

#include "brace/backlash_types.h"
#include "brace/can_messages.h"
#include "brace/codes.h"
#include "brace/loading.h"
#include "brace/status.h"

enum { POLL_US = 20000, PAUSE_MS = 10, STEP_MS = 100, STOP_MS = 100 };
enum {
    NEWS_US = 1000000,
    LIMIT_MOST_MS = 3600000,
    BEGIN_US = 300000 /* by then what has been asked for runs, or will not */
};
enum { FLANK_POSITIVE = 256, FLANK_NEGATIVE = 512, ANY_VALUE = 1, JOINTS = 3 };
enum { NOT_IN_THIS_MODE = 1 /* exception of Modbus */ };
enum { OUTCOME_RUNNING = BRACE_TAKEUP_RUNNING }; /* of a loading test, too */
_Static_assert((int)BRACE_TAKEUP_RUNNING == (int)BRACE_LOADING_RUNNING, "one number for both");

/* ---------------------------------------------------------------------------------------- signs of life -- */

/* Gives a sign of life if one is due. */
static void tend(brace_client_t *client, uint64_t deadline_us)
{
    if (client->bus != NULL) {
        brace_can_tend(client);
    } else {
        brace_modbus_tend(client, deadline_us);
    }
}

/* The number in hand may be old. The controller refuses it then, and sends the one of now. */
static void live(brace_client_t *client, uint64_t deadline_us)
{
    client->next_life_us = client->lives ? client->next_life_us : 0u;
    client->lives = true;
    tend(client, deadline_us);
}

/* ---------------------------------------------------------------------------------------- how it goes -- */

static bool is_under_way(const brace_client_t *client)
{
    return client->motion.now.state == BRACE_MOTION_ASKED || client->motion.now.state == BRACE_MOTION_RUNNING;
}

static void end(brace_client_t *client, brace_motion_state_t state, int32_t reason, const char *why)
{
    client->lives = false;
    client->motion.now = (brace_motion_t){.state = state, .reason = reason};
    (void)brace_client_fail(client, BRACE_CLIENT_OK, "%s: %s", client->url, why);
}

/* What the controller reports of a motion. */
typedef struct {
    uint32_t outcome, mode, is_held, silences;
} progress_t;

static brace_client_status_t ask_progress(brace_client_t *client, uint64_t deadline_us, progress_t *progress)
{
    const bool takes_up = client->motion.kind == BRACE_TAKES_UP;
    const struct {
        uint32_t index;
        uint32_t *value;
    } entries[] = {
        {takes_up ? BRACE_CLIENT_ENTRY(take_up_coxa) + client->motion.joint : BRACE_CLIENT_ENTRY(loading_outcome),
         &progress->outcome},
        {BRACE_CLIENT_ENTRY(mode), &progress->mode},
        {BRACE_CLIENT_ENTRY(is_held), &progress->is_held},
        {BRACE_CLIENT_ENTRY(silences), &progress->silences}};
    for (size_t i = 0u; i < sizeof entries / sizeof entries[0]; i++) {
        const brace_client_status_t status =
            brace_client_entry_u32(client, entries[i].index, brace_bus_left_ms(deadline_us), entries[i].value);
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
    }
    return BRACE_CLIENT_OK;
}

/* May the limb still be on its way, or on its way back? In a fault it goes back, too, and the mode does not show when
 * it is there. */
static bool may_move(const progress_t *progress, uint32_t moving_mode)
{
    return progress->mode == moving_mode || progress->mode == BRACE_MODE_FAULT;
}

/* A take-up that runs or has ended. A failed one has ended when the limb is back. One that a fault has ended has no
 * outcome any more. */
static void judge_take_up(brace_client_t *client, const progress_t *progress, bool is_new)
{
    const int32_t outcome = brace_client_outcome(progress->outcome);
    if (outcome == (int32_t)BRACE_TAKEUP_DONE) {
        end(client, BRACE_MOTION_DONE, 0, brace_take_up_outcome_text(outcome));
    } else if (may_move(progress, BRACE_MODE_TAKING_UP)) {
        return;
    } else if (outcome < 0) {
        end(client, BRACE_MOTION_FAILED, outcome, brace_take_up_outcome_text(outcome));
    } else if (outcome == (int32_t)BRACE_TAKEUP_NONE && !is_new) {
        end(client, BRACE_MOTION_FAILED, 0,
            "a fault, a restart or somebody else has ended the take-up, and the limb is let go; look at the faults, "
            "and ask again");
    }
}

static void judge_loading_test(brace_client_t *client, const progress_t *progress)
{
    const int32_t outcome = brace_client_outcome(progress->outcome);
    if (may_move(progress, BRACE_MODE_LOADING_TEST)) {
        return; /* on its way, or on its way back */
    }
    const brace_motion_state_t state = outcome == (int32_t)BRACE_LOADING_DONE      ? BRACE_MOTION_DONE
                                       : outcome == (int32_t)BRACE_LOADING_STOPPED ? BRACE_MOTION_STOPPED
                                                                                   : BRACE_MOTION_FAILED;
    end(client, state, state == BRACE_MOTION_FAILED ? outcome : 0, brace_loading_outcome_text(outcome));
}

static void judge_way_back(brace_client_t *client, const progress_t *progress)
{
    const bool still_takes_up = client->motion.kind == BRACE_LETS_GO && progress->mode == BRACE_MODE_TAKING_UP;
    if (progress->mode == BRACE_MODE_START) {
        end(client, BRACE_MOTION_STOPPED, 0,
            "the controller has started anew and knows of nothing that was taken up; look where the limb stands");
    } else if (!still_takes_up && !may_move(progress, BRACE_MODE_LOADING_TEST)) {
        end(client, BRACE_MOTION_DONE, 0, "the limb is back where it began");
    }
}

/* Does it run? It does once the controller has taken the sign of life that begins it; the answer to that sign may have
 * been lost. */
static bool has_begun(brace_client_t *client, const progress_t *progress, bool is_new)
{
    brace_client_motion_t *motion = &client->motion;
    const bool has_outcome = motion->kind == BRACE_TAKES_UP || motion->kind == BRACE_LOADS;
    if (motion->now.state == BRACE_MOTION_RUNNING) {
        return true;
    }
    if (motion->has_begun || (has_outcome && brace_client_outcome(progress->outcome) == OUTCOME_RUNNING)) {
        motion->now.state = BRACE_MOTION_RUNNING;
    } else if (!is_new) {
        end(client, BRACE_MOTION_TIMED_OUT, 0,
            "the motion has not begun, because the controller heard no sign of life within 130 ms of its answer; ask "
            "again, over a link with a shorter round trip");
    }
    return motion->now.state == BRACE_MOTION_RUNNING;
}

static void judge(brace_client_t *client, const progress_t *progress)
{
    brace_client_motion_t *motion = &client->motion;
    const bool is_new = brace_bus_now_us() - motion->asked_us < BEGIN_US;
    motion->in_fault = progress->mode == BRACE_MODE_FAULT;
    if (progress->silences != motion->silences) {
        end(client, BRACE_MOTION_OWNER_LOST, 0,
            "the controller heard no sign of life for 130 ms, so the limb stands and is held; call brace_client_step "
            "at least every 50 ms, and let go or ask again");
        return;
    }
    if (!has_begun(client, progress, is_new)) {
        return;
    }
    switch (motion->kind) {
    case BRACE_TAKES_UP: judge_take_up(client, progress, is_new); break;
    case BRACE_LOADS: judge_loading_test(client, progress); break;
    default: judge_way_back(client, progress); break;
    }
    /* A new motion may only wait for its first sign of life. */
    if (is_under_way(client) && progress->is_held == 1u && !is_new) {
        end(client, BRACE_MOTION_STOPPED, 0, "somebody has stopped the limb, and it is held; let go or ask again");
    }
}

/* ---------------------------------------------------------------------------------------------- stop -- */

brace_client_status_t brace_client_stop(brace_client_t *client, int timeout_ms)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    const brace_can_loading_test_stop_request_t request = {0};
    const uint32_t any = ANY_VALUE;
    brace_question_t question = {.code = BRACE_REQUEST_LOADING_TEST_STOP};
    (void)brace_can_pack_loading_test_stop_request(&request, question.data);
    client->lives = false;
    const brace_client_status_t status =
        client->bus != NULL ? brace_can_ask(client, &question, deadline_us)
                            : brace_modbus_command(client, question.code, BRACE_CLIENT_COMMAND_PLACE(stop), &any, 1u,
                                                   false, false, deadline_us);
    const int32_t nothing_moves = client->bus != NULL ? (int32_t)BRACE_E_MODE : (int32_t)NOT_IN_THIS_MODE;
    if (status != BRACE_CLIENT_OK && (status != BRACE_CLIENT_E_REFUSED || client->refusal != nothing_moves)) {
        return status;
    }
    if (is_under_way(client)) {
        end(client, BRACE_MOTION_STOPPED, 0, "the limb stands and is held; let go or ask again");
    }
    return BRACE_CLIENT_OK;
}

brace_client_status_t brace_client_stop_all(brace_client_t *client, uint32_t stop_id, int timeout_ms)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    const brace_bus_frame_t frame = {.id = stop_id};
    if (client->bus == NULL) {
        return brace_client_fail(client, BRACE_CLIENT_E_UNSUPPORTED,
                                 "%s: over Modbus no request stops every limb; stop each by its own client",
                                 client->url);
    }
    if (stop_id < 1u || stop_id > 127u) {
        return brace_client_out_of_range(client);
    }
    client->lives = false;
    /* The request below reports what is wrong with the bus. */
    (void)brace_bus_send(client->bus, &frame, brace_bus_left_ms(deadline_us));
    return brace_client_stop(client, brace_bus_left_ms(deadline_us));
}

/* ------------------------------------------------------------------------------------------- stepping -- */

static void give_up(brace_client_t *client)
{
    const bool in_fault = client->motion.in_fault;
    (void)brace_client_stop(client, STOP_MS); /* without signs of life the limb stands all the same */
    end(client, in_fault ? BRACE_MOTION_FAILED : BRACE_MOTION_TIMED_OUT, 0,
        in_fault ? "a fault stays; the limb had the motion's limit to go back, was asked to stop; look at the faults"
                 : "the motion was not done within its limit, and the limb was asked to stop");
}

/* An answer that does not come once is no news; the limit of the motion goes on. */
static brace_client_status_t poll_progress(brace_client_t *client, uint64_t deadline_us)
{
    brace_client_motion_t *motion = &client->motion;
    progress_t progress;
    const brace_client_status_t status = ask_progress(client, deadline_us, &progress);
    const uint64_t now_us = brace_bus_now_us();
    motion->next_poll_us = now_us + POLL_US;
    if (status == BRACE_CLIENT_OK) {
        motion->news_us = now_us;
        judge(client, &progress);
        return BRACE_CLIENT_OK;
    }
    const bool may_come = status == BRACE_CLIENT_E_TIMEOUT || status == BRACE_CLIENT_E_SILENT ||
                          status == BRACE_CLIENT_E_NODE || status == BRACE_CLIENT_E_BIT_RATE;
    return may_come && now_us - motion->news_us < NEWS_US ? BRACE_CLIENT_OK : status;
}

brace_client_status_t brace_client_step(brace_client_t *client, int timeout_ms, brace_motion_t *motion)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    brace_client_status_t status = BRACE_CLIENT_OK;
    if (is_under_way(client)) {
        if (brace_bus_left_ms(client->motion.limit_us) == 0) {
            give_up(client);
        } else if (brace_bus_left_ms(client->motion.next_poll_us) == 0) {
            status = poll_progress(client, deadline_us); /* and a sign of life, as in every call that asks */
        }
    }
    if (motion != NULL) {
        *motion = client->motion.now;
    }
    return status;
}

brace_client_status_t brace_client_wait(brace_client_t *client, brace_motion_t *motion)
{
    brace_client_status_t status = brace_client_step(client, STEP_MS, motion);
    while (status == BRACE_CLIENT_OK && is_under_way(client)) {
        poll(NULL, 0, PAUSE_MS);
        status = brace_client_step(client, STEP_MS, motion);
    }
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    switch (client->motion.now.state) {
    case BRACE_MOTION_DONE: return BRACE_CLIENT_OK;
    case BRACE_MOTION_NONE: return brace_client_fail(client, BRACE_CLIENT_E_USAGE, "no motion was begun");
    case BRACE_MOTION_NOT_BEGUN: return (brace_client_status_t)client->motion.now.reason;
    case BRACE_MOTION_TIMED_OUT: return BRACE_CLIENT_E_TIMEOUT;
    default: return BRACE_CLIENT_E_REFUSED;
    }
}

/* ------------------------------------------------------------------------------------------ beginning -- */

/* Nothing was asked for. A motion that runs already goes on; one of before is not reported again. returns status */
static brace_client_status_t not_begun(brace_client_t *client, brace_client_status_t status)
{
    if (!is_under_way(client)) {
        client->motion.now = (brace_motion_t){.state = BRACE_MOTION_NOT_BEGUN, .reason = (int32_t)status};
    }
    return status;
}

/* The motion begins with the sign of life that follows the answer. A motion that runs already goes on when this one is
 * refused. */
static brace_client_status_t begin(brace_client_t *client, brace_command_t *command, brace_motion_kind_t kind,
                                   uint32_t joint, int timeout_ms, int limit_ms)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms), now_us = brace_bus_now_us();
    const brace_client_motion_t before = client->motion;
    const bool ran = is_under_way(client);
    uint32_t silences;
    if (limit_ms < 1 || limit_ms > LIMIT_MOST_MS) {
        return not_begun(client, brace_client_fail(client, BRACE_CLIENT_E_USAGE, "limit of a motion %d ms: 1 to %d",
                                                   limit_ms, LIMIT_MOST_MS));
    }
    brace_client_status_t status = brace_client_become_owner(client, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        status =
            brace_client_entry_u32(client, BRACE_CLIENT_ENTRY(silences), brace_bus_left_ms(deadline_us), &silences);
    }
    if (status != BRACE_CLIENT_OK && status != BRACE_CLIENT_E_REFUSED) {
        return not_begun(client, status);
    }
    if (status == BRACE_CLIENT_OK) {
        client->motion = (brace_client_motion_t){.now = {.state = BRACE_MOTION_ASKED},
                                                 .kind = kind,
                                                 .joint = joint,
                                                 .silences = silences,
                                                 .asked_us = now_us,
                                                 .news_us = now_us,
                                                 .limit_us = now_us + (uint64_t)limit_ms * 1000u};
        client->owner.has_begin = false;
        live(client, deadline_us);
        status = brace_client_command(client, command, deadline_us);
    }
    if (status == BRACE_CLIENT_OK) { /* it is judged once it has had the time to begin */
        client->next_life_us = 0u;
        client->motion.asked_us = brace_bus_now_us();
        client->motion.next_poll_us = client->motion.asked_us + POLL_US;
        tend(client, deadline_us);
        if (client->bus != NULL) {
            brace_can_hear_begin(client, client->motion.asked_us + BEGIN_US < deadline_us
                                             ? client->motion.asked_us + BEGIN_US
                                             : deadline_us);
        }
        client->motion.now.state = client->motion.has_begun ? BRACE_MOTION_RUNNING : BRACE_MOTION_ASKED;
    }
    if (status == BRACE_CLIENT_E_REFUSED && ran) {
        client->motion = before;
    } else if (status == BRACE_CLIENT_E_REFUSED) {
        client->motion.now = (brace_motion_t){.state = BRACE_MOTION_REFUSED, .reason = client->refusal};
        client->lives = false;
    }
    return status;
}

brace_client_status_t brace_client_begin_take_up(brace_client_t *client, uint32_t joint, int flank, int timeout_ms,
                                                 int limit_ms)
{
    const brace_can_take_up_request_t request = {.joint = joint, .flank = flank};
    brace_command_t command = {.question = {.code = BRACE_REQUEST_TAKE_UP},
                               .moves = true,
                               .place = BRACE_CLIENT_COMMAND_PLACE(take_up),
                               .values = {joint | (flank > 0 ? (uint32_t)FLANK_POSITIVE : (uint32_t)FLANK_NEGATIVE)},
                               .count = 1u};
    if (joint >= (uint32_t)JOINTS || (flank != 1 && flank != -1)) {
        return not_begun(client, brace_client_fail(client, BRACE_CLIENT_E_USAGE,
                                                   "joint %u, flank %d: 0 coxa, 1 femur, 2 tibia; the side to load is "
                                                   "1 or -1",
                                                   (unsigned)joint, flank));
    }
    (void)brace_can_pack_take_up_request(&request, command.question.data);
    return begin(client, &command, BRACE_TAKES_UP, joint, timeout_ms, limit_ms);
}

brace_client_status_t brace_client_begin_let_go(brace_client_t *client, int timeout_ms, int limit_ms)
{
    const brace_can_let_go_request_t request = {0};
    brace_command_t command = {.question = {.code = BRACE_REQUEST_LET_GO},
                               .moves = true,
                               .place = BRACE_CLIENT_COMMAND_PLACE(let_go),
                               .values = {ANY_VALUE},
                               .count = 1u};
    (void)brace_can_pack_let_go_request(&request, command.question.data);
    return begin(client, &command, BRACE_LETS_GO, 0u, timeout_ms, limit_ms);
}

brace_client_status_t brace_client_begin_loading_test(brace_client_t *client, const brace_loading_plan_t *plan,
                                                      int timeout_ms, int limit_ms)
{
    const brace_can_loading_test_start_request_t request = {.axis = plan->axis,
                                                            .steps_per_side = plan->steps_per_side,
                                                            .step_mm = plan->step_mm,
                                                            .dwell_ms = plan->dwell_ms};
    brace_command_t command = {.question = {.code = BRACE_REQUEST_LOADING_TEST_START}, .moves = true};
    const bool is_number = plan->step_mm >= 0.0f; /* NaN would be sent as 'not known' */
    if (brace_can_pack_loading_test_start_request(&request, command.question.data) != 0u || !is_number) {
        return not_begun(client, brace_client_fail(client, BRACE_CLIENT_E_USAGE,
                                                   "a value of the loading test lies outside its range; "
                                                   "client_motion.h states them"));
    }
    if (client->bus == NULL) {
        return not_begun(client, brace_client_fail(client, BRACE_CLIENT_E_UNSUPPORTED,
                                                   "%s: no loading test over Modbus; connect over CAN", client->url));
    }
    return begin(client, &command, BRACE_LOADS, 0u, timeout_ms, limit_ms);
}

brace_client_status_t brace_client_begin_end_test(brace_client_t *client, int timeout_ms, int limit_ms)
{
    const brace_can_write_entry_request_t request = {.index = BRACE_CLIENT_COMMAND(end_test), .value = ANY_VALUE};
    brace_command_t command = {.question = {.code = BRACE_REQUEST_WRITE_ENTRY},
                               .moves = true,
                               .place = BRACE_CLIENT_COMMAND_PLACE(end_test),
                               .values = {ANY_VALUE},
                               .count = 1u};
    (void)brace_can_pack_write_entry_request(&request, command.question.data);
    return begin(client, &command, BRACE_ENDS_TEST, 0u, timeout_ms, limit_ms);
}
