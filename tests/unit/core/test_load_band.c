/* Where a load behind a gear lies. The oracle is the law solved by hand. */
#include <math.h>
#include <stdint.h>

#include "brace/load_band.h"
#include "unity.h"

/* The MX-106 by model M5 of the published fit, and with the tolerance of a gear that is known exactly. */
static const brace_gear_t mx106 = {.friction_n_mm = 122.4f,
                                   .per_torque_ratio = 0.4028f,
                                   .per_load_ratio = 0.1076f,
                                   .tolerance_ratio = 0.0f,
                                   .sliding_ratio = 0.5f};

void setUp(void) {}

void tearDown(void) {}

static float low_of(const brace_load_band_t *band)
{
    return band->middle_n_mm - band->half_n_mm;
}

static float high_of(const brace_load_band_t *band)
{
    return band->middle_n_mm + band->half_n_mm;
}

/* The fit has a joint at rest hold 0.97 to 3.28 N m at one torque of 2 N m, whichever way it turned before. */
static void test_a_standing_joint_holds_what_the_published_fit_says(void)
{
    brace_load_band_t band;
    for (int way = -1; way <= 1; way++) {
        brace_load_band(&mx106, 2000.0f, (float)way, false, &band);
        TEST_ASSERT_FLOAT_WITHIN(5.0f, 970.0f, low_of(&band));
        TEST_ASSERT_FLOAT_WITHIN(5.0f, 3280.0f, high_of(&band));
        TEST_ASSERT_EQUAL_FLOAT(-(float)way, band.near_end);
        brace_load_band(&mx106, -2000.0f, (float)way, false, &band);
        TEST_ASSERT_FLOAT_WITHIN(5.0f, -3280.0f, low_of(&band));
        TEST_ASSERT_FLOAT_WITHIN(5.0f, -970.0f, high_of(&band));
    }
}

/* Every load in the band satisfies the law, none beyond it does. */
static void test_the_ends_are_those_of_the_law(void)
{
    brace_load_band_t band;
    for (float torque = -3000.0f; torque <= 3000.0f; torque += 250.0f) {
        brace_load_band(&mx106, torque, 0.0f, false, &band);
        for (float share = -1.1f; share <= 1.1f; share += 0.2f) {
            const float load = band.middle_n_mm + share * band.half_n_mm;
            const float holds = mx106.friction_n_mm + fabsf(0.4028f * torque + 0.1076f * load);
            TEST_ASSERT_EQUAL(fabsf(share) < 1.0f, fabsf(torque - load) < holds);
        }
    }
}

/* Dry friction alone: torque less friction that turns it, from half of it to all. */
static void test_a_turning_joint_has_friction_against_it(void)
{
    const brace_gear_t dry = {.friction_n_mm = 100.0f, .sliding_ratio = 0.5f};
    brace_load_band_t band;
    brace_load_band(&dry, 1000.0f, 1.0f, true, &band);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 900.0f, low_of(&band));
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 950.0f, high_of(&band));
    brace_load_band(&dry, 1000.0f, -1.0f, true, &band);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 1050.0f, low_of(&band));
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 1100.0f, high_of(&band));
    brace_load_band(&dry, -1000.0f, 1.0f, true, &band);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, -1100.0f, low_of(&band));
    TEST_ASSERT_FLOAT_WITHIN(0.01f, -1050.0f, high_of(&band));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, band.near_end);
    brace_load_band(&dry, 1000.0f, 0.0f, true, &band); /* the way is not known */
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 900.0f, low_of(&band));
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 1100.0f, high_of(&band));
}

/* Friction behind the gear holds more on both sides, with its share of the load. */
static void test_the_joint_rubs_too(void)
{
    const brace_gear_t joint = {.joint_n_mm = 50.0f, .joint_per_load_ratio = 0.1f};
    brace_load_band_t band;
    brace_load_band(&joint, 1000.0f, 0.0f, false, &band);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 850.0f, low_of(&band));
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 1150.0f, high_of(&band));
}

static void test_a_gear_that_no_load_turns_back_has_an_end_all_the_same(void)
{
    const brace_gear_t worm = {.per_torque_ratio = 0.9f, .per_load_ratio = 0.9f, .tolerance_ratio = 1.0f};
    brace_load_band_t band;
    brace_load_band(&worm, 1000.0f, -1.0f, false, &band);
    TEST_ASSERT_TRUE(isfinite(band.half_n_mm) && high_of(&band) > 20000.0f);
}

/* Where both joints came to stand at ends that add up, the sum of these ends is inside. */
static void test_where_the_joints_came_to_stand_is_inside(void)
{
    const brace_load_band_t one = {0.0f, 40.0f, 0.0f, 1.0f}, two = {0.0f, 25.0f, 0.0f, -1.0f};
    const brace_interval_t low = brace_load_band_sum(&one, -1.0f, &two, 1.0f, 0.0f);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, -65.0f, low.low);
    TEST_ASSERT_TRUE(low.high < 65.0f - 20.0f);
    const brace_interval_t high = brace_load_band_sum(&one, 1.0f, &two, -1.0f, 0.0f);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 65.0f, high.high);
    const brace_interval_t alone = brace_load_band_alone(&one);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 40.0f, alone.high);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, -36.0f, alone.low);
}

static void test_what_is_not_known_stays_so(void)
{
    brace_load_band_t band;
    brace_load_band(&mx106, NAN, 0.0f, false, &band);
    const brace_interval_t alone = brace_load_band_alone(&band);
    TEST_ASSERT_TRUE(isnan(alone.low) && isnan(alone.high));
    const brace_load_band_t known = {1.0f, 1.0f, 1.0f, 0.0f};
    const brace_interval_t sum = brace_load_band_sum(&known, 1.0f, &known, 1.0f, NAN);
    TEST_ASSERT_TRUE(isnan(sum.low) && isnan(sum.high));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_standing_joint_holds_what_the_published_fit_says);
    RUN_TEST(test_the_ends_are_those_of_the_law);
    RUN_TEST(test_a_turning_joint_has_friction_against_it);
    RUN_TEST(test_the_joint_rubs_too);
    RUN_TEST(test_a_gear_that_no_load_turns_back_has_an_end_all_the_same);
    RUN_TEST(test_where_the_joints_came_to_stand_is_inside);
    RUN_TEST(test_what_is_not_known_stays_so);
    return UNITY_END();
}
