/* The drift check in the controller: what reaches it, what it says, what a restart keeps of it. */
#include "loading_bench.h"
#include "measure/loading.h"

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

/* Stands at one of four postures, the truth being this limb's K there, and runs a test. */
static void test_at(int turn, const brace_limb_t *limb, const brace_loading_setup_t *setup)
{
    static const double posture[4][2] = {{1.0, 1.4}, {0.7, 1.8}, {1.3, 1.0}, {0.5, 1.2}};
    brace_planar_t planar;
    brace_stiffness_t k;
    theta1 = posture[turn % 4][0];
    theta2 = posture[turn % 4][1];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, (float)theta1, (float)theta2, &k));
    truth = (symmetric_t){(double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm, (double)k.k_zz_n_per_mm};
    brace_loading_setup_t next = *setup;
    next.axis = turn / 4 % 2 == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
    ticks(2);
    run(&next);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
}

static void test_a_link_that_cracks_is_noticed_and_the_alarm_is_cleared_on_request(void)
{
    brace_loading_setup_t quick = along_x;
    quick.dwell_us = 20000;
    quick.rate_mm_per_s = 200.0f;
    quick.source = BRACE_LOADING_COMMANDED; /* stiff servos follow at once */
    servo_n_mm_per_rad = 1e9;
    noise_n = 0.02f;
    brace_limb_t limb = app.parameters.limb;
    int turn = 0;
    for (; turn < BRACE_DRIFT_LEARN_MOST / 16 + 4 && app.drift.state == BRACE_DRIFT_LEARNING; turn++) {
        test_at(turn, &limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, app.drift.state);
    TEST_ASSERT_EQUAL(0, now()->faults);
    limb.link[BRACE_TIBIA].bending_mm_per_n *= 1.5f;
    for (int i = 0; i < 8 && now()->faults == 0; i++) {
        test_at(turn++, &limb, &quick);
    }
    TEST_ASSERT_EQUAL(BRACE_FAULT_MODEL_DRIFT, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT));
    ticks(1);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

/* Runs a test tick by tick; run_at: how many readings the check's run has after each step. returns the steps it took in */
static uint32_t watched_run(const brace_loading_setup_t *setup, uint8_t run_at[32])
{
    const uint32_t before = app.drift.steps;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, setup));
    for (int i = 0; i < 60000 && app.mode == BRACE_MODE_LOADING_TEST; i++) {
        const bool checks = app.loading.phase == LOADING_DRIFT;
        const uint32_t step = app.loading.step;
        ticks(1);
        if (checks) {
            run_at[step] = app.drift.run_count;
        }
    }
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    return app.drift.steps - before;
}

/* Friction turns round with the motion: what came before a reversal is no mean for what comes after. */
static void test_a_run_of_the_check_ends_at_each_reversal(void)
{
    uint8_t run_at[32] = {0};
    TEST_ASSERT_EQUAL(16, watched_run(&along_x, run_at));
    static const uint8_t expected[17] = {0, 1, 2, 3, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4};
    TEST_ASSERT_EQUAL_UINT8_ARRAY(expected, run_at, 17);
}

static void test_readings_with_a_gap_open_do_not_reach_the_check(void)
{
    uint8_t run_at[32] = {0};
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    stand(&p);
    tip_is_free = true; /* nothing loads the joint: no flank carries */
    ticks(300);
    TEST_ASSERT_BITS(BRACE_FLAG_GAP_OPEN, BRACE_FLAG_GAP_OPEN, now()->stiffness.now.flags);
    TEST_ASSERT_EQUAL(0, watched_run(&along_x, run_at));
    TEST_ASSERT_EQUAL(0, app.drift.run_count);
    p.limb.joint[BRACE_TIBIA].gap_rad = 0.0f;
    stand(&p);
    tip_is_free = true;
    ticks(300);
    TEST_ASSERT_EQUAL(16, watched_run(&along_x, run_at));
}

static void test_readings_without_a_sensor_do_not_reach_the_check(void)
{
    uint8_t run_at[32] = {0};
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(200);
    TEST_ASSERT_EQUAL(0, watched_run(&along_x, run_at));
}

static void test_a_tick_that_is_late_is_told_whatever_it_works_at(void)
{
    static const uint8_t phases[] = {LOADING_MOVE, LOADING_READ, LOADING_DRIFT, LOADING_JUDGE};
    for (uint32_t i = 0; i < sizeof phases; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &along_x));
        for (int tick = 0; tick < 60000 && app.loading.phase != phases[i]; tick++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(phases[i], app.loading.phase);
        const uint32_t late = brace_app_counters(&app)->ticks_late;
        fake.now_us += 5 * TICK_US;
        ticks(1);
        TEST_ASSERT_EQUAL(late + 1, brace_app_counters(&app)->ticks_late);
        ticks(8); /* the pieces that follow compute no snapshot */
        TEST_ASSERT_BITS(BRACE_FAULT_TICK_LATE, BRACE_FAULT_TICK_LATE, now()->faults);
        (void)brace_app_loading_stop(&app);
        for (int tick = 0; tick < 3000 && (app.mode != BRACE_MODE_MONITOR || now()->faults != 0); tick++) {
            ticks(1);
        }
        TEST_ASSERT_EQUAL(0, now()->faults);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_run_of_the_check_ends_at_each_reversal);
    RUN_TEST(test_readings_with_a_gap_open_do_not_reach_the_check);
    RUN_TEST(test_readings_without_a_sensor_do_not_reach_the_check);
    RUN_TEST(test_a_tick_that_is_late_is_told_whatever_it_works_at);
    RUN_TEST(test_a_link_that_cracks_is_noticed_and_the_alarm_is_cleared_on_request);
    return UNITY_END();
}
