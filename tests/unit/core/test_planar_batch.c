#include <math.h>
#include <string.h>

#include "brace/planar_batch.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324

/* What the header promises. */
#define ERROR_LIMIT 2e-6
#define AXIS_LIMIT_RAD 1e-6

enum { SIDE = 37, COUNT = SIDE * SIDE, COLUMNS = 6 };

static float theta1[COUNT], theta2[COUNT], column[COLUMNS][COUNT + 1];
static const brace_stiffness_soa_t out = {column[0], column[1], column[2], column[3], column[4], column[5]};

static brace_stiffness_t row(int i)
{
    return (brace_stiffness_t){column[0][i], column[1][i], column[2][i], column[3][i], column[4][i], column[5][i], 0};
}

void setUp(void)
{
    for (int i = 0; i < COUNT; i++) {
        theta1[i] = (float)(PI * (2.0 * (i / SIDE) / (SIDE - 1) - 1.0));
        theta2[i] = (float)(PI * (2.0 * (i % SIDE) / (SIDE - 1) - 1.0));
    }
    memset(column, 0x5a, sizeof column);
}

void tearDown(void) {}

static void test_every_sample_over_the_workspace(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        brace_planar_t planar;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[sample], &planar));
        TEST_ASSERT_EQUAL(0, brace_planar_batch(&planar, COUNT, theta1, theta2, &out));
        for (int i = 0; i < COUNT; i++) {
            const brace_stiffness_t k = row(i);
            const reference_planar_t r = reference_planar(&sample_limb[sample], (double)theta1[i], (double)theta2[i]);
            TEST_ASSERT_TRUE(reference_error(&r, &k) < ERROR_LIMIT);
            TEST_ASSERT_TRUE(reference_axis_error(&r, &k) < AXIS_LIMIT_RAD);
        }
    }
}

static void test_a_posture_is_the_same_wherever_it_stands(void)
{
    brace_planar_t planar;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[SAMPLE_TILTED], &planar));
    for (int i = 0; i < 41; i++) {
        theta1[i] = 1.0f;
        theta2[i] = 1.4f;
    }
    for (size_t n = 0; n <= 41; n++) { /* every length of the rest that vectors leave */
        memset(column, 0x5a, sizeof column);
        float untouched;
        memcpy(&untouched, column[0], sizeof untouched);
        TEST_ASSERT_EQUAL(0, brace_planar_batch(&planar, n, theta1, theta2, &out));
        for (int c = 0; c < COLUMNS; c++) {
            for (size_t i = 1; i < n; i++) {
                TEST_ASSERT_EQUAL_FLOAT(column[c][0], column[c][i]);
            }
            TEST_ASSERT_EQUAL_MEMORY(&untouched, &column[c][n], sizeof untouched);
        }
    }
}

static void test_what_is_no_angle_gives_nan_and_is_counted(void)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, 7.901f, -7.901f, 1e30f};
    enum { BAD = sizeof bad / sizeof bad[0] };
    for (int sample = SAMPLE_PAPER; sample <= SAMPLE_TILTED; sample++) {
        brace_planar_t planar;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[sample], &planar));
        for (int i = 0; i < BAD; i++) {
            theta1[3 * i] = bad[i];
            theta2[3 * i + 1] = bad[i];
        }
        TEST_ASSERT_EQUAL(2 * BAD, brace_planar_batch(&planar, COUNT, theta1, theta2, &out));
        for (int i = 0; i < 3 * BAD; i++) {
            for (int c = 0; c < COLUMNS; c++) {
                TEST_ASSERT_EQUAL(i % 3 != 2, isnan(column[c][i]) != 0);
            }
        }
    }
}

static void test_ends_of_the_range_are_angles(void)
{
    brace_planar_t planar;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[SAMPLE_BEAM], &planar));
    const float end = 7.9f;
    const float first[4] = {end, -end, end, -end}, second[4] = {end, end, -end, -end};
    TEST_ASSERT_EQUAL(0, brace_planar_batch(&planar, 4, first, second, &out));
    for (int i = 0; i < 4; i++) {
        const brace_stiffness_t k = row(i);
        const reference_planar_t r = reference_planar(&sample_limb[SAMPLE_BEAM], (double)first[i], (double)second[i]);
        TEST_ASSERT_TRUE(reference_error(&r, &k) < ERROR_LIMIT);
    }
}

static void test_round_compliance_is_no_trap(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_ROUND];
    brace_planar_t planar;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
    TEST_ASSERT_EQUAL(0, brace_planar_batch(&planar, 3, theta1, theta2, &out));
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 1.0f / 0.15f, column[3][1]);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 1.0f / 0.15f, column[4][1]);
    TEST_ASSERT_FLOAT_WITHIN(1.5708f, 0.0f, column[5][1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_over_the_workspace);
    RUN_TEST(test_a_posture_is_the_same_wherever_it_stands);
    RUN_TEST(test_what_is_no_angle_gives_nan_and_is_counted);
    RUN_TEST(test_ends_of_the_range_are_angles);
    RUN_TEST(test_round_compliance_is_no_trap);
    return UNITY_END();
}
