/* A stop is anybody's, always: in every phase of every motion, over every port, from a stranger. From then on every
 * set-point stays where it is, whatever comes later without an owner's new command: the owner's signs of life or its
 * silence, the time after which a limb lets go by itself, a take-up's own time-out, strangers' requests, a joint whose
 * sensor fails, a sensor at the tip that goes.
 *
 *     build/host/tests/test_stop [TRIALS]     default: each motion, each way once */
#include <stdlib.h>

#include "attack.h"

enum { LATER_MS = 400, LET_GO_AFTER_MS = 500, PHASE_MOST_MS = 300, STANDS_MS = 12000, MOTIONS_AND_WAYS = 30 };

static uint32_t trials = MOTIONS_AND_WAYS;
static uint64_t dice = 0x2545f4914f6cdd1du;

void setUp(void) {}

void tearDown(void)
{
    operator_lives = false;
    has_coxa = false;
}

static uint32_t below(uint32_t n)
{
    dice ^= dice << 13;
    dice ^= dice >> 7;
    dice ^= dice << 17;
    return (uint32_t)((dice >> 32) * n >> 32);
}

/* ----------------------------------------------------------------------------------------- what moves -- */

typedef enum { TAKES_UP, HOLDS, LETS_GO, LETS_GO_ITSELF, TESTS, ENDS_A_TEST, MOTIONS } motion_t;

static const char *const motion_name[MOTIONS] = {
    "take-up", "hold", "let go", "let go after silence", "loading test", "the way back of a loading test"};

static void commanded(uint8_t data[8])
{
    accepted_command(data);
    drain();
}

static void take_up(uint32_t joint)
{
    uint8_t data[8];
    make_take_up(joint, data);
    commanded(data);
    for (int i = 0; i < 6000 && now()->play[joint].phase != BRACE_TAKEUP_HOLD; i++) {
        pass(1);
    }
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[joint].phase);
}

static void test_load(void)
{
    uint8_t data[8];
    take_up(BRACE_TIBIA);
    brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){0, 0, 2, 0.5f, 20}, data);
    commanded(data);
    pass(200);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
}

static void begin(motion_t motion)
{
    uint8_t data[8];
    operator_lives = true;
    sign_of_life();
    ticks(1);
    if (motion == TAKES_UP) {
        make_take_up(BRACE_FEMUR, data);
        commanded(data);
        pass(20);
        return;
    }
    take_up(BRACE_FEMUR);
    if (motion == LETS_GO) {
        make_let_go(data);
        commanded(data);
    } else if (motion == LETS_GO_ITSELF) {
        operator_lives = false;
        for (int i = 0; i < 3000 && now()->play[BRACE_FEMUR].phase != BRACE_TAKEUP_LET_GO; i++) {
            pass(1);
        }
        TEST_ASSERT_EQUAL(BRACE_TAKEUP_LET_GO, now()->play[BRACE_FEMUR].phase);
    } else if (motion == TESTS) {
        test_load();
    } else if (motion == ENDS_A_TEST) {
        test_load();
        make_write(COMMAND_ENTRY(end_test), 1, 0, data);
        commanded(data);
    }
}

/* ------------------------------------------------------------------------------------------- who stops -- */

typedef enum { BY_FRAME, BY_REQUEST, BY_TERMINAL, BY_LINE, BY_CONNECTION, WAYS } way_t;

static void stop(way_t way)
{
    const uint32_t one[] = {1};
    uint8_t data[8] = {BRACE_REQUEST_LOADING_TEST_STOP, 0x70};
    switch (way) {
    case BY_FRAME: arrives(1, data, 0); break;
    case BY_REQUEST: says(data); break;
    case BY_TERMINAL: /* typed, and the SLCAN channel is closed */
        TEST_ASSERT_EQUAL(6, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"t0010\r", 6));
        break;
    case BY_LINE: (void)write_values(COMMAND_REGISTER(stop), one, 1); break;
    default: {
        const uint8_t pdu[] = {16, COMMAND_REGISTER(stop) >> 8, COMMAND_REGISTER(stop) & 0xff, 0, 2, 4, 0, 0, 0, 1};
        (void)tcp_asks(UNIT, pdu, sizeof pdu);
    }
    }
    pass(2);
}

/* ------------------------------------------------------------------------------------- what comes later -- */

typedef enum { OWNER_LIVES, OWNER_IS_SILENT, A_JOINT_FAILS, THE_TIP_S_SENSOR_GOES, STRANGERS_ASK, LATERS } later_t;

/* Any request but one that commands a motion: questions, writes, modes, commits, roll-backs, clears. */
static void a_stranger_asks(void)
{
    uint8_t data[8];
    for (int i = 0; i < 8; i++) {
        data[i] = (uint8_t)below(256);
    }
    data[0] = (uint8_t)(1u + below(40));
    data[1] &= 0x0fu; /* not the operator */
    const uint32_t entry = (uint32_t)data[2] | (uint32_t)data[3] << 8;
    const bool commands = data[0] == BRACE_REQUEST_TAKE_UP || data[0] == BRACE_REQUEST_LET_GO ||
                          data[0] == BRACE_REQUEST_LOADING_TEST_START ||
                          (data[0] == BRACE_REQUEST_WRITE_ENTRY && entry >= FIRST_COMMAND);
    if (!commands) {
        if (data[0] == BRACE_REQUEST_SET_MODE) {
            make_set_mode(below(6), data);
        }
        says(data);
    }
}

/* The set-points, each tick; the first that differs from where the limb stood is named. */
static void stands(motion_t motion, way_t way, later_t later)
{
    float stood_rad[BRACE_LINK_COUNT];
    char what[120];
    operator_lives = later == OWNER_LIVES;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        stood_rad[i] = fake.joint[i].command.offset_rad;
    }
    for (int ms = 0; ms < STANDS_MS / (ON_BOARD ? 10 : 1); ms++) {
        if (ms == LATER_MS && later == A_JOINT_FAILS) {
            fake.joint[BRACE_TIBIA].absent = true;
        }
        if (ms == LATER_MS && later == THE_TIP_S_SENSOR_GOES) {
            brace_fake_without_force(&fake);
        }
        if (later == STRANGERS_ASK) {
            a_stranger_asks();
        }
        pass(1);
        drain();
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            snprintf(what, sizeof what, "%s, stopped by way %d, then %d: joint %d after %d ms", motion_name[motion],
                     (int)way, (int)later, i, ms);
            const float offset_rad = fake.joint[i].command.offset_rad;
            TEST_ASSERT_TRUE_MESSAGE(memcmp(&stood_rad[i], &offset_rad, sizeof offset_rad) == 0, what);
        }
    }
}

static void test_after_a_stop_every_set_point_stays(void)
{
    uint32_t played[MOTIONS] = {0};
    for (uint32_t i = 0; i < trials; i++) {
        const motion_t motion = (motion_t)(i % MOTIONS);
        const way_t way = (way_t)(i / MOTIONS % WAYS);
        has_coxa = below(2) == 0u;
        start_limb(below(2) == 0u, the_key);
        app.controller.parameters.in_force.controller.let_go_after_ms = LET_GO_AFTER_MS;
        app.controller.parameters.comes_in_force = true; /* so the guard takes it for what was meant */
        app.controller.configure_part = BRACE_LINK_COUNT + 3;
        ticks(5);
        drain();
        if (is_guarded()) {
            open_session();
        }
        begin(motion);
        pass((int)below(motion == LETS_GO || motion == LETS_GO_ITSELF ? 30 : PHASE_MOST_MS));
        if (!brace_app_moves(&app)) {
            continue; /* it came to its end before */
        }
        played[motion]++;
        stop(way);
        stands(motion, way, (later_t)below(LATERS));
    }
    for (int motion = 0; motion < MOTIONS; motion++) {
        printf("%s: stopped %u times\n", motion_name[motion], (unsigned)played[motion]);
        TEST_ASSERT_GREATER_THAN(0, played[motion]);
    }
}

/* Does the femur's take-up begin, which comes just before a stop? The operator goes on as if it had not heard of the
 * stop: its next sign of life has the number that its answer brought. */
static bool begins(bool is_stopped, way_t way)
{
    uint8_t data[8];
    brace_can_frame_t frame;
    start_limb(false, the_key);
    ticks(5);
    operator_lives = true;
    sign_of_life();
    ticks(1);
    drain();
    make_take_up(BRACE_FEMUR, data);
    data[1] = OPERATOR_TOKEN;
    operator_says(data);
    if (is_stopped) {
        stop(way);
    } else {
        ticks(2);
    }
    while (brace_fake_frame_take(&fake, &frame)) {
        if (frame.id == 0x580u + NODE && frame.data[0] != (uint8_t)BRACE_ANSWER_REFUSED &&
            answered_code(frame.data) == (uint32_t)BRACE_REQUEST_TAKE_UP) {
            operator_begins = true;
            begin_heard = brace_get_u32(&frame.data[4]);
        }
    }
    pass(100);
    return brace_app_moves(&app);
}

static void test_a_command_that_comes_just_before_a_stop_begins_nothing(void)
{
    TEST_ASSERT_TRUE_MESSAGE(begins(false, BY_FRAME), "without a stop it begins");
    for (int way = 0; way < WAYS; way++) {
        char what[40];
        snprintf(what, sizeof what, "stopped by way %d", way);
        TEST_ASSERT_FALSE_MESSAGE(begins(true, (way_t)way), what);
    }
}

int main(int count, char **arguments)
{
    trials = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : trials;
    UNITY_BEGIN();
    RUN_TEST(test_after_a_stop_every_set_point_stays);
    RUN_TEST(test_a_command_that_comes_just_before_a_stop_begins_nothing);
    return UNITY_END();
}
