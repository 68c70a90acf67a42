/* What may be asked for in which mode, and what a request changes beside its answer (brace/requests.h). */
#include <string.h>

#include "loading_bench.h"

enum { MODES = 6, IN_START = 1, IN_MONITOR = 2, IN_CONFIGURATION = 4, IN_FAULT = 8, IN_TAKING_UP = 16, IN_TEST = 32 };
static const brace_mode_t modes[MODES] = {BRACE_MODE_START, BRACE_MODE_MONITOR,   BRACE_MODE_CONFIGURATION,
                                          BRACE_MODE_FAULT, BRACE_MODE_TAKING_UP, BRACE_MODE_LOADING_TEST};

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

static brace_status_t start_test(void)
{
    return brace_app_loading_start(&app, &along_x);
}

static brace_status_t let_go(void)
{
    return brace_app_let_go(&app);
}

static brace_status_t stop_test(void)
{
    return brace_app_loading_stop(&app);
}

static brace_status_t stop(void)
{
    return brace_app_stop(&app);
}

static brace_status_t enter(void)
{
    return brace_app_configuration_enter(&app);
}

static brace_status_t leave(void)
{
    return brace_app_configuration_leave(&app);
}

static brace_status_t may_write(void)
{
    return brace_app_may_write(&app);
}

/* While nothing moves, whatever the mode says. */
static void test_what_each_mode_takes(void)
{
    static const struct {
        brace_status_t (*request)(void);
        uint32_t taken_in;
    } row[] = {{start_test, IN_MONITOR},
               {let_go, IN_TAKING_UP | IN_TEST},
               {stop_test, 0},
               {stop, 0},
               {enter, IN_MONITOR | IN_FAULT | IN_CONFIGURATION},
               {leave, IN_CONFIGURATION},
               {may_write, IN_CONFIGURATION}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        for (uint32_t m = 0; m < (uint32_t)MODES; m++) {
            setUp();
            app.controller.mode.now = modes[m];
            const bool is_taken = (row[i].taken_in >> m & 1u) != 0u;
            TEST_ASSERT_EQUAL(is_taken ? BRACE_OK : BRACE_E_MODE, row[i].request());
        }
    }
}

/* What has begun is reported from then on, and not from the next tick. */
static void test_the_mode_changes_with_the_request(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, start_test());
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, brace_app_mode(&app));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, start_test());
    TEST_ASSERT_EQUAL(BRACE_OK, stop_test());
    setUp();
    TEST_ASSERT_EQUAL(BRACE_OK, enter());
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, brace_app_mode(&app));
    TEST_ASSERT_EQUAL(BRACE_OK, leave());
    TEST_ASSERT_EQUAL(BRACE_MODE_START, brace_app_mode(&app));
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_TIBIA, 1));
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, brace_app_mode(&app));
}

static bool program_moves(void)
{
    const bool moves = app.controller.ownership.program_moves;
    app.controller.ownership.program_moves = false;
    return moves;
}

/* Whoever asks for a motion, or for its end, answers for it from then on: here the board's own program. */
static void test_who_asks_moves(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    stand(&p);
    ticks(50);
    TEST_ASSERT_FALSE(program_moves());
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_TIBIA, 1));
    TEST_ASSERT_TRUE(program_moves());
    TEST_ASSERT_EQUAL(BRACE_OK, let_go());
    TEST_ASSERT_TRUE(program_moves());
    setUp();
    TEST_ASSERT_EQUAL(BRACE_OK, start_test());
    TEST_ASSERT_TRUE(program_moves());
    TEST_ASSERT_EQUAL(BRACE_OK, stop_test());
    TEST_ASSERT_TRUE(program_moves());
    TEST_ASSERT_EQUAL(BRACE_E_MODE, enter()); /* it moves back still */
    TEST_ASSERT_FALSE(program_moves());
}

static void test_a_test_needs_drives_that_take_commands(void)
{
    fake.hal.joint_command = NULL;
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, start_test());
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, app.controller.mode.now);
}

/* Whoever asks for CONFIGURATION again is heard: its time begins anew, and what is staged stays. */
static void test_configuration_asked_for_again_goes_on(void)
{
    const uint32_t longer = 0x433e0000u; /* 190.0f */
    TEST_ASSERT_EQUAL(BRACE_OK, enter());
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_stage(
                                    &app, brace_parameter_number(BRACE_PARAMETER_GEOMETRY_FEMUR_MM), 1, &longer));
    ticks(100);
    TEST_ASSERT_GREATER_THAN(0, app.controller.parameters.idle_us);
    TEST_ASSERT_EQUAL(BRACE_OK, enter());
    TEST_ASSERT_EQUAL(0, app.controller.parameters.idle_us);
    TEST_ASSERT_EQUAL(BRACE_MODE_CONFIGURATION, app.controller.mode.now);
    TEST_ASSERT_TRUE(brace_app_has_staged(&app));
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters_staged(&app)->limb.femur_mm);
}

/* A fault that is cleared ends what it stands for, and no other fault's. */
static void test_each_fault_is_cleared_alone(void)
{
    static const uint32_t faults[] = {BRACE_FAULT_MODEL_DRIFT, BRACE_FAULT_CRASHED, BRACE_FAULT_ENCODER_STUCK};
    controller_t *controller = &app.controller;
    static frozen_t before;
    const uint32_t all = faults[0] | faults[1] | faults[2] | BRACE_FAULT_MEMORY;
    for (int i = 0; i < 3; i++) {
        setUp();
        memset(&controller->frozen, 0x01, sizeof controller->frozen);
        before = controller->frozen;
        fake.crashed = controller->has_crashed = true;
        controller->drift.looks = false;
        controller->faults.now = all;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, faults[i]));
        TEST_ASSERT_EQUAL(i == 0, controller->drift.looks);
        TEST_ASSERT_EQUAL(i != 1, controller->has_crashed);
        TEST_ASSERT_EQUAL(i != 1, fake.crashed);
        TEST_ASSERT_EQUAL(i == 2, memcmp(&before, &controller->frozen, sizeof before) != 0);
        TEST_ASSERT_EQUAL_HEX32(all & ~faults[i], controller->faults.now);
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_clear(&app, faults[i] | BRACE_FAULT_MEMORY));
        TEST_ASSERT_EQUAL_HEX32(all & ~faults[i], controller->faults.now);
    }
}

/* Two commits are ten seconds apart. The one that comes too soon learns how long to wait, and counted. */
static void test_a_commit_that_comes_too_soon(void)
{
    uint32_t wait_ms = 7;
    brace_session_report_t reported;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_may_commit(&app, &wait_ms));
    TEST_ASSERT_EQUAL_UINT32(0, wait_ms);
    app.controller.parameters.apart_us = 0;
    TEST_ASSERT_EQUAL(BRACE_REFUSED_EARLY, brace_app_may_commit(&app, &wait_ms));
    TEST_ASSERT_EQUAL_UINT32(10000, wait_ms);
    brace_app_session(&app, &reported);
    TEST_ASSERT_EQUAL_UINT32(1, reported.commits_refused);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_EARLY, reported.last_refusal);
}

/* The controller reports why it last refused a request of any client and kind. An accepted one keeps that reason. */
static void test_the_last_refusal_is_reported(void)
{
    const brace_who_t owner = {BRACE_ASKER_CAN, 1}, other = {BRACE_ASKER_MODBUS_TCP, 2};
    brace_session_report_t reported;
    brace_app_session(&app, &reported);
    TEST_ASSERT_EQUAL(BRACE_OK, reported.last_refusal);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_may_command(&app, BRACE_COMMAND_MOVES, owner, NULL, NULL, 0));
    const brace_sign_t sign = sign_now();
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, brace_app_life(&app, other, &sign));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_life(&app, owner, &sign));
    brace_app_session(&app, &reported);
    TEST_ASSERT_EQUAL(BRACE_REFUSED_OWNED, reported.last_refusal);
    TEST_ASSERT_EQUAL(1, reported.strangers);
}

/* Each bound of each joint's ceiling, at it and just beyond: the parameter that passes it is named. */
static void test_each_ceiling_of_the_board(void)
{
    static const brace_hal_ceiling_t ceiling[BRACE_LINK_COUNT] = {
        {.torque_most_n_mm = 5000.0f, .angle_least_rad = -1.0f, .angle_most_rad = 1.5f},
        {.torque_most_n_mm = 6000.0f, .angle_least_rad = -1.25f, .angle_most_rad = 1.75f},
        {.torque_most_n_mm = 7000.0f, .angle_least_rad = -1.5f, .angle_most_rad = 2.0f}};
    brace_parameters_t at = bench_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        at.drive[i].torque_range_n_mm = ceiling[i].torque_most_n_mm;
        at.drive[i].angle_min_rad = ceiling[i].angle_least_rad;
        at.drive[i].angle_max_rad = ceiling[i].angle_most_rad;
    }
    fake.hal.ceiling = ceiling;
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_COUNT, brace_app_beyond_board(&app, &at));
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        for (int bound = 0; bound < 3; bound++) {
            brace_parameters_t p = at;
            float *const value[] = {&p.drive[i].torque_range_n_mm, &p.drive[i].angle_min_rad,
                                    &p.drive[i].angle_max_rad};
            *value[bound] = nextafterf(*value[bound], bound == 1 ? -1e9f : 1e9f);
            const uint32_t named = (uint32_t)((const char *)value[bound] - (const char *)&p) / 4u;
            TEST_ASSERT_EQUAL_UINT32(named, brace_app_beyond_board(&app, &p));
        }
    }
    at.controller.node_id = 0;
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_CONTROLLER_NODE_ID, brace_app_beyond_board(&app, &at));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_each_mode_takes);
    RUN_TEST(test_the_mode_changes_with_the_request);
    RUN_TEST(test_who_asks_moves);
    RUN_TEST(test_a_test_needs_drives_that_take_commands);
    RUN_TEST(test_configuration_asked_for_again_goes_on);
    RUN_TEST(test_each_fault_is_cleared_alone);
    RUN_TEST(test_a_commit_that_comes_too_soon);
    RUN_TEST(test_the_last_refusal_is_reported);
    RUN_TEST(test_each_ceiling_of_the_board);
    return UNITY_END();
}
