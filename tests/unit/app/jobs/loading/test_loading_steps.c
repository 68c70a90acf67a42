/* A loading test tick by tick: what each bound ends at and just under it, how long a step waits for its servos, what is
 * averaged, how runs are numbered. The test is stepped alone, with joints and forces as this suite sets them. */
#include <string.h>

#include "jobs/loading/loading.h"
#include "loading_bench.h"

enum { RESTING_TICKS = 20, SERVOS_TICKS = 3000 }; /* brace/loading.h: 3 s a step for the servos */

static brace_loading_t test;
static brace_snapshot_t snapshot;
static joints_t joints;
static flank_t flank;
static posture_t posture;
static model_work_t work_of_test;
static brace_recorder_t recorder;
static loading_inputs_t inputs;

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
    snapshot = *now();
    joints = app.controller.joints;
    flank = app.controller.flank;
    posture = app.controller.posture;
    inputs = controller_loading_inputs(&app.controller, &snapshot);
    inputs.joints = &joints;
    inputs.flank = &flank;
    inputs.posture = &posture;
    inputs.work = &work_of_test;
    memset(&test, 0, sizeof test);
}

void tearDown(void) {}

static loading_reading_t reading;

static void tick(void)
{
    loading_step(&test, &inputs);
    (void)loading_work(&test, &inputs, &recorder, &reading);
}

/* Until the free shape may move. */
static void begin(const brace_loading_setup_t *setup)
{
    TEST_ASSERT_EQUAL(BRACE_OK, loading_start(&test, &inputs, setup));
    for (int i = 0; i < 200 && test.phase != LOADING_MOVE; i++) {
        tick();
    }
    TEST_ASSERT_EQUAL(LOADING_MOVE, test.phase);
}

static void motor_moves(int i, float by_rad)
{
    joints.joint[BRACE_FEMUR + i].sample.motor_rad += by_rad;
}

/* Both motors stand where the test has commanded them. */
static void follow(void)
{
    for (int i = 0; i < 2; i++) {
        joints.joint[BRACE_FEMUR + i].sample.motor_rad =
            test.start_motor_rad[i] + loading_offset_rad(&test, BRACE_FEMUR + i);
    }
}

static void to_row(uint32_t rows)
{
    for (int i = 0; i < 20000 && test.result.rows < rows; i++) {
        tick();
        follow();
    }
    TEST_ASSERT_EQUAL(rows, test.result.rows);
    for (int i = 0; i < 200 && test.phase != LOADING_MOVE; i++) {
        tick();
    }
    TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, test.result.outcome);
}

static int ticks_in(uint8_t phase)
{
    int count = 0;
    while (test.phase == phase && count < 20000) {
        tick();
        count++;
    }
    return count;
}

/* --- bounds ------------------------------------------------------------------------------------------------------ */

static void test_a_force_that_is_none_on_either_axis_ends_it(void)
{
    const float none[] = {NAN, INFINITY, -INFINITY, 2e7f, -2e7f};
    for (int i = 0; i < 10; i++) {
        setUp();
        begin(&along_x);
        *(i % 2 == 0 ? &snapshot.force_x_n : &snapshot.force_z_n) = none[i / 2];
        tick();
        TEST_ASSERT_EQUAL(BRACE_LOADING_E_NO_FORCE, test.result.outcome);
        TEST_ASSERT_EQUAL(LOADING_RETURN, test.phase);
    }
}

/* A dwell in which no sample came leaves nothing to read: the test ends, and goes no further. */
static void test_a_dwell_without_a_sample_ends_it(void)
{
    for (uint32_t step = 0; step < 2u; step++) {
        setUp();
        begin(&along_x);
        test.phase = LOADING_READ;
        test.step = step;
        test.sums.count = 0;
        (void)loading_work(&test, &inputs, &recorder, &reading);
        TEST_ASSERT_EQUAL(BRACE_LOADING_E_NO_FORCE, test.result.outcome);
        TEST_ASSERT_EQUAL(LOADING_RETURN, test.phase);
        TEST_ASSERT_FALSE(reading.is_there);
    }
}

static void test_the_force_may_change_by_its_bound(void)
{
    for (int i = 0; i < 8; i++) {
        const bool is_over = i % 2 == 1;
        const float change_n = (is_over ? 1.01f : 0.99f) * (i / 2 % 2 == 1 ? -20.0f : 20.0f);
        brace_loading_setup_t setup = along_x;
        setup.force_max_n = 20.0f;
        setUp();
        begin(&setup);
        to_row(1);
        *(i / 4 == 0 ? &snapshot.force_x_n : &snapshot.force_z_n) += change_n;
        tick();
        TEST_ASSERT_EQUAL(is_over ? BRACE_LOADING_E_FORCE : BRACE_LOADING_RUNNING, test.result.outcome);
    }
}

/* The test ends at 95 % of the torque bound that the drives were given. */
static void test_the_torque_of_either_motor_is_bounded(void)
{
    for (int i = 0; i < 8; i++) {
        const bool is_over = i % 2 == 1;
        const float share = (is_over ? 0.951f : 0.949f) * (i / 2 % 2 == 1 ? -1.0f : 1.0f);
        brace_loading_setup_t setup = along_x;
        setup.torque_max_n_mm = 6000.0f;
        setUp();
        begin(&setup);
        joints.joint[BRACE_FEMUR + i / 4].torque_n_mm = share * loading_torque_limit_n_mm(&test, BRACE_FEMUR + i / 4);
        TEST_ASSERT_EQUAL_FLOAT(6000.0f, loading_torque_limit_n_mm(&test, BRACE_FEMUR + i / 4));
        tick();
        TEST_ASSERT_EQUAL(is_over ? BRACE_LOADING_E_TORQUE : BRACE_LOADING_RUNNING, test.result.outcome);
    }
    TEST_ASSERT_TRUE(isinf(loading_torque_limit_n_mm(&test, BRACE_COXA)));
    ASSERT_CLOSE(0.0, loading_offset_rad(&test, BRACE_COXA), 0.0);
}

/* Twice its command and 0.01 rad; the command is none yet. */
static void test_the_way_of_either_motor_is_bounded(void)
{
    for (int i = 0; i < 8; i++) {
        const bool is_over = i % 2 == 1;
        setUp();
        begin(&along_x);
        motor_moves(i / 4, (is_over ? 0.0101f : 0.0099f) * (i / 2 % 2 == 1 ? -1.0f : 1.0f));
        tick();
        TEST_ASSERT_EQUAL(is_over ? BRACE_LOADING_E_TRAVEL : BRACE_LOADING_RUNNING, test.result.outcome);
    }
    for (int i = 0; i < 4; i++) { /* with a command: its double, to either side */
        setUp();
        begin(&along_x);
        to_row(2);
        const float offset_rad = loading_offset_rad(&test, BRACE_FEMUR + i / 2);
        const float most_rad = 2.0f * fabsf(offset_rad) + 0.01f;
        TEST_ASSERT_TRUE(fabsf(offset_rad) > 1e-3f);
        joints.joint[BRACE_FEMUR + i / 2].sample.motor_rad = test.start_motor_rad[i / 2] + 0.95f * most_rad;
        tick();
        TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, test.result.outcome);
        joints.joint[BRACE_FEMUR + i / 2].sample.motor_rad =
            test.start_motor_rad[i / 2] + (i % 2 == 0 ? 1.1f : -1.1f) * most_rad;
        tick();
        TEST_ASSERT_EQUAL(BRACE_LOADING_E_TRAVEL, test.result.outcome);
    }
}

static void test_a_flank_that_was_taken_up_must_hold(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        flank.joint[BRACE_FEMUR + i].out.phase = BRACE_TAKEUP_HOLD;
        flank.joint[BRACE_FEMUR + i].machine.params.takeup.torque_max_n_mm = 3000.0f;
        begin(&along_x);
        TEST_ASSERT_EQUAL_FLOAT(3000.0f, loading_torque_limit_n_mm(&test, BRACE_FEMUR + i));
        TEST_ASSERT_EQUAL_FLOAT(8000.0f, loading_torque_limit_n_mm(&test, BRACE_TIBIA - i));
        tick();
        flank.joint[BRACE_TIBIA - i].out.phase = BRACE_TAKEUP_IDLE; /* the other one never held */
        tick();
        TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, test.result.outcome);
        flank.joint[BRACE_FEMUR + i].out.phase = BRACE_TAKEUP_IDLE;
        tick();
        TEST_ASSERT_EQUAL(BRACE_LOADING_E_LOST, test.result.outcome);
    }
}

static void test_the_time_runs_from_the_start(void)
{
    begin(&along_x);
    test.limit_us = test.test_us + 5000u;
    for (int i = 0; i < 5; i++) {
        tick();
        TEST_ASSERT_EQUAL(BRACE_LOADING_RUNNING, test.result.outcome);
    }
    tick();
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_TIME, test.result.outcome);
    loading_end(&test, BRACE_LOADING_E_FORCE); /* how it ended stays */
    TEST_ASSERT_EQUAL(BRACE_LOADING_E_TIME, test.result.outcome);
}

/* --- how long a step takes --------------------------------------------------------------------------------------- */

static void test_motors_that_stand_there_are_read_after_20_ms(void)
{
    begin(&along_x);
    TEST_ASSERT_EQUAL(RESTING_TICKS, ticks_in(LOADING_MOVE));
    TEST_ASSERT_EQUAL(LOADING_DWELL, test.phase);
}

/* Either motor that does not come there is waited for, as long as a step's servos have; then it is read where it is. */
static void test_motors_that_do_not_come_there_have_three_seconds(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        begin(&along_x);
        motor_moves(i / 2, i % 2 == 0 ? 0.003f : -0.003f);
        TEST_ASSERT_EQUAL(SERVOS_TICKS, ticks_in(LOADING_MOVE));
        TEST_ASSERT_EQUAL(LOADING_DWELL, test.phase);
        /* it was pushed back meanwhile, and the other one was left alone */
        const float pushed_rad = loading_offset_rad(&test, BRACE_FEMUR + i / 2);
        TEST_ASSERT_TRUE(i % 2 == 0 ? pushed_rad < -0.003f : pushed_rad > 0.003f);
        TEST_ASSERT_TRUE(fabsf(pushed_rad) <= 0.30001f);
        ASSERT_CLOSE(0.0, loading_offset_rad(&test, BRACE_TIBIA - i / 2), 0.0);
    }
}

/* They have them in each step, from when the shape stands. */
static void test_three_seconds_in_each_step(void)
{
    int standing = 0;
    begin(&along_x);
    to_row(1);
    while (test.phase == LOADING_MOVE && standing < 20000) { /* and the motors do not follow */
        const float before_mm = test.along_mm;
        tick();
        standing = test.along_mm == before_mm ? standing + 1 : 0;
    }
    TEST_ASSERT_EQUAL(SERVOS_TICKS, standing);
    TEST_ASSERT_EQUAL(LOADING_DWELL, test.phase);
}

/* A servo that does not answer is pushed by 0.3 rad at most, either way; the way of the shape comes on top. */
static void test_a_servo_is_pushed_only_so_far(void)
{
    for (int i = 0; i < 4; i++) {
        const double away_rad = i % 2 == 0 ? 0.0055 : -0.0055;
        setUp();
        begin(&along_x);
        if (i / 2 != 0) {
            to_row(1);
            while (test.phase == LOADING_MOVE && test.along_mm > -along_x.step_mm) { /* until the shape has arrived */
                tick();
                follow();
            }
        }
        const double shape_rad[] = {(double)(test.per_mm[0] * test.along_mm), (double)(test.per_mm[1] * test.along_mm)};
        for (int k = 0; k < SERVOS_TICKS && test.phase == LOADING_MOVE; k++) {
            for (int j = 0; j < 2; j++) {
                joints.joint[BRACE_FEMUR + j].sample.motor_rad =
                    (float)((double)test.start_motor_rad[j] + shape_rad[j] + (j == 0 ? away_rad : 0.0));
            }
            tick();
        }
        ASSERT_CLOSE(i % 2 == 0 ? -0.3 : 0.3, (double)loading_offset_rad(&test, BRACE_FEMUR) - shape_rad[0], 1e-3);
    }
}

/* Commands alone count where the servos' yielding is part of K: nothing is waited for but the shape's way. */
static void test_commanded_steps_wait_for_no_motor(void)
{
    brace_loading_setup_t setup = along_x;
    setup.source = BRACE_LOADING_COMMANDED;
    begin(&setup);
    motor_moves(0, 0.003f);
    TEST_ASSERT_EQUAL(RESTING_TICKS, ticks_in(LOADING_MOVE));
    ASSERT_CLOSE(0.0, loading_offset_rad(&test, BRACE_FEMUR), 0.0);
}

/* A hundredth of a step of the joint that goes further, and what its encoder can resolve. */
static void test_how_near_a_motor_has_to_come(void)
{
    for (int axis = 0; axis < 2; axis++) {
        brace_loading_setup_t setup = along_x;
        setup.axis = axis == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
        setUp();
        begin(&setup);
        const double femur = fabs((double)test.per_mm[0]), tibia = fabs((double)test.per_mm[1]);
        TEST_ASSERT_TRUE(fabs(femur - tibia) > 0.01 * femur);
        const double furthest_rad = (double)setup.step_mm * (femur > tibia ? femur : tibia);
        for (int i = 0; i < 2; i++) {
            ASSERT_CLOSE(0.01 * furthest_rad + 1e-5, test.there_rad[i], 1e-8);
        }
    }
}

/* A motor on its way through has not come; one that has come may waver by three times what it came within. */
static void test_who_passes_through_begins_anew_and_who_wavers_does_not(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        begin(&along_x);
        const float there_rad = test.there_rad[i];
        for (int k = 0; k < RESTING_TICKS - 1; k++) {
            tick();
        }
        motor_moves(i, 3.5f * there_rad);
        tick();
        motor_moves(i, -3.5f * there_rad);
        TEST_ASSERT_EQUAL(RESTING_TICKS, ticks_in(LOADING_MOVE));
        setUp();
        begin(&along_x);
        tick();
        motor_moves(i, 2.5f * there_rad);
        TEST_ASSERT_EQUAL(RESTING_TICKS - 1, ticks_in(LOADING_MOVE));
        setUp();
        begin(&along_x);
        motor_moves(i, 2.5f * there_rad); /* it has not come as near yet */
        tick();
        motor_moves(i, -2.5f * there_rad);
        TEST_ASSERT_EQUAL(RESTING_TICKS, ticks_in(LOADING_MOVE));
    }
}

/* What a test before has left does not count for the next: neither how its motors stood nor how long. */
static void test_a_start_forgets_the_test_before(void)
{
    brace_loading_t fresh;
    begin(&along_x);
    fresh = test;
    setUp();
    memset(&test, 0x5a, sizeof test);
    test.counts = (brace_loading_counts_t){0};
    begin(&along_x);
    for (int i = 0; i < 40; i++) { /* both at once: ticks of the one, ticks of the other */
        brace_loading_t other = test;
        TEST_ASSERT_EQUAL(fresh.phase, test.phase);
        TEST_ASSERT_EQUAL(fresh.test_us, test.test_us);
        TEST_ASSERT_EQUAL(fresh.limit_us, test.limit_us);
        for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
            TEST_ASSERT_EQUAL_FLOAT(loading_offset_rad(&fresh, joint), loading_offset_rad(&test, joint));
        }
        motor_moves(0, i == 3 ? 2.0f * test.there_rad[0] : 0.0f); /* both would wait for it, or neither */
        motor_moves(1, i == 4 ? 2.0f * test.there_rad[1] : 0.0f);
        test = fresh, tick(), fresh = test;
        test = other, tick();
    }
    TEST_ASSERT_EQUAL(1, test.result.run);
    TEST_ASSERT_EQUAL(0, test.result.rows);
}

/* The second half of a dwell is averaged, and nothing is corrected then. */
static void test_the_second_half_of_a_dwell_is_averaged(void)
{
    brace_loading_setup_t setup = along_x;
    setup.dwell_us = 100000;
    begin(&setup);
    (void)ticks_in(LOADING_MOVE);
    motor_moves(0, 0.003f);
    const float temp_degc = snapshot.temp_degc;
    TEST_ASSERT_TRUE(isnan(temp_degc));
    snapshot.temp_degc = 10.0f;
    float before_rad = 0.0f;
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL(LOADING_DWELL, test.phase);
        snapshot.temp_degc = i < 50 ? 10.0f : i < 75 ? 20.0f : 30.0f;
        loading_step(&test, &inputs);
        const float offset_rad = loading_offset_rad(&test, BRACE_FEMUR);
        TEST_ASSERT_TRUE(i < 50 ? offset_rad < before_rad : offset_rad == before_rad);
        before_rad = offset_rad;
    }
    TEST_ASSERT_EQUAL(LOADING_READ, test.phase);
    tick();
    TEST_ASSERT_EQUAL(1, test.result.rows);
    ASSERT_CLOSE(25.0, test.result.temp_degc, 1e-4);
}

/* The free shape goes a step's way at its rate; each arrival is waited for anew. */
static void test_a_step_s_way_takes_its_time(void)
{
    brace_loading_setup_t setup = along_x;
    setup.step_mm = 0.5f;
    setup.rate_mm_per_s = 10.0f; /* 50 ticks */
    begin(&setup);
    to_row(1);
    TEST_ASSERT_EQUAL(LOADING_MOVE, test.phase);
    int count = 0;
    while (test.along_mm != -0.5f && count < 1000) { /* the tip is displaced against it */
        const float before_mm = test.along_mm;
        tick();
        follow();
        count++;
        TEST_ASSERT_TRUE(before_mm - test.along_mm <= 0.01001f);
    }
    TEST_ASSERT_INT_WITHIN(1, 50, count);
    TEST_ASSERT_EQUAL(RESTING_TICKS, ticks_in(LOADING_MOVE));
}

/* Seven ticks that are a microsecond short of 20 ms together are too few for a motor to have come to rest. */
static void test_a_motor_has_to_rest_for_all_of_20_ms(void)
{
    brace_parameters_t p = *inputs.parameters;
    brace_loading_setup_t setup = along_x;
    p.controller.tick_us = 2857;
    inputs.parameters = &p;
    setup.rate_mm_per_s = 10.0f;
    begin(&setup);
    to_row(1);
    while (test.phase == LOADING_MOVE && test.along_mm != -setup.step_mm) {
        tick();
        follow();
    }
    TEST_ASSERT_EQUAL(8, ticks_in(LOADING_MOVE));
}

/* --- how runs are numbered --------------------------------------------------------------------------------------- */

static void starts_at(float theta1_rad, float theta2_rad, brace_axis_t axis, uint16_t config, uint16_t rep)
{
    brace_loading_setup_t setup = along_x;
    const uint16_t run = test.result.run;
    setup.axis = axis;
    posture.unbent_rad[BRACE_FEMUR] = theta1_rad;
    posture.unbent_rad[BRACE_TIBIA] = theta2_rad;
    TEST_ASSERT_EQUAL(BRACE_OK, loading_start(&test, &inputs, &setup));
    TEST_ASSERT_EQUAL(run + 1, test.result.run);
    TEST_ASSERT_EQUAL(config, test.result.config);
    TEST_ASSERT_EQUAL(rep, test.result.rep);
}

/* A posture that either joint has left by 0.01 rad is another; along each axis it has its own repeats. */
static void test_postures_and_repeats_are_numbered(void)
{
    starts_at(1.0f, 1.4f, BRACE_AXIS_X, 1, 0);
    starts_at(1.009f, 1.391f, BRACE_AXIS_X, 1, 1);
    starts_at(0.991f, 1.409f, BRACE_AXIS_Z, 1, 0);
    starts_at(1.0f, 1.4f, BRACE_AXIS_Z, 1, 1);
    starts_at(1.0f, 1.4f, BRACE_AXIS_X, 1, 2);
    starts_at(1.011f, 1.4f, BRACE_AXIS_X, 2, 0); /* counted from here */
    starts_at(1.020f, 1.4f, BRACE_AXIS_Z, 2, 0);
    starts_at(1.011f, 1.411f, BRACE_AXIS_Z, 3, 0);
    starts_at(1.011f, 1.400f, BRACE_AXIS_Z, 4, 0);
    starts_at(1.000f, 1.400f, BRACE_AXIS_X, 5, 0);
    starts_at(1.000f, 1.400f, BRACE_AXIS_X, 5, 1);
}

/* The first posture is one, a straight limb along x, too. */
static void test_the_first_posture_may_be_all_zeros(void)
{
    starts_at(0.0f, 0.005f, BRACE_AXIS_Z, 1, 0);
    starts_at(0.0f, 0.005f, BRACE_AXIS_Z, 1, 1);
}

/* What cannot begin leaves everything as it was. */
/* What a test has trimmed its motors by goes back as slowly, either joint by itself; then the test is at rest. */
static void test_trims_go_back_at_their_pace(void)
{
    begin(&along_x);
    test.phase = LOADING_RETURN;
    test.along_mm = 0.0f;
    test.trim_rad[0] = 0.004f, test.trim_rad[1] = -0.002f;
    for (int i = 1; i <= 38; i++) { /* 0.1 rad/s */
        tick();
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.004f - 1e-4f * (float)i, test.trim_rad[0]);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, i < 20 ? -0.002f + 1e-4f * (float)i : 0.0f, test.trim_rad[1]);
        TEST_ASSERT_EQUAL(LOADING_RETURN, test.phase);
    }
    TEST_ASSERT_INT_WITHIN(1, 2, ticks_in(LOADING_RETURN));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, test.trim_rad[0]);
    TEST_ASSERT_EQUAL(LOADING_IDLE, test.phase);
}

/* Only what takes longer than a tick is work; and what was read of another step is none. */
static void test_what_counts_as_work(void)
{
    static const uint8_t idle[] = {LOADING_IDLE, LOADING_LISTEN, LOADING_MOVE, LOADING_DWELL, LOADING_RETURN};
    begin(&along_x);
    for (int i = 0; i < 5; i++) {
        reading.is_there = true;
        test.phase = idle[i];
        TEST_ASSERT_FALSE(loading_work(&test, &inputs, &recorder, &reading));
        TEST_ASSERT_FALSE(reading.is_there);
    }
    test.phase = LOADING_COMPARE;
    TEST_ASSERT_TRUE(loading_work(&test, &inputs, &recorder, &reading));
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, test.result.outcome);
}

static void test_what_is_refused_changes_nothing(void)
{
    starts_at(1.0f, 1.4f, BRACE_AXIS_X, 1, 0);
    test.phase = LOADING_IDLE;
    const brace_loading_t before = test;
    TEST_ASSERT_EQUAL(BRACE_OK, loading_may_start(&test, &inputs, &along_x)); /* a question */
    TEST_ASSERT_EQUAL_MEMORY(&before, &test, sizeof test);
    snapshot.k_is_valid = false;
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, loading_may_start(&test, &inputs, &along_x));
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, loading_start(&test, &inputs, &along_x));
    TEST_ASSERT_EQUAL_MEMORY(&before, &test, sizeof test);
    loading_end(&test, BRACE_LOADING_E_LOST); /* nothing runs that could end */
    TEST_ASSERT_EQUAL_MEMORY(&before, &test, sizeof test);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_force_that_is_none_on_either_axis_ends_it);
    RUN_TEST(test_a_dwell_without_a_sample_ends_it);
    RUN_TEST(test_the_force_may_change_by_its_bound);
    RUN_TEST(test_the_torque_of_either_motor_is_bounded);
    RUN_TEST(test_the_way_of_either_motor_is_bounded);
    RUN_TEST(test_a_flank_that_was_taken_up_must_hold);
    RUN_TEST(test_the_time_runs_from_the_start);
    RUN_TEST(test_motors_that_stand_there_are_read_after_20_ms);
    RUN_TEST(test_motors_that_do_not_come_there_have_three_seconds);
    RUN_TEST(test_three_seconds_in_each_step);
    RUN_TEST(test_a_servo_is_pushed_only_so_far);
    RUN_TEST(test_commanded_steps_wait_for_no_motor);
    RUN_TEST(test_how_near_a_motor_has_to_come);
    RUN_TEST(test_who_passes_through_begins_anew_and_who_wavers_does_not);
    RUN_TEST(test_a_start_forgets_the_test_before);
    RUN_TEST(test_the_second_half_of_a_dwell_is_averaged);
    RUN_TEST(test_a_step_s_way_takes_its_time);
    RUN_TEST(test_a_motor_has_to_rest_for_all_of_20_ms);
    RUN_TEST(test_postures_and_repeats_are_numbered);
    RUN_TEST(test_the_first_posture_may_be_all_zeros);
    RUN_TEST(test_trims_go_back_at_their_pace);
    RUN_TEST(test_what_counts_as_work);
    RUN_TEST(test_what_is_refused_changes_nothing);
    return UNITY_END();
}
