/* Sine, cosine and arctangent against the library's in double precision, each within what base/trig.h promises and the
 * rounding of a float, over its whole range. */
#include "base/trig.h"

#include <stdbool.h>

#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

#ifdef __arm__
enum { STEPS = 2000 };
#else
enum { STEPS = 20000 };
#endif

static float at(int i, double most)
{
    return (float)(most * (2.0 * i / STEPS - 1.0));
}

static void test_sine_and_cosine_of_a_quarter_turn(void)
{
    for (int i = 0; i <= STEPS; i++) {
        const float x = at(i, 1.57079632);
        const double right_sine = sin((double)x), right_cosine = cos((double)x);
        TEST_ASSERT_DOUBLE_WITHIN(2e-7 * fabs(right_sine), right_sine, (double)brace_sine(x));
        TEST_ASSERT_DOUBLE_WITHIN(2e-7 * fabs(right_cosine) + 1e-14, right_cosine, (double)brace_cosine(x));
        TEST_ASSERT_DOUBLE_WITHIN(2.5e-7, right_cosine, (double)brace_cosine_coarse(x));
        const float low = 3e-8f * (float)(i % 3 - 1);
        const double right_of_parts = cos((double)x + (double)low);
        TEST_ASSERT_DOUBLE_WITHIN(2e-7 * fabs(right_of_parts) + 1e-14, right_of_parts,
                                  (double)brace_cosine_of_parts(x, low));
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0f, brace_sine(0.0f));
    TEST_ASSERT_EQUAL_FLOAT(1.0f, brace_cosine_coarse(0.0f));
}

static void test_small_turns(void)
{
    for (int i = 0; i <= STEPS; i++) {
        const float x = at(i, 0.6);
        const double size = fabs((double)x);
        const brace_vec_t turn = brace_small_turn(x);
        const bool is_near = size <= 0.35;
        TEST_ASSERT_DOUBLE_WITHIN(is_near ? 1.2e-7 : 5e-6, sin((double)x), (double)turn.z);
        TEST_ASSERT_DOUBLE_WITHIN(is_near ? 3.3e-7 : 4.4e-5, cos((double)x), (double)turn.x);
    }
    TEST_ASSERT_EQUAL_FLOAT(1.0f, brace_small_turn(0.0f).x);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, brace_small_turn(0.0f).z);
}

static void test_directions_of_many_turns(void)
{
    for (int i = 0; i <= STEPS; i++) {
        const float x = at(i, 16.0);
        const brace_vec_t direction = brace_direction(x);
        TEST_ASSERT_DOUBLE_WITHIN(1.3e-7, cos((double)x), (double)direction.x);
        TEST_ASSERT_DOUBLE_WITHIN(1.3e-7, sin((double)x), (double)direction.z);
    }
}

static void test_the_angle_of_a_vector(void)
{
    for (int i = 0; i <= STEPS; i++) {
        const double angle = (double)at(i, 3.14159265), length = pow(10.0, -25.0 + 50.0 * i / STEPS);
        const float x = (float)(length * cos(angle)), y = (float)(length * sin(angle));
        const double right = atan2((double)y, (double)x);
        TEST_ASSERT_DOUBLE_WITHIN(x >= 0.0f ? 2.1e-7 : 4.2e-7, right, (double)brace_atan2(y, x));
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0f, brace_atan2(0.0f, 0.0f));
    TEST_ASSERT_FLOAT_WITHIN(3e-7f, BRACE_PI, brace_atan2(0.0f, -1.0f));
    TEST_ASSERT_TRUE(brace_atan2(0.0f, -1.0f) > 0.0f);
    TEST_ASSERT_FLOAT_WITHIN(3e-7f, BRACE_HALF_PI, brace_atan2(2.0f, 0.0f));
    TEST_ASSERT_FLOAT_WITHIN(3e-7f, -BRACE_HALF_PI, brace_atan2(-2.0f, 0.0f));
    TEST_ASSERT_FLOAT_WITHIN(3e-7f, BRACE_QUARTER_PI, brace_atan2(1.0f, 1.0f));
}

/* An axis: half the angle of -(x, z). */
static void test_the_axis_of_a_deviator(void)
{
    for (int i = 0; i <= STEPS; i++) {
        const double angle = (double)at(i, 3.14159265);
        const float x = (float)(7.0 * cos(angle)), z = (float)(7.0 * sin(angle));
        const double right = 0.5 * atan2(-(double)z, -(double)x);
        TEST_ASSERT_DOUBLE_WITHIN(4e-7, 0.0, sin((double)brace_half_angle_of_opposite(x, z, 7.0f) - right));
        TEST_ASSERT_TRUE(fabsf(brace_half_angle_of_opposite(x, z, 7.0f)) < BRACE_HALF_PI + 4e-7f);
    }
}

/* Half a turn stays as it is; what lies beyond it loses a turn. */
static void test_angles_are_wrapped_beyond_half_a_turn(void)
{
    TEST_ASSERT_TRUE(brace_wrapped(BRACE_PI) == BRACE_PI && brace_wrapped(-BRACE_PI) == -BRACE_PI);
    TEST_ASSERT_TRUE(brace_wrapped(nextafterf(BRACE_PI, 4.0f)) < 0.0f);
    TEST_ASSERT_TRUE(brace_wrapped(nextafterf(-BRACE_PI, -4.0f)) > 0.0f);
    for (int i = 0; i <= STEPS; i++) {
        const float x = at(i, 9.42);
        const double right = (double)x - 6.28318530717958648 * round((double)x / 6.28318530717958648);
        TEST_ASSERT_DOUBLE_WITHIN(6e-7, 0.0, sin((double)brace_wrapped(x) - right));
        TEST_ASSERT_TRUE(fabsf(brace_wrapped(x)) <= BRACE_PI);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sine_and_cosine_of_a_quarter_turn);
    RUN_TEST(test_small_turns);
    RUN_TEST(test_directions_of_many_turns);
    RUN_TEST(test_the_angle_of_a_vector);
    RUN_TEST(test_the_axis_of_a_deviator);
    RUN_TEST(test_angles_are_wrapped_beyond_half_a_turn);
    return UNITY_END();
}
