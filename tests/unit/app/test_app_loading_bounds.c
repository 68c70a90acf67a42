/* What ends a loading test, and how: force, torque, travel, time, requests, faults; what is no setup. */
#include "loading_bench.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

static void ends_with(brace_loading_outcome_t wanted)
{
    TEST_ASSERT_EQUAL(wanted, result()->outcome);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_TIBIA].command.offset_rad, 0.0);
    TEST_ASSERT_TRUE(isinf(fake.joint[BRACE_FEMUR].command.torque_limit_n_mm));
}

static void test_the_force_is_bounded(void)
{
    brace_loading_setup_t setup = along_x;
    setup.force_max_n = 5.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &setup));
    for (int i = 0; i < 20000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
        TEST_ASSERT_TRUE(fabsf(fake.force_x_n - 1.0f) < 5.2f);
    }
    ticks(2);
    ends_with(BRACE_LOADING_E_FORCE);
}

/* Each side of the force ends it, whichever way the test goes. */
static void test_the_force_is_bounded_on_every_side(void)
{
    static const float more_n[][2] = {{25.0f, 0.0f}, {-25.0f, 0.0f}, {0.0f, 25.0f}, {0.0f, -25.0f}};
    for (int i = 0; i < 4; i++) {
        const brace_parameters_t p = bench_parameters();
        stand(&p);
        brace_loading_setup_t setup = along_x;
        setup.force_max_n = 20.0f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &setup));
        for (int j = 0; j < 20000 && result()->rows < 1; j++) {
            ticks(1);
        }
        ticks(30);
        TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, result()->outcome);
        preload_x_n += (double)more_n[i][0], preload_z_n += (double)more_n[i][1];
        for (int j = 0; j < 20000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; j++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(BRACE_LOADING_E_FORCE, result()->outcome);
    }
}

static void test_the_torque_is_bounded(void)
{
    brace_loading_setup_t setup = along_x;
    setup.torque_max_n_mm = fabsf(fake.joint[BRACE_FEMUR].sample.torque_n_mm) + 300.0f;
    run(&setup);
    ends_with(BRACE_LOADING_E_TORQUE);
}

static void test_a_tip_that_nothing_holds_gives_no_slope_but_no_harm(void)
{
    tip_is_free = true;
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    ASSERT_CLOSE(0.0, result()->least_squares.k_x_n_per_mm, 1e-3);
    TEST_ASSERT_TRUE(result()->z_x < -3.0f);
}

static void test_motors_that_do_not_follow_are_reported(void)
{
    fake.play = NULL;
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_LOST, result()->outcome);
    TEST_ASSERT_BITS_HIGH(BRACE_FAULT_ENCODER_STUCK, now()->faults); /* neither angle nor torque moves by a bit */
}

static void pushed(void *user, brace_fake_t *board, int32_t joint)
{
    play(user, board, joint);
    board->joint[1].sample.motor_rad += 0.05f;
}

static void test_a_motor_that_goes_where_it_was_not_sent_ends_the_test(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(500);
    fake.play = pushed;
    for (int i = 0; i < 20000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
    ends_with(BRACE_LOADING_E_TRAVEL);
}

static void test_the_drives_hold_the_torque_s_bound_themselves(void)
{
    brace_loading_setup_t setup = along_x;
    const float asked_n_mm[] = {3000.0f, 20000.0f}, commanded_n_mm[] = {3000.0f, 10000.0f}; /* the drives' range */
    for (int i = 0; i < 2; i++) {
        setup.torque_max_n_mm = asked_n_mm[i];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &setup));
        ticks(100);
        TEST_ASSERT_EQUAL_FLOAT(commanded_n_mm[i], fake.joint[BRACE_FEMUR].command.torque_limit_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(commanded_n_mm[i], fake.joint[BRACE_TIBIA].command.torque_limit_n_mm);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
        ticks(200);
        TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    }
}

/* A coxa joint has no part in a test: nothing is added to its set-point, and nothing limits it. */
static void test_a_coxa_joint_is_left_alone(void)
{
    fake.joint[BRACE_COXA].absent = false;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(1000);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
    TEST_ASSERT_TRUE(fake.joint[BRACE_FEMUR].command.offset_rad != 0.0f);
    TEST_ASSERT_EQUAL_FLOAT(8000.0f, fake.joint[BRACE_FEMUR].command.torque_limit_n_mm);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_COXA].command.offset_rad, 0.0);
    TEST_ASSERT_TRUE(isinf(fake.joint[BRACE_COXA].command.torque_limit_n_mm));
}

static void test_a_posture_at_the_end_of_its_travel_ends_the_test(void)
{
    brace_parameters_t p = bench_parameters();
    p.drive[BRACE_FEMUR].angle_min_rad = 0.998f;
    p.drive[BRACE_FEMUR].angle_max_rad = 1.002f;
    p.drive[BRACE_TIBIA].angle_min_rad = 1.398f;
    p.drive[BRACE_TIBIA].angle_max_rad = 1.402f;
    stand(&p);
    run(&along_x);
    ends_with(BRACE_LOADING_E_TRAVEL);
}

static void test_the_time_is_bounded(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(10);
    const double dwell_s = 1e-6 * along_x.dwell_us;
    /* four steps a side: 17 readings of twice the dwell and a step's way, 3 s each for the servos; and 2 s */
    ASSERT_CLOSE(17.0 * (2.0 * (dwell_s + 0.0635) + 3.0) + 2.0, 1e-6 * (double)app.controller.loading.limit_us, 1e-3);
    app.controller.loading.limit_us = app.controller.loading.test_us + 100000u;
    ticks(101);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_TIME, result()->outcome);
    ticks(200);
    ends_with(BRACE_LOADING_E_TIME);
}

static void test_a_test_that_ends_early_goes_back_at_its_rate(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    for (int i = 0; i < 20000 && result()->rows < 4; i++) {
        ticks(1);
    }
    TEST_ASSERT_EQUAL(4, result()->rows);
    const float along_mm = fabsf(app.controller.loading.along_mm);
    TEST_ASSERT_TRUE(along_mm > 1.8f);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
    const float step_mm = 1e-3f * along_x.rate_mm_per_s; /* in a tick */
    int count = 0;
    for (; count < 1000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; count++) {
        const float before[2] = {fake.joint[1].command.offset_rad, fake.joint[2].command.offset_rad};
        ticks(1);
        for (int i = 0; i < 2; i++) {
            const brace_loading_t *test = &app.controller.loading;
            const float most_rad = step_mm * fabsf(test->per_mm[i] + test->give_rad_per_mm[i]);
            TEST_ASSERT_TRUE(fabsf(fake.joint[1 + i].command.offset_rad - before[i]) <= 1.01f * most_rad);
        }
    }
    TEST_ASSERT_TRUE((float)count >= along_mm / step_mm - 1.0f);
    ends_with(BRACE_LOADING_STOPPED);
}

static void test_it_can_be_stopped(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_loading_start(&app, &along_x));
    ticks(1500);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
    for (int i = 0; i < 20000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
    ends_with(BRACE_LOADING_STOPPED);
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_loading_stop(&app));
    TEST_ASSERT_TRUE(brace_app_row_count(&app) > 0);
}

static void test_a_drive_that_refuses_is_a_fault_and_ends_it(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(500);
    brace_fake_fail_next(&fake, BRACE_FAKE_JOINT_COMMAND, 90, BRACE_HAL_E_DEVICE); /* 45 ticks: a short silence */
    ticks(45);
    TEST_ASSERT_EQUAL(0, now()->faults);
    ticks(10);
    brace_fake_fail_next(&fake, BRACE_FAKE_JOINT_COMMAND, 110, BRACE_HAL_E_DEVICE);
    ticks(52);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_DRIVE_REFUSES, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(90 + 104, counters().commands_failed);
    TEST_ASSERT_EQUAL(94 + 100, app.wires.measured.commands_failed);
    for (int i = 0; i < 20000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(110);
    ends_with(BRACE_LOADING_E_LOST);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

static void test_a_fault_ends_it(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(1500);
    fake.joint[BRACE_TIBIA].not_newer = true;
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_MODE_FAULT, now()->mode);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_LOST, result()->outcome);
    ticks(2000);
    ASSERT_CLOSE(0.0, fake.joint[BRACE_FEMUR].command.offset_rad, 0.0);
}

static void test_a_force_that_is_lost_ends_it(void)
{
    brace_parameters_t p = bench_parameters();
    stand(&p);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
    ticks(1500);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 0.0f;
    app.controller.parameters.in_force.limb.femur_mm = -1.0f; /* no posture, no levers, no force */
    ticks(100);
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_NO_FORCE, result()->outcome);
}

static void test_setups_that_cannot_be_are_refused(void)
{
    brace_loading_setup_t s = along_x;
    s.steps_per_side = 1;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.step_mm = (float)NAN;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.dwell_us = 1000;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.axis = (brace_axis_t)2;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.force_max_n = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.source = (brace_loading_source_t)7;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.steps_per_side = 61;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.dwell_us = 10000001;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.rate_mm_per_s = 1001.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.rate_mm_per_s = 0.9e-3f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.force_max_n = 1.1e6f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.torque_max_n_mm = 1.1e6f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s = along_x, s.torque_max_n_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    fake.play = NULL;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 0.01f; /* nearly straight */
    bench_believe();
    ticks(3);
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, brace_app_loading_start(&app, &along_x));
    brace_fake_without_commands(&fake);
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_app_loading_start(&app, &along_x));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
    TEST_ASSERT_EQUAL(BRACE_E_MODE, brace_app_loading_start(&app, &along_x));
}

static void test_the_largest_step_is_taken_as_a_frame_carries_it(void)
{
    static const float step_mm[] = {50.001f, 50.0f};
    static const brace_status_t answers[] = {BRACE_E_RANGE, BRACE_OK};
    for (int i = 0; i < 2; i++) {
        brace_can_loading_test_start_request_t asked = {.steps_per_side = 2, .step_mm = step_mm[i], .dwell_ms = 20};
        uint8_t data[8];
        brace_can_pack_loading_test_start_request(&asked, data);
        brace_can_unpack_loading_test_start_request(data, &asked);
        brace_loading_setup_t s = along_x;
        s.step_mm = asked.step_mm;
        TEST_ASSERT_EQUAL(answers[i], brace_app_loading_start(&app, &s));
    }
}

/* At 32 mm a float's last place is 3.8e-6 mm: a tick's way of 1e-6 mm would be none, there and back. */
static void test_a_rate_that_would_stand_far_out_is_refused(void)
{
    brace_loading_setup_t s = along_x;
    s.steps_per_side = 16, s.step_mm = 2.0f, s.rate_mm_per_s = 1e-3f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_app_loading_start(&app, &s));
    s.rate_mm_per_s = 1.001f * 1e3f * BRACE_LOADING_LEAST_WAY * 32.0f; /* the slowest that is taken */
    s.force_max_n = 1e6f;
    truth = (symmetric_t){0.01, 0.0, 0.01}; /* so soft that it gets there */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &s));
    app.controller.loading.step = 16;
    app.controller.loading.along_mm = -31.99f; /* as after hours */
    for (int i = 0; i < 5000 && app.controller.loading.along_mm != -32.0f; i++) {
        for (int j = 0; j < 2; j++) {
            app.controller.loading.start_motor_rad[j] = app.controller.joints.joint[BRACE_FEMUR + j].sample.motor_rad;
        }
        bench_believe();
        ticks(1);
    }
    ASSERT_CLOSE(-32.0, app.controller.loading.along_mm, 0.0);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_stop(&app));
    const float from_mm = app.controller.loading.along_mm;
    ticks(100);
    TEST_ASSERT_TRUE(app.controller.loading.along_mm > from_mm + 50.0f * 1e-3f * s.rate_mm_per_s);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_force_is_bounded);
    RUN_TEST(test_the_force_is_bounded_on_every_side);
    RUN_TEST(test_the_torque_is_bounded);
    RUN_TEST(test_a_tip_that_nothing_holds_gives_no_slope_but_no_harm);
    RUN_TEST(test_motors_that_do_not_follow_are_reported);
    RUN_TEST(test_a_motor_that_goes_where_it_was_not_sent_ends_the_test);
    RUN_TEST(test_the_drives_hold_the_torque_s_bound_themselves);
    RUN_TEST(test_a_coxa_joint_is_left_alone);
    RUN_TEST(test_a_posture_at_the_end_of_its_travel_ends_the_test);
    RUN_TEST(test_the_time_is_bounded);
    RUN_TEST(test_a_test_that_ends_early_goes_back_at_its_rate);
    RUN_TEST(test_it_can_be_stopped);
    RUN_TEST(test_a_drive_that_refuses_is_a_fault_and_ends_it);
    RUN_TEST(test_a_fault_ends_it);
    RUN_TEST(test_a_force_that_is_lost_ends_it);
    RUN_TEST(test_setups_that_cannot_be_are_refused);
    RUN_TEST(test_the_largest_step_is_taken_as_a_frame_carries_it);
    RUN_TEST(test_a_rate_that_would_stand_far_out_is_refused);
    return UNITY_END();
}
