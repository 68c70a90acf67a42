/* Which side of a joint's play a load takes up, and what counts as engaged. */
#include <math.h>

#include "brace/backlash.h"
#include "brace/play.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static const brace_play_joint_t dry = {
    .coulomb_n_mm = 100.0f, .coulomb_per_load_ratio = 0.1f, .noise_n = 0.05f, .gain_rel = 0.005f};

/* A load of 1,000 N mm may be off by friction (100 + 0.1 * 1000) / 0.9, noise 6 * 0.05 * 300, trust 0.05 * 1000. */
static void test_the_load_may_be_off_by_friction_noise_and_trust(void)
{
    const brace_play_t play = brace_play_under_load(&dry, 1000.0f, 300.0f);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 222.222f + 90.0f + 50.0f, play.off_n_mm);
    TEST_ASSERT_EQUAL(1, play.flank);
    TEST_ASSERT_EQUAL(-1, brace_play_under_load(&dry, -1000.0f, 300.0f).flank);
}

/* Held where |load| > 111.1 + 90 + (0.1111 + 0.05) |load|: from 239.74 N mm on. */
static void test_a_load_within_its_uncertainty_holds_no_side(void)
{
    TEST_ASSERT_EQUAL(0, brace_play_under_load(&dry, 239.0f, 300.0f).flank);
    TEST_ASSERT_EQUAL(1, brace_play_under_load(&dry, 240.5f, 300.0f).flank);
    TEST_ASSERT_EQUAL(0, brace_play_under_load(&dry, -239.0f, 300.0f).flank);
    TEST_ASSERT_EQUAL(-1, brace_play_under_load(&dry, -240.5f, 300.0f).flank);
    TEST_ASSERT_EQUAL(0, brace_play_under_load(&dry, 0.0f, 0.0f).flank);
    TEST_ASSERT_EQUAL(0, brace_play_under_load(&dry, NAN, 300.0f).flank);
}

static void expect(brace_engagement_t found, int flank, bool is_engaged, bool is_assumed)
{
    TEST_ASSERT_EQUAL(flank, found.flank);
    TEST_ASSERT_EQUAL(is_engaged, found.is_engaged);
    TEST_ASSERT_EQUAL(is_assumed, found.is_assumed);
}

static void test_a_named_side_counts_where_the_load_holds_the_same(void)
{
    expect(brace_play_engagement(0, false, true, 1), 0, false, false);
    expect(brace_play_engagement(1, false, true, 0), 1, false, false);
    expect(brace_play_engagement(1, false, true, -1), 1, false, false);
    expect(brace_play_engagement(1, false, true, 1), 1, true, true);
    expect(brace_play_engagement(1, true, true, -1), 1, true, false); /* proven: whatever the load says */
    expect(brace_play_engagement(-1, false, false, 0), -1, true, true); /* nothing measures the load */
}

static brace_backlash_t watched(void)
{
    const brace_backlash_params_t params = {.tick_us = 1000,
                                            .gap_rad = 0.004f,
                                            .friction_n_mm = 200.0f,
                                            .friction_tolerance_ratio = 0.5f,
                                            .inertia_n_mm_s2_per_rad = 20.0f,
                                            .torque_range_n_mm = 8000.0f,
                                            .torque_noise_n_mm = 0.0f,
                                            .torque_bias_n_mm = 80.0f,
                                            .angle_step_rad = 2e-5f,
                                            .takeup = {.torque_max_n_mm = 4000.0f,
                                                       .travel_max_rad = 0.1f,
                                                       .reach_max_rad = 0.3f,
                                                       .rate_rad_per_s = 0.1f,
                                                       .time_max_us = 8000000u,
                                                       .verify_us = 100000u}};
    brace_backlash_t machine;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_backlash_init(&machine, &params));
    return machine;
}

/* A standing motor without noise proves a side from 200 * 1.5 + 80 = 380 N mm on. */
static void test_at_rest_a_load_is_open_then_assumed_then_proven(void)
{
    const brace_backlash_t machine = watched();
    expect(brace_play_at_rest(&dry, &machine, 230.0f, 300.0f, true), 0, false, false);
    expect(brace_play_at_rest(&dry, &machine, 375.0f, 300.0f, true), 1, true, true);
    expect(brace_play_at_rest(&dry, &machine, 385.0f, 300.0f, true), 1, true, false);
    expect(brace_play_at_rest(&dry, &machine, -385.0f, 300.0f, true), -1, true, false);
    expect(brace_play_at_rest(&dry, &machine, NAN, 300.0f, true), 0, false, false);
    expect(brace_play_at_rest(&dry, NULL, 5000.0f, 300.0f, true), 0, false, false);
}

/* The machine itself, ticked for two seconds from its start, ends where brace_backlash_at_rest says. */
static void test_at_rest_is_where_ticks_end(void)
{
    for (int i = -60; i <= 60; i++) {
        const float load_n_mm = 10.0f * (float)i + 1.0f;
        for (int expected = 0; expected < 2; expected++) {
            brace_backlash_t machine = watched();
            brace_backlash_sample_t sample = {.torque_n_mm = load_n_mm,
                                              .load_is_expected = expected != 0,
                                              .expected_n_mm = load_n_mm,
                                              .expected_off_n_mm = 150.0f};
            int flank = 9;
            bool is_proven = false;
            TEST_ASSERT_EQUAL(BRACE_OK, brace_backlash_at_rest(&machine, &sample, &flank, &is_proven));
            brace_backlash_out_t out;
            for (int tick = 0; tick < 2000; tick++) {
                sample.now_us += 1000u;
                TEST_ASSERT_EQUAL(BRACE_OK, brace_backlash_tick(&machine, &sample, &out));
            }
            TEST_ASSERT_EQUAL(out.flank, flank);
            TEST_ASSERT_EQUAL(out.valid, is_proven);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_load_may_be_off_by_friction_noise_and_trust);
    RUN_TEST(test_a_load_within_its_uncertainty_holds_no_side);
    RUN_TEST(test_a_named_side_counts_where_the_load_holds_the_same);
    RUN_TEST(test_at_rest_a_load_is_open_then_assumed_then_proven);
    RUN_TEST(test_at_rest_is_where_ticks_end);
    return UNITY_END();
}
