/* Tests of the arithmetic of the integer path under a load: products, quotients and conversions to float against double
 * precision, and the bound from which on a sum is lost. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the header */
#include "loaded/fixed_vec.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static uint32_t state = 99u;

static uint32_t any_word(void)
{
    state = state * 1664525u + 1013904223u;
    const uint32_t high = state >> 16;
    state = state * 1664525u + 1013904223u;
    return high << 16 | state >> 16;
}

/* Of any size, either sign. */
static int32_t any_number(void)
{
    const uint32_t shift = any_word() % 31u;
    return (int32_t)any_word() >> shift;
}

static void expect_whole(double wanted, int32_t is)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.0, wanted, (double)is);
}

/* --- sums and products ---------------------------------------------------------------------------------------- */

/* Shifted sums are rounded down; coarse sums drop the low word. Doubles are exact up to 2^53. */
static void test_sums_of_products(void)
{
    for (int i = 0; i < 2000; i++) {
        const int32_t a = any_number() >> 5, b = any_number() >> 5, c = any_number() >> 5, d = any_number() >> 5;
        const int32_t e = any_number() >> 5, f = any_number() >> 5;
        const double two = (double)a * (double)b + (double)c * (double)d, three = two + (double)e * (double)f;
        TEST_ASSERT_TRUE((double)sum2(a, b, c, d) == two && (double)sum3(a, b, c, d, e, f) == three);
        for (int bits = 25; bits <= 34; bits++) {
            expect_whole(floor(ldexp(two, -bits)), shifted(sum2(a, b, c, d), bits));
            if (bits <= 32) {
                expect_whole(ldexp(floor(ldexp(two, -32)), 32 - bits), coarse(sum2(a, b, c, d), bits));
                expect_whole(ldexp(floor(ldexp((double)a * (double)b, -32)), 32 - bits), coarse_times(a, b, bits));
            }
            expect_whole(floor(ldexp((double)a * (double)b, -bits)), times(a, b, bits));
        }
        const int64_t wide = (int64_t)any_number() * any_number();
        TEST_ASSERT_EQUAL_INT64(wide >> 32, brace_high_word(wide));
    }
}

/* A value that does not fit into a word wraps, in both directions. */
static void test_sums_that_wrap(void)
{
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, wrapped_plus(INT32_MAX, 1));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, wrapped_less(INT32_MIN, 1));
    for (int i = 0; i < 1000; i++) {
        const int32_t a = any_number() >> 1, b = any_number() >> 1;
        TEST_ASSERT_EQUAL_INT32(a + b, wrapped_plus(a, b));
        TEST_ASSERT_EQUAL_INT32(a - b, wrapped_less(a, b));
    }
}

/* --- quotients ------------------------------------------------------------------------------------------------ */

/* 16 bits by division and a step of Newton's method: 2^-29 of it, and four of its last places (tests/judges/proofs
 * proves that of every pivot). */
static void test_one_over_a_pivot(void)
{
    for (int i = 0; i < 20000; i++) {
        const int32_t pivot_q27 = LEAST_PIVOT_Q27 + (int32_t)(any_word() % (uint32_t)(INT32_MAX - LEAST_PIVOT_Q27));
        const double right = 0x1p54 / (double)pivot_q27;
        TEST_ASSERT_DOUBLE_WITHIN(0x1p-29 * right + 4.0, right, (double)inverse_q27(pivot_q27));
    }
    TEST_ASSERT_DOUBLE_WITHIN(4.0, 0x1p27, (double)inverse_q27(ONE_Q27));
}

/* --- floats --------------------------------------------------------------------------------------------------- */

static void test_floats_from_and_to_words(void)
{
    for (int i = 0; i < 20000; i++) {
        const int32_t number = any_number(), format = (int32_t)(any_word() % 80u) - 40;
        const double right = ldexp((double)number, -format);
        /* the result is truncated; a negative word may be off by its last place */
        const double last = fabs(right) * 0x1p-23 + ldexp(1.0, -format);
        TEST_ASSERT_DOUBLE_WITHIN(last, right, (double)float_from(number, format));
    }
    TEST_ASSERT_EQUAL_HEX32(0u, bits_of(float_from(0, 20)));
    for (int32_t format = -20; format <= 60; format++) {
        for (int i = 0; i < 200; i++) {
            const float number = (float)ldexp((double)any_number(), -(int)(any_word() % 90u));
            const double scaled = ldexp((double)number, format);
            if (fabs(scaled) < 2147483648.0 && fabsf(number) > 1e-30f) {
                expect_whole(trunc(scaled), fixed_of(bits_of(number), format));
            }
        }
    }
}

static void test_the_exponent_above_a_number(void)
{
    for (int exponent = -90; exponent <= 90; exponent++) {
        const float power = ldexpf(1.0f, exponent), below = nextafterf(power, 0.0f);
        TEST_ASSERT_EQUAL_INT32(exponent + 1, exponent_above(bits_of(power)));
        TEST_ASSERT_EQUAL_INT32(exponent, exponent_above(bits_of(below)));
    }
}

/* --- what is lost --------------------------------------------------------------------------------------------- */

static void test_a_sum_is_lost_from_its_room_on(void)
{
    for (int room = 0; room <= 3; room++) {
        const int64_t most = (int64_t)1 << (56 + room);
        for (int sign = -1; sign <= 1; sign += 2) {
            lost_t lost = 0u;
            TEST_ASSERT_EQUAL_INT32(shifted(sign * (most - ((int64_t)1 << 33)), 29),
                                    kept(sign * (most - ((int64_t)1 << 33)), 29, room, &lost));
            TEST_ASSERT_TRUE(lost < LOST);
            (void)kept(sign * (most + ((int64_t)1 << 33)), 29, room, &lost);
            TEST_ASSERT_TRUE(lost >= LOST);
            (void)kept(0, 29, room, &lost);
            TEST_ASSERT_TRUE(lost >= LOST);
        }
    }
}

/* An angle in turns of 2^32, rounded down. The factor is right to a quarter of its last place, which the largest angle
 * makes an eighth of a unit. */
static void test_an_angle_in_turns(void)
{
    const double per_q28 = 16.0 / 6.283185307179586;
    for (int64_t angle = INT32_MIN; angle <= INT32_MAX; angle += 1000003) {
        const double off = (double)brace_turn_from_q28((int32_t)angle) - (double)angle * per_q28;
        const double within_turn = off - 0x1p32 * floor(off / 0x1p32 + 0.5);
        TEST_ASSERT_TRUE(within_turn > -1.125 && within_turn < 0.125);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sums_of_products);
    RUN_TEST(test_sums_that_wrap);
    RUN_TEST(test_one_over_a_pivot);
    RUN_TEST(test_floats_from_and_to_words);
    RUN_TEST(test_the_exponent_above_a_number);
    RUN_TEST(test_a_sum_is_lost_from_its_room_on);
    RUN_TEST(test_an_angle_in_turns);
    return UNITY_END();
}
