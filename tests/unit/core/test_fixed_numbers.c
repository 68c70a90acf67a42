/* Tests of the arithmetic of the integer paths under a load: products, quotients and conversions to float against
 * double precision, and every bound that fixed_vec.h and number.h name, at the bound and just within it. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the header */
#include "fixed_space/invert.h"
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
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, minus(INT32_MIN));
    TEST_ASSERT_EQUAL_INT32(-2, twice(INT32_MAX));
    for (int i = 0; i < 1000; i++) {
        const int32_t a = any_number() >> 1, b = any_number() >> 1;
        TEST_ASSERT_EQUAL_INT32(a + b, plus(a, b));
        TEST_ASSERT_EQUAL_INT32(a - b, less(a, b));
        TEST_ASSERT_EQUAL_INT32(-a, minus(a));
        TEST_ASSERT_EQUAL_INT32(2 * a, twice(a));
    }
}

/* --- quotients ------------------------------------------------------------------------------------------------ */

static void test_one_over_a_number(void)
{
    for (int i = 0; i < 20000; i++) {
        const uint32_t leading = any_word() | 0x80000000u;
        const double right = 2305843009213693952.0 / (double)leading; /* 2^61 */
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * right + 1.0, right, (double)over_q61(leading));
    }
    TEST_ASSERT_DOUBLE_WITHIN(2.0, 0x1p30, (double)over_q61(0x80000000u));
    TEST_ASSERT_DOUBLE_WITHIN(2.0, 0x1p29, (double)over_q61(0xffffffffu));
}

static void test_leading_bits(void)
{
    for (uint32_t bit = 0; bit < 64u; bit++) {
        for (int i = 0; i < 20; i++) {
            const uint64_t below = ((uint64_t)any_word() << 32 | any_word()) & (((uint64_t)1 << bit) - 1u);
            const uint64_t number = (uint64_t)1 << bit | below;
            TEST_ASSERT_EQUAL_UINT32(63u - bit, zeros_of(number));
            const uint32_t wanted = (uint32_t)(bit >= 31u ? number >> (bit - 31u) : number << (31u - bit));
            TEST_ASSERT_EQUAL_HEX32(wanted, leading_of(number, zeros_of(number)));
        }
    }
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

/* --- what is noted -------------------------------------------------------------------------------------------- */

static void test_a_word_is_noted_from_its_bits_on(void)
{
    for (int bits = NOTED_BITS; bits <= 30; bits++) {
        const int32_t most = (int32_t)((1u << bits) - 1u);
        noted_t noted = 0u;
        note(&noted, most, bits);
        note(&noted, -most, bits);
        note(&noted, 0, bits);
        TEST_ASSERT_FALSE(is_refused(noted));
        note(&noted, most + 1, bits);
        TEST_ASSERT_TRUE(is_refused(noted));
        noted = 0u;
        note(&noted, -most - 2, bits);
        TEST_ASSERT_TRUE(is_refused(noted));
        note(&noted, 0, bits);
        TEST_ASSERT_TRUE(is_refused(noted)); /* later values do not take the refusal back */
    }
}

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

/* A product of two words as a value: 1 at their formats' ones. */
typedef int32_t product_t(int32_t a, int32_t b, noted_t *noted);

static int32_t angle(int32_t a, int32_t b, noted_t *noted)
{
    return angle_of(a, b, noted);
}

static int32_t overload_ratio(int32_t a, int32_t b, noted_t *noted)
{
    return yielded_to(a, b, OVERLOAD_RANGES, noted);
}

static int32_t softened(int32_t a, int32_t b, noted_t *noted)
{
    return softened_of(a, b, noted);
}

static int32_t yielded_move(int32_t a, int32_t b, noted_t *noted)
{
    return yielded(a, b, noted);
}

static void test_products_are_noted_from_their_most_on(void)
{
    static const struct {
        product_t *of;
        int a_format, b_format, format;
        double most;
        bool is_signed;
    } row[] = {{angle, 26, 24, 29, 2.0, true},
               {overload_ratio, 14, 24, 25, 32.0, true},
               {softened, 26, 27, 26, 16.0, false},
               {yielded_move, 26, 26, 28, 4.0, true}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        for (int n = 0; n < 4000; n++) {
            const double share = 0.02 + 0.0005 * n; /* of the most */
            const int32_t a = (int32_t)(ldexp(1.0, 20) + (double)(any_word() >> 4));
            const double b_whole = share * row[i].most * ldexp(1.0, row[i].a_format + row[i].b_format) / (double)a;
            if (b_whole > 2147483000.0) {
                continue;
            }
            const int32_t b = (int32_t)(row[i].is_signed && n % 2 != 0 ? -b_whole : b_whole);
            noted_t noted = 0u;
            const int32_t is = row[i].of(a, b, &noted);
            const double value = ldexp((double)a * (double)b, -row[i].a_format - row[i].b_format);
            if (fabs(fabs(value) / row[i].most - 1.0) > 1e-5) {
                TEST_ASSERT_EQUAL(fabs(value) > row[i].most, is_refused(noted));
            }
            if (fabs(value) < row[i].most && fabs(ldexp(value, row[i].format)) < 2147483648.0) {
                expect_whole(floor(ldexp(value, row[i].format)), is);
            }
        }
    }
}

/* 1 plus a product: from a sixteenth, with a margin, to 9. */
static void test_pivots_are_noted_outside_their_range(void)
{
    for (int n = 0; n < 4000; n++) {
        const double wanted = -0.2 + 0.0025 * n;
        const int32_t yields = (int32_t)(ldexp(1.0, 22) + (double)(any_word() >> 8));
        const int32_t entry = (int32_t)((wanted - 1.0) * ldexp(1.0, 50) / (double)yields);
        noted_t noted = 0u;
        const int32_t is = pivot_of(yields, entry, &noted);
        const double value = 1.0 + ldexp((double)yields * (double)entry, -50), least = 1.0 / 16.0;
        if (fabs(value - least) > 1e-4 && fabs(value - 9.0) > 1e-4) {
            TEST_ASSERT_EQUAL(value < least || value > 9.0, is_refused(noted));
            TEST_ASSERT_DOUBLE_WITHIN(0x1p-26, value < least ? least + 0x1p-17 : value, ldexp((double)is, -27));
        }
    }
}

/* --- the inverse in space ------------------------------------------------------------------------------------- */

/* C of known eigenvalues and axes; K has their inverses. Refused where the least is so small that rounding is all that
 * is left of it, or is not positive. */
static void test_the_inverse_in_space(void)
{
    static const double lambdas[][3] = {{1.0, 0.5, 0.25}, {1.0, 1e-2, 1e-3}, {0.7, 0.69, 2e-5}, {1.0, 3e-6, 2e-6},
                                        {1.0, 0.5, 1e-9}, {1.0, 1e-9, 1e-9}, {1.0, 0.5, -0.1}, {1.0, -0.2, -0.3}};
    for (int i = 0; i < 160; i++) {
        const double *lambda = lambdas[i % 8];
        const int size = 56 - i / 8 % 20; /* the format of C's entries is 54; the size varies */
        const double a = 0.37 * i, b = 1.1 * sin(2.3 * i);
        const double axis[3][3] = {{-sin(a), cos(a), 0.0},
                                   {-sin(b) * cos(a), -sin(b) * sin(a), cos(b)},
                                   {cos(b) * cos(a), cos(b) * sin(a), sin(b)}};
        double c[3][3] = {{0.0}}, k[3][3] = {{0.0}};
        for (int p = 0; p < 9; p++) {
            for (int q = 0; q < 3; q++) {
                c[p / 3][p % 3] += lambda[q] * axis[q][p / 3] * axis[q][p % 3];
                k[p / 3][p % 3] += 1.0 / lambda[q] * axis[q][p / 3] * axis[q][p % 3];
            }
        }
        const fixed_tensor3_t words = {(int64_t)ldexp(c[0][0], size), (int64_t)ldexp(c[0][1], size),
                                       (int64_t)ldexp(c[0][2], size), (int64_t)ldexp(c[1][1], size),
                                       (int64_t)ldexp(c[1][2], size), (int64_t)ldexp(c[2][2], size)};
        brace_k3_t is;
        const bool is_told = fixed_inverse3(&words, 3, &is);
        TEST_ASSERT_EQUAL(i % 8 < 4, is_told);
        if (is_told) {
            const double unit = ldexp(8.0, 54 - size), most = unit / lambda[2];
            const double within = most * 4e-9 * lambda[0] / lambda[2] + most * 1e-6;
            TEST_ASSERT_DOUBLE_WITHIN(within, unit * k[0][0], (double)is.xx_n_per_mm);
            TEST_ASSERT_DOUBLE_WITHIN(within, unit * k[0][1], (double)is.xy_n_per_mm);
            TEST_ASSERT_DOUBLE_WITHIN(within, unit * k[0][2], (double)is.xz_n_per_mm);
            TEST_ASSERT_DOUBLE_WITHIN(within, unit * k[1][1], (double)is.yy_n_per_mm);
            TEST_ASSERT_DOUBLE_WITHIN(within, unit * k[1][2], (double)is.yz_n_per_mm);
            TEST_ASSERT_DOUBLE_WITHIN(within, unit * k[2][2], (double)is.zz_n_per_mm);
        }
    }
}

/* A minor of C that is negative by the last place of its words alone: C is not positive definite. The cofactors across
 * it are far larger than the sum of the others, which gives all of them their common shift. */
static void test_a_minor_that_is_negative_by_a_last_place_is_refused(void)
{
    for (int axis = 0; axis < 3; axis++) {
        const int p = axis == 0 ? 1 : 0, q = axis == 2 ? 1 : 2;
        for (int64_t n = 16384; n < 23000; n += 7) {
            int64_t m[3][3] = {{0}};
            m[p][p] = n * n, m[q][q] = n * n + 2, m[p][q] = m[q][p] = n * n + 1; /* their minor is -1 */
            m[axis][axis] = 1, m[axis][p] = m[p][axis] = n, m[axis][q] = m[q][axis] = n - 1;
            const int64_t unit = (int64_t)1 << 23;
            const fixed_tensor3_t c = {.xx = unit * m[0][0], .xy = unit * m[0][1], .xz = unit * m[0][2],
                                       .yy = unit * m[1][1], .yz = unit * m[1][2], .zz = unit * m[2][2]};
            brace_k3_t k;
            TEST_ASSERT_FALSE(fixed_inverse3(&c, 0, &k));
        }
    }
}

/* An entry across, or a cofactor, beyond what a definite matrix may have is refused: what is left of it in a word would
 * be that of another matrix, which has a K. The first C is that matrix and 2^33 across, which the words drop; in the
 * second one, no minor is negative, and their sum of nothing shifts the cofactors across out of their words. */
static void test_entries_that_words_would_drop_are_refused(void)
{
    const int64_t unit = (int64_t)1 << 30, far = (int64_t)1 << 33;
    for (int i = 0; i < 3; i++) {
        fixed_tensor3_t c = {.xx = unit, .yy = unit, .zz = unit};
        brace_k3_t k;
        TEST_ASSERT_TRUE(fixed_inverse3(&c, 0, &k));
        *(i == 0 ? &c.xy : i == 1 ? &c.xz : &c.yz) = far;
        TEST_ASSERT_FALSE(fixed_inverse3(&c, 0, &k));
    }
    const fixed_tensor3_t no_minor = {.xx = unit, .xy = unit, .xz = unit, .yy = unit, .yz = -unit, .zz = unit};
    brace_k3_t k;
    TEST_ASSERT_FALSE(fixed_inverse3(&no_minor, 0, &k));
}

/* C so small that its words would be noise is refused, sound as it may be. */
static void test_a_C_below_its_least_trace_is_refused(void)
{
    for (int axis = 0; axis < 3; axis++) {
        const int64_t whole = (int64_t)1 << 20, third = whole / 3, rest = whole - 2 * third;
        for (int less = 0; less < 2; less++) {
            const int64_t odd = rest - less;
            const fixed_tensor3_t c = {.xx = axis == 0 ? odd : third, .yy = axis == 1 ? odd : third,
                                       .zz = axis == 2 ? odd : third};
            brace_k3_t k;
            TEST_ASSERT_EQUAL(less == 0, fixed_inverse3(&c, 0, &k));
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
    RUN_TEST(test_one_over_a_number);
    RUN_TEST(test_leading_bits);
    RUN_TEST(test_floats_from_and_to_words);
    RUN_TEST(test_the_exponent_above_a_number);
    RUN_TEST(test_a_word_is_noted_from_its_bits_on);
    RUN_TEST(test_a_sum_is_lost_from_its_room_on);
    RUN_TEST(test_products_are_noted_from_their_most_on);
    RUN_TEST(test_pivots_are_noted_outside_their_range);
    RUN_TEST(test_an_angle_in_turns);
    RUN_TEST(test_the_inverse_in_space);
    RUN_TEST(test_a_minor_that_is_negative_by_a_last_place_is_refused);
    RUN_TEST(test_entries_that_words_would_drop_are_refused);
    RUN_TEST(test_a_C_below_its_least_trace_is_refused);
    return UNITY_END();
}
