#include "can/requests.h"

#include <string.h>

#include "can/bus.h"
#include "can/request.h"
#include "can/slcan.h"
#include "modbus/modbus.h"

#define FRAMES_PER_MS 4u
#define FRAMES_MOST 20u
#define PARTS_MOST 4u
#define SENT_PER_TICK 4u

void requests_start(brace_app_t *app)
{
    brace_app_requests_t *requests = &app->requests;
    requests->waiting = requests->upload_open = false;
    requests->answer_first = requests->answer_count = 0;
    requests->storing = 0;
    requests->upload_next = requests->download_next = 0;
}

void answer_put(brace_app_t *app, const uint8_t data[8])
{
    memcpy(answer_place(app), data, 8);
}

void answer_refusal(brace_app_t *app, uint32_t code, uint32_t token, int32_t status, uint32_t detail)
{
    uint8_t *data = answer_place(app);
    (void)brace_can_pack_refusal(&(brace_can_refusal_t){token, status, detail}, data);
    data[0] = (uint8_t)(data[0] | (code & 31u));
}

/* Identifiers that the other nodes of a bus use among themselves: none of ours, and nothing strange. */
static bool is_known_function(uint32_t id)
{
    enum {
        KNOWN = 1 << (BRACE_CAN_ID_EMERGENCY >> 7) | 1 << (BRACE_CAN_ID_STIFFNESS_A >> 7) |
        1 << (BRACE_CAN_ID_STIFFNESS_B >> 7) | 1 << (BRACE_CAN_ID_EIGENVALUES >> 7) | 1 << (BRACE_CAN_ID_POSTURE >> 7) |
        1 << (BRACE_CAN_ID_SNAPSHOT_FD >> 7) | 1 << (BRACE_CAN_ID_HEARTBEAT >> 7) | 1 << (BRACE_CAN_ID_REQUEST >> 7) |
        1 << (BRACE_CAN_ID_ANSWER >> 7)
    };
    return ((uint32_t)KNOWN >> (id >> 7 & 15u) & 1u) != 0u;
}

static void count_unknown(brace_app_t *app)
{
    app->counters.frames_unknown += app->counters.frames_unknown < UINT32_MAX;
}

/* Is this a request to us? Then it is taken. */
static bool accept(brace_app_t *app, const brace_can_frame_t *frame)
{
    brace_app_requests_t *requests = &app->requests;
    if (frame->id != (uint32_t)BRACE_CAN_ID_REQUEST + app->bus.node_id) {
        if (!is_known_function(frame->id)) {
            count_unknown(app);
        }
        return false;
    }
    if (frame->length != 8u || frame->fd || frame->data[0] >= BRACE_ANSWER_PART) {
        count_unknown(app);
        return false;
    }
    if (!app->bus.speaks && !app->bus.slcan.open) {
        return false;
    }
    memcpy(requests->request, frame->data, 8);
    return true;
}

static uint32_t frames_per_tick(const brace_app_t *app)
{
    const uint32_t frames = app->tick_us * FRAMES_PER_MS / 1000u;
    return frames < FRAMES_PER_MS ? FRAMES_PER_MS : frames > FRAMES_MOST ? FRAMES_MOST : frames;
}

/* What comes as text takes a tick to be read, and is answered in the next. */
static void take_text(brace_app_t *app)
{
    brace_can_frame_t frame;
    const bool rests = app->mode == BRACE_MODE_CONFIGURATION && /* it is a piece's turn, or that of Modbus */
                       (app->report.left_out > 0u || app->modbus.waited >= (uint32_t)MODBUS_PATIENCE_TICKS);
    app->bus.slcan.heard = false;
    if (!app->requests.waiting && !rests && slcan_port_receive(app, &frame)) {
        app->requests.waiting = accept(app, &frame);
    }
}

/* For all parts of an answer. */
static bool has_room(const brace_app_requests_t *requests)
{
    return requests->answer_count + PARTS_MOST <= (uint32_t)BRACE_APP_ANSWERS;
}

bool requests_take(brace_app_t *app)
{
    brace_app_requests_t *requests = &app->requests;
    const uint32_t most = app->bus.slcan.open ? 1u : frames_per_tick(app);
    brace_can_frame_t frame;
    if (!app->bus.listens && !app->bus.slcan.fitted) {
        return false;
    }
    for (uint32_t i = 0; i < most && !requests->waiting && bus_receive(app, &frame); i++) {
        requests->waiting = accept(app, &frame);
    }
    const bool waits = requests->waiting;
    take_text(app);
    return waits && has_room(requests);
}

static int32_t dispatch(brace_app_t *app, request_t *request)
{
    switch (request->code) {
    case BRACE_REQUEST_READ_ENTRY: return request_read_entry(app, request);
    case BRACE_REQUEST_WRITE_ENTRY: return request_write_entry(app, request);
    case BRACE_REQUEST_K_AT_POSTURE: return request_k_at_posture(app, request);
    case BRACE_REQUEST_K_AT_TIP_KNEE_UP:
    case BRACE_REQUEST_K_AT_TIP_KNEE_DOWN: return request_k_at_tip(app, request);
    case BRACE_REQUEST_CONTACT_FORCE: return request_contact_force(app, request);
    case BRACE_REQUEST_SAG_FOR_LOAD: return request_sag_for_load(app, request);
    case BRACE_REQUEST_FRICTION_MARGIN: return request_friction_margin(app, request);
    case BRACE_REQUEST_SET_MODE: return request_set_mode(app, request);
    case BRACE_REQUEST_UPLOAD_BEGIN: return request_upload_begin(app, request);
    case BRACE_REQUEST_UPLOAD_WORD: return request_upload_word(app, request);
    case BRACE_REQUEST_COMMIT: return request_commit(app, request);
    case BRACE_REQUEST_ROLLBACK: return request_rollback(app, request);
    case BRACE_REQUEST_DOWNLOAD_WORD: return request_download_word(app, request);
    case BRACE_REQUEST_TAKE_UP: return request_take_up(app, request);
    case BRACE_REQUEST_LET_GO: return request_let_go(app, request);
    case BRACE_REQUEST_LOADING_TEST_START: return request_loading_start(app, request);
    case BRACE_REQUEST_LOADING_TEST_STOP: return request_loading_stop(app, request);
    case BRACE_REQUEST_FETCH_ROW: return request_fetch_row(app, request);
    case BRACE_REQUEST_IDENTIFY: return request_identify(app, request);
    case BRACE_REQUEST_LOADING_TEST_RESULT: return request_loading_result(app, request);
    case BRACE_REQUEST_CLEAR: return request_clear(app, request);
    default:
        count_unknown(app);
        request->detail = BRACE_REQUEST_CLEAR;
        return BRACE_REFUSED_UNKNOWN;
    }
}

void requests_end_storing(brace_app_t *app)
{
    if (has_room(&app->requests)) {
        request_storing_answer(app);
    }
}

void requests_serve(brace_app_t *app)
{
    brace_app_requests_t *requests = &app->requests;
    request_t request = {requests->request, requests->request[0], requests->request[1], 0};
    if (!has_room(requests)) {
        return; /* what a commit has come to has taken it: the next tick */
    }
    requests->waiting = false;
    const int32_t status = requests->refuses ? (int32_t)BRACE_REFUSED_BUSY : dispatch(app, &request);
    if (status != BRACE_OK) {
        answer_refusal(app, request.code, request.token, status, request.detail);
    }
}

void requests_send(brace_app_t *app)
{
    brace_app_requests_t *requests = &app->requests;
    if (app->mode != BRACE_MODE_CONFIGURATION) {
        requests->upload_open = false;
    }
    const uint32_t most = app->bus.slcan.open ? app->report.lines : SENT_PER_TICK;
    uint32_t left = requests->answer_count < most ? requests->answer_count : most;
    while (left > 0u) { /* at most twice: where the ring comes round */
        const uint32_t first = requests->answer_first, to_end = (uint32_t)BRACE_APP_ANSWERS - first;
        const uint32_t count = left < to_end ? left : to_end;
        const uint32_t sent = bus_send_some(app, BRACE_CAN_ID_ANSWER, &requests->answer[first], count);
        requests->answer_first = (uint8_t)((first + sent) % BRACE_APP_ANSWERS);
        requests->answer_count = (uint8_t)(requests->answer_count - sent);
        left = sent == count ? left - count : 0u;
    }
}
