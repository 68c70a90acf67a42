#include <math.h>
#include <string.h>

#include "brace/planar_table.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324

/* Of what the header promises; the slender sample is the one that needs all of it. */
#define ERROR_LIMIT 2e-6
#define AXIS_LIMIT_RAD 1e-6

static brace_planar_t planar;
static brace_planar_table_t table;

void setUp(void)
{
    memset(&table, 0, sizeof table);
}

void tearDown(void)
{
}

static void build(const brace_limb_t *limb)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_table_build(&planar, &table));
}

static void expect_reference(const brace_limb_t *limb, float theta1_rad, float theta2_rad)
{
    const reference_planar_t r = reference_planar(limb, (double)theta1_rad, (double)theta2_rad);
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_table_stiffness(&table, theta1_rad, theta2_rad, &k));
    TEST_ASSERT_EQUAL(0, k.flags);
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT, 0.0, reference_error(&r, &k));
    TEST_ASSERT_DOUBLE_WITHIN(AXIS_LIMIT_RAD, 0.0, reference_axis_error(&r, &k));
    TEST_ASSERT_TRUE(fabsf(k.stiff_axis_rad) <= 1.5707964f);
}

static void test_samples_over_the_workspace(void)
{
    static const int samples[] = {SAMPLE_PAPER, SAMPLE_BEAM, SAMPLE_TILTED};
    for (size_t s = 0; s < sizeof samples / sizeof *samples; s++) {
        const brace_limb_t *limb = &sample_limb[samples[s]];
        build(limb);
        for (int i = -5; i <= 5; i++) {
            for (int j = -67; j <= 67; j++) { /* no divisor of the table's stretches */
                expect_reference(limb, (float)(i * PI / 5.0), (float)(j * PI / 67.0));
            }
        }
    }
}

static void test_close_to_straight_and_folded(void)
{
    const brace_limb_t *limb = &sample_limb[SAMPLE_PAPER];
    build(limb);
    for (float off = 1e-7f; off < 0.3f; off *= 1.9f) {
        expect_reference(limb, -2.0f, off);
        expect_reference(limb, 0.7f, -off);
        expect_reference(limb, 1.9f, (float)PI - off);
        expect_reference(limb, -0.2f, off - (float)PI);
    }
}

static void test_reach_and_refusal(void)
{
    brace_stiffness_t k, before;
    build(&sample_limb[SAMPLE_PAPER]);
    memset(&k, 0x5a, sizeof k);
    before = k;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_planar_table_stiffness(&table, 0.0f, 5.568f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_planar_table_stiffness(&table, NAN, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_planar_table_stiffness(&table, 1.0f, INFINITY, &k));
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
    expect_reference(&sample_limb[SAMPLE_PAPER], 5.5f, -0.5f);
    expect_reference(&sample_limb[SAMPLE_PAPER], 0.5f, 5.5f);
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_table_build(NULL, &table));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_table_build(&planar, NULL));
}

/* Where both ellipsoids are round and equal but for rounding, the axis is noise: no table can follow it. */
static void test_a_limb_that_no_table_can_follow_is_refused(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_SLENDER];
    limb.link[BRACE_FEMUR] = (brace_link_t){0.02f, 0.2f, 0.0f, 0, 0, 0};
    limb.link[BRACE_TIBIA] = (brace_link_t){0.02f, 0.2f, 0.0f, 0, 0, 0}; /* at a right angle C is round */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_planar_table_build(&planar, &table));
}

/* Soft springs beside stiff links: lambda_max peaks too sharply when the limb is straight. */
static void test_a_peak_too_sharp_for_the_table_is_refused(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 3.2e-4f;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 3.2e-4f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_E_UNSUPPORTED, brace_planar_table_build(&planar, &table));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_samples_over_the_workspace);
    RUN_TEST(test_close_to_straight_and_folded);
    RUN_TEST(test_reach_and_refusal);
    RUN_TEST(test_a_limb_that_no_table_can_follow_is_refused);
    RUN_TEST(test_a_peak_too_sharp_for_the_table_is_refused);
    return UNITY_END();
}
