/* Numbers of a limb as words of the fixed-point path (loaded/fixed_quantise.h). */
#include <stdint.h>

#include "loaded/fixed_quantise.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* quantised rounds to the nearest integer, above and below zero. A number beyond a word becomes the largest of
 * its sign, whose negative is a word, too; what is no number becomes a word as well. */
static void test_a_number_becomes_the_nearest_word(void)
{
    for (int whole = -3; whole <= 3; whole++) {
        TEST_ASSERT_EQUAL_INT32(whole, quantised(((double)whole + 0.49) / 1024.0, 10));
        TEST_ASSERT_EQUAL_INT32(whole, quantised(((double)whole - 0.49) / 1024.0, 10));
    }
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, quantised(1.0 - 1e-12, 31));
    TEST_ASSERT_EQUAL_INT32(-INT32_MAX, quantised(-1.0, 31));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, quantised(INFINITY, 31));
    TEST_ASSERT_EQUAL_INT32(-INT32_MAX, quantised(-INFINITY, 0));
    TEST_ASSERT_EQUAL_INT32(-INT32_MAX, quantised(NAN, 31));
}

/* exponent_above returns the exponent of the next power of two above a number. For a number near zero it returns
 * LEAST_EXPONENT. */
static void test_the_power_of_two_above_a_number(void)
{
    TEST_ASSERT_EQUAL_INT32(1, exponent_above(1.0f));
    TEST_ASSERT_EQUAL_INT32(1, exponent_above(-1.99f));
    TEST_ASSERT_EQUAL_INT32(-3, exponent_above(0.12f));
    TEST_ASSERT_EQUAL_INT32(LEAST_EXPONENT, exponent_above(0.0f));
    TEST_ASSERT_EQUAL_INT32(LEAST_EXPONENT, exponent_above(1e-31f));
    TEST_ASSERT_EQUAL_INT32(REFUSED_EXPONENT, exponent_above(-INFINITY));
    TEST_ASSERT_EQUAL_INT32(REFUSED_EXPONENT, exponent_above(NAN));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_number_becomes_the_nearest_word);
    RUN_TEST(test_the_power_of_two_above_a_number);
    return UNITY_END();
}
