/* Angles in batches: each row as the single function gives it, NaN where that refuses. */
#include <math.h>

#include "brace/kinematics_batch.h"
#include "sample_limbs.h"
#include "unity.h"

enum { ROWS = 4 };

void setUp(void) {}

void tearDown(void) {}

static void test_rows_are_the_single_function_s(void)
{
    static const float x_mm[ROWS] = {300.0f, 250.0f, 1e4f, NAN}, z_mm[ROWS] = {-100.0f, 50.0f, 0.0f, 0.0f};
    static const uint8_t knee[ROWS] = {BRACE_KNEE_UP, BRACE_KNEE_DOWN, BRACE_KNEE_UP, BRACE_KNEE_UP};
    const brace_limb_t *limb = &sample_limb[SAMPLE_PAPER];
    float theta1_rad[ROWS], theta2_rad[ROWS], single1_rad, single2_rad;
    TEST_ASSERT_EQUAL(2, brace_kinematics_inverse_batch(limb, ROWS, x_mm, z_mm, knee, theta1_rad, theta2_rad));
    for (int i = 0; i < 2; i++) {
        const brace_point_t tip = {x_mm[i], z_mm[i]};
        TEST_ASSERT_EQUAL(BRACE_OK,
                          brace_kinematics_inverse(limb, tip, (brace_knee_t)knee[i], &single1_rad, &single2_rad));
        TEST_ASSERT_EQUAL_FLOAT(single1_rad, theta1_rad[i]);
        TEST_ASSERT_EQUAL_FLOAT(single2_rad, theta2_rad[i]);
    }
    TEST_ASSERT_EQUAL(0, brace_kinematics_inverse_batch(limb, 0, x_mm, z_mm, knee, theta1_rad, theta2_rad));
    TEST_ASSERT_TRUE(isnan(theta1_rad[2]) && isnan(theta2_rad[2]) && isnan(theta1_rad[3]) && isnan(theta2_rad[3]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rows_are_the_single_function_s);
    return UNITY_END();
}
