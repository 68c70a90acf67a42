/* K in space from C in integers, beside the inverse in double precision: of any C that is positive definite, whatever
 * its size and its axes. A C that yields in no direction, or in a direction less than not at all, is refused, whichever
 * entry says so, and leaves K as it was. */
#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the header */
#include "fixed_space/invert.h"
#include "fixed_words.h"
#include "unity.h"

static const int row_of[6] = {0, 0, 0, 1, 1, 2}, column_of[6] = {0, 1, 2, 1, 2, 2};

void setUp(void)
{
    state = 11u;
}

void tearDown(void) {}

/* Three axes by chance, at right angles to one another. */
static void any_axes(double axis[3][3])
{
    for (int i = 0; i < 3; i++) {
        double length = 0.0;
        while (length < 0.3) {
            for (int e = 0; e < 3; e++) {
                axis[i][e] = any(-1.0, 1.0);
            }
            for (int other = 0; other < i; other++) {
                const double along =
                    axis[i][0] * axis[other][0] + axis[i][1] * axis[other][1] + axis[i][2] * axis[other][2];
                for (int e = 0; e < 3; e++) {
                    axis[i][e] -= along * axis[other][e];
                }
            }
            length = sqrt(axis[i][0] * axis[i][0] + axis[i][1] * axis[i][1] + axis[i][2] * axis[i][2]);
        }
        for (int e = 0; e < 3; e++) {
            axis[i][e] /= length;
        }
    }
}

/* sum of each value times its axis and that again */
static void matrix_of(const double value[3], double axis[3][3], double entry[6])
{
    for (int e = 0; e < 6; e++) {
        entry[e] = 0.0;
        for (int i = 0; i < 3; i++) {
            entry[e] += value[i] * axis[i][row_of[e]] * axis[i][column_of[e]];
        }
    }
}

static fixed_tensor3_t tensor_of(const double entry[6])
{
    int64_t words[6];
    for (int e = 0; e < 6; e++) {
        words[e] = (int64_t)floor(ldexp(entry[e], 54) + 0.5);
    }
    return (fixed_tensor3_t){words[0], words[1], words[2], words[3], words[4], words[5]};
}

static bool inverse_of(const double entry[6], int exponent, double k_entry[6])
{
    brace_k3_t k;
    memset(&k, 0x5a, sizeof k);
    const brace_k3_t untouched = k;
    const fixed_tensor3_t c = tensor_of(entry);
    const bool is_told = fixed_inverse3(&c, exponent, &k);
    TEST_ASSERT_EQUAL(!is_told, memcmp(&k, &untouched, sizeof k) == 0);
    const float entries[6] = {k.xx_n_per_mm, k.xy_n_per_mm, k.xz_n_per_mm,
                              k.yy_n_per_mm, k.yz_n_per_mm, k.zz_n_per_mm};
    for (int e = 0; e < 6; e++) {
        k_entry[e] = ldexp((double)entries[e], -exponent);
    }
    return is_told;
}

/* Words of 31 bits hold C, its cofactors and its determinant: their rounding counts in K as many times as C is slender,
 * and words of q54 are coarse for a small C. */
static void test_K_is_the_inverse_of_C(void)
{
    int told = 0;
    for (int n = 0; n < 400 * TIMES; n++) {
        const double size = pow(2.0, any(-20.0, 7.0)), slender = pow(10.0, any(-4.0, 0.0));
        const double c[3] = {size, size * pow(slender, any(0.0, 1.0)), size * slender};
        double axis[3][3], entry[6], wanted[6], is[6];
        any_axes(axis);
        matrix_of(c, axis, entry);
        matrix_of((const double[3]){1.0 / c[0], 1.0 / c[1], 1.0 / c[2]}, axis, wanted);
        TEST_ASSERT_TRUE(inverse_of(entry, (int)any(-12.0, 12.0), is));
        told++;
        const double within = 1.2e-7 + 4e-9 / slender + 0x1p-53 / c[2];
        for (int e = 0; e < 6; e++) {
            TEST_ASSERT_DOUBLE_WITHIN(within, 0.0, (is[e] - wanted[e]) * c[2]);
        }
    }
    TEST_ASSERT_TRUE(told > 300 * TIMES);
}

/* Along the axes of the frame, by words of exact powers of two: the inverse is exact. What is no entry is exactly
 * nothing. */
static void test_powers_of_two_are_inverted_exactly(void)
{
    for (int n = 0; n < 30 * TIMES; n++) {
        const int power[3] = {(int)any(-9.0, 0.0), (int)any(-9.0, 0.0), (int)any(-9.0, 0.0)};
        const double entry[6] = {ldexp(1.0, power[0]), 0.0, 0.0, ldexp(1.0, power[1]), 0.0, ldexp(1.0, power[2])};
        double is[6];
        TEST_ASSERT_TRUE(inverse_of(entry, (int)any(-12.0, 12.0), is));
        for (int e = 0; e < 6; e++) {
            const double wanted = entry[e] > 0.0 ? 1.0 / entry[e] : 0.0;
            TEST_ASSERT_DOUBLE_WITHIN(1e-7 * wanted, wanted, is[e]);
        }
    }
}

/* One direction, two or all yield less than not at all. */
static void test_what_is_not_positive_is_refused(void)
{
    static const double signs[5][3] = {{1, 1, -1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}, {-1, -1, -1}};
    for (int n = 0; n < 300 * TIMES; n++) {
        const double size = pow(2.0, any(-16.0, 6.0));
        const double *sign = signs[n % 5];
        const double c[3] = {sign[0] * size, sign[1] * size * pow(10.0, any(-4.0, 0.0)),
                             sign[2] * size * pow(10.0, any(-4.0, 0.0))};
        double axis[3][3], entry[6], is[6];
        any_axes(axis);
        matrix_of(c, axis, entry);
        TEST_ASSERT_FALSE(inverse_of(entry, 0, is));
    }
}

/* Each entry alone: on the diagonal negative; beside it so large that two directions cannot both yield, up to where no
 * word holds it beside the trace; so small that nothing is left of C. */
static void test_each_entry_may_refuse(void)
{
    static const double even[6] = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};
    double entry[6], is[6];
    for (int e = 0; e < 6; e++) {
        const bool is_diagonal = row_of[e] == column_of[e];
        for (int sign = -1; sign <= 1; sign += 2) {
            for (double size = 0.9; size < 200.0; size *= 1.3) {
                memcpy(entry, even, sizeof entry);
                entry[e] = sign * size;
                const bool is_positive = is_diagonal ? sign > 0 : size < 1.0;
                TEST_ASSERT_EQUAL(is_positive, inverse_of(entry, 0, is));
            }
        }
        memcpy(entry, even, sizeof entry);
        entry[e] = is_diagonal ? 1e-9 : 0.0;
        TEST_ASSERT_EQUAL(!is_diagonal, inverse_of(entry, 0, is));
    }
    for (double size = 0x1p-30; size > 0x1p-40; size *= 0.5) { /* of the trace, 2^-34 is the least */
        for (int e = 0; e < 6; e++) {
            entry[e] = size * even[e];
        }
        TEST_ASSERT_EQUAL(3.0 * size >= 0x1p-34, inverse_of(entry, 0, is));
    }
}

/* The least of C over its largest: 2e-7 is what the determinant's word tells from nothing. */
static void test_a_C_too_slender_is_refused(void)
{
    int told = 0, refused = 0;
    for (int n = 0; n < 200 * TIMES; n++) {
        const double slender = pow(10.0, any(-8.5, -5.5)), c[3] = {1.0, any(0.5, 1.0), slender};
        double axis[3][3], entry[6], is[6];
        any_axes(axis);
        matrix_of(c, axis, entry);
        const bool is_told = inverse_of(entry, 0, is);
        told += is_told ? 1 : 0;
        refused += is_told ? 0 : 1;
        if (slender > 1.5e-6) {
            TEST_ASSERT_TRUE(is_told);
        }
        if (slender < 2e-8) {
            TEST_ASSERT_FALSE(is_told);
        }
    }
    TEST_ASSERT_TRUE(told > 30 * TIMES && refused > 30 * TIMES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_K_is_the_inverse_of_C);
    RUN_TEST(test_powers_of_two_are_inverted_exactly);
    RUN_TEST(test_what_is_not_positive_is_refused);
    RUN_TEST(test_each_entry_may_refuse);
    RUN_TEST(test_a_C_too_slender_is_refused);
    return UNITY_END();
}
