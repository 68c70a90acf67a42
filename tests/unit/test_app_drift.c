/* The drift check in the controller: what reaches it, what it says, what a restart keeps of it. */
#include "loading_bench.h"

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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_link_that_cracks_is_noticed_and_the_alarm_is_cleared_on_request);
    return UNITY_END();
}
