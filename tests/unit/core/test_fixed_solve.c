/* The integer path's elimination in the plane, beside the same elimination in double precision: the same numbers, and
 * a refusal where one of them leaves its word, by the bounds that fixed_vec.h names. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the header */
#include "loaded/fixed_solve.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* An emulated board has to show that its arithmetic agrees; a host plays ten times as many. */
#ifdef __arm__
enum { TIMES = 1 };
#else
enum { TIMES = 10 };
#endif

static uint32_t state = 7u;

static double any(double least, double most)
{
    state = state * 1664525u + 1013904223u;
    return least + (most - least) * ((double)(state >> 8) / 16777216.0);
}

static int32_t word(double number, int format)
{
    return (int32_t)floor(ldexp(number, format));
}

static double number(int32_t word_, int format)
{
    return ldexp((double)word_, -format);
}

/* A link's matrix under a load, I + bend [aa ab; ab bb], and its root's row, eliminated in double precision. worst: how
 * far the largest number is beyond its bound, as a share of it. */
typedef struct {
    double pivot_a, pivot_b, yields_a, yields_b, b_by_a, root_by_a, root_by_b, resists, worst;
} eliminated_t;

static double worse(double worst, double is, double most)
{
    return fmax(worst, fabs(is) / most - 1.0);
}

static eliminated_t eliminated(const double m[6], double bend)
{
    eliminated_t e = {.pivot_a = 1.0 + bend * m[3], .worst = -1.0};
    e.worst = worse(e.worst, bend * m[3], 4.0);
    e.worst = fmax(e.worst, 1.0 - 16.0 * e.pivot_a);
    e.yields_a = bend / e.pivot_a;
    e.b_by_a = m[4] * e.yields_a, e.root_by_a = m[1] * e.yields_a;
    const double bb = m[5] - m[4] * e.b_by_a, rb = m[2] - m[4] * e.root_by_a;
    e.worst = worse(worse(worse(e.worst, e.yields_a, 4.0), e.b_by_a, 4.0), e.root_by_a, 4.0);
    e.worst = worse(worse(e.worst, m[4] * e.b_by_a, 4.0), m[4] * e.root_by_a, 4.0);
    e.pivot_b = 1.0 + bend * bb;
    e.worst = fmax(worse(e.worst, bend * bb, 4.0), 1.0 - 16.0 * e.pivot_b);
    e.yields_b = bend / e.pivot_b;
    e.root_by_b = rb * e.yields_b;
    const double less = rb * e.root_by_b + m[1] * e.root_by_a;
    e.worst = worse(worse(worse(e.worst, e.yields_b, 4.0), e.root_by_b, 4.0), less, 4.0);
    e.resists = m[0] - less;
    return e;
}

/* Matrices of every size and softness, so that each number is by itself the first to leave its word. */
static void test_a_link_s_matrix_is_eliminated_within_its_words(void)
{
    int told = 0, refused = 0;
    for (int n = 0; n < 800 * TIMES; n++) {
        const double bend = pow(10.0, any(-2.5, 0.59));
        int32_t words[6];
        double m[6];
        for (int i = 0; i < 6; i++) {
            words[i] = word(any(-8.0, 8.0) * pow(10.0, any(-2.0, 0.0)), 27);
            m[i] = number(words[i], 27);
        }
        const fixed_matrix_t matrix = {words[0], words[1], words[2], words[3], words[4], words[5]};
        const eliminated_t e = eliminated(m, number(word(bend, 29), 29));
        fixed_factors_t f;
        const bool is_told = fixed_factors_of(&matrix, word(bend, 29), &f);
        if (fabs(e.worst) > 1e-4) {
            TEST_ASSERT_EQUAL(e.worst < 0.0, is_told);
        }
        if (e.worst >= 0.0 || !is_told) {
            refused++;
            continue;
        }
        told++;
        const double within = 1e-5 / (e.pivot_a * e.pivot_a * e.pivot_b); /* of q27, over the small pivots */
        TEST_ASSERT_DOUBLE_WITHIN(within, e.pivot_a, number(f.pivot_a, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.pivot_b, number(f.pivot_b, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.yields_a, number(f.yields_a, 29));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.yields_b, number(f.yields_b, 29));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.b_by_a, number(f.b_by_a, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.root_by_a, number(f.root_by_a, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.root_by_b, number(f.root_by_b, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, e.resists, number(f.resists, 27));
    }
    TEST_ASSERT_TRUE(told > 200 * TIMES && refused > 80 * TIMES);
}

/* On the way to the equilibrium: what drives a link's root when its curvatures are eliminated, with what is beyond the
 * link; and how far they turn then. What the matrix refuses, and what drives it out of its words, is refused. */
static void test_a_link_is_solved_within_its_words(void)
{
    int told = 0, refused = 0;
    for (int n = 0; n < 400 * TIMES; n++) {
        double m[6], drives[3];
        int32_t w[6], d[3];
        for (int i = 0; i < 6; i++) {
            w[i] = word(any(-2.0, 2.0) * pow(10.0, any(-2.0, 0.0)), 27);
        }
        for (int i = 0; i < 3; i++) {
            d[i] = word(any(-2.0, 2.0) * (n % 3 == 0 ? 1.9 : 1.0), 27);
        }
        const double bend = pow(10.0, any(-2.0, 0.4)), beyond = any(-0.3, 0.3), end = any(-0.2, 0.2);
        const double beyond_drives = any(-0.3, 0.3), end_drives = any(-0.2, 0.2), root = any(-1.0, 1.0);
        const fixed_pull_t pull = {.resists = {w[0], w[1], w[2], w[3], w[4], w[5]}, .drives = {d[0], d[1], d[2]},
                                   .end_resists = word(end, 27), .end_drives = word(end_drives, 27)};
        for (int i = 0; i < 6; i++) { /* what acts at the link's end acts on each of its turns */
            m[i] = number(w[i], 27) + end + beyond;
        }
        for (int i = 0; i < 3; i++) {
            drives[i] = number(d[i], 27) + end_drives + beyond_drives;
        }
        fixed_solved_t s = {.driven = 0}; /* as if all were sound, should nothing be written */
        const bool is_told = fixed_solve_in(&pull, word(bend, 29), word(beyond, 27), word(beyond_drives, 27), &s);
        const eliminated_t e = eliminated(m, number(word(bend, 29), 29));
        const double from_a = e.b_by_a * drives[1], on_b = drives[2] - from_a;
        const double less = e.root_by_a * drives[1] + e.root_by_b * on_b;
        const double worst = worse(worse(e.worst, from_a, 4.0), less, 4.0);
        if (fabs(worst) > 1e-3) {
            TEST_ASSERT_EQUAL(worst < 0.0, is_told);
        }
        if (worst >= 0.0 || !is_told) {
            refused++;
            continue;
        }
        told++;
        const double within = 1e-5 / (e.pivot_a * e.pivot_a * e.pivot_b);
        TEST_ASSERT_DOUBLE_WITHIN(within, drives[1], number(s.a_driven, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, on_b, number(s.b_driven, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, drives[0] - less, number(s.driven, 27));
        fixed_shape_t shape;
        lost_t lost = 0u;
        fixed_solve_out(&s, word(root, 29), &shape, &lost);
        const double b = e.yields_b * on_b - e.root_by_b * root;
        const double a = e.yields_a * drives[1] - e.root_by_a * root - e.b_by_a * b;
        if (fabs(fabs(b) - 2.0) > 1e-3 && fabs(fabs(a) - 2.0) > 1e-3) {
            TEST_ASSERT_EQUAL(fabs(b) > 2.0 || fabs(a) > 2.0, lost >= LOST);
        }
        if (fabs(b) < 1.99 && fabs(a) < 1.99) {
            TEST_ASSERT_EQUAL_INT32(word(root, 29), shape.root);
            TEST_ASSERT_DOUBLE_WITHIN(4.0 * within, b, number(shape.b, 29));
            TEST_ASSERT_DOUBLE_WITHIN(4.0 * within, a, number(shape.a, 29));
        }
    }
    TEST_ASSERT_TRUE(told > 200 * TIMES && refused > 20 * TIMES);
}

/* A joint's pivot, from a sixteenth to 5. */
static void test_a_joint_s_pivot_stays_within_its_word(void)
{
    for (int n = 0; n < 300 * TIMES; n++) {
        const double yields = any(0.01, 3.9), pivot_wanted = -0.5 + 7.5 / (300 * TIMES) * n, resists = (pivot_wanted - 1.0) / yields;
        if (fabs(resists) > 15.9) {
            continue;
        }
        int32_t pivot;
        const bool is_told = fixed_joint_of(word(yields, 29), word(resists, 27), &pivot);
        if (fabs(pivot_wanted - 0.0625) > 1e-5 && fabs(pivot_wanted - 5.0) > 1e-5) {
            TEST_ASSERT_EQUAL(pivot_wanted > 0.0625 && pivot_wanted < 5.0, is_told);
        }
        if (is_told) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, pivot_wanted, number(pivot, 27));
        }
    }
}

/* A product of numbers of any size. */
static void test_a_wide_product(void)
{
    fixed_wide_t is = {1 << 30, 1};
    double wanted = 1.0, within = 0.0;
    for (int n = 0; n < 40; n++) {
        const int32_t by = word(pow(10.0, any(-1.2, 1.2)), 27);
        is = wide_times(is, by);
        wanted *= number(by, 27);
        within += 0x1p-26 / number(by, 27); /* a mantissa of 30 bits times a word of q27 is rounded down */
        TEST_ASSERT_TRUE(is.mantissa_q31 >= 1 << 30);
        TEST_ASSERT_DOUBLE_WITHIN(within, 1.0, ldexp((double)is.mantissa_q31, is.exponent - 31) / wanted);
    }
    const fixed_pivots_t p = {.tibia = {.pivot_a = word(0.1, 27), .pivot_b = word(2.0, 27)}, .knee = word(0.3, 27),
                              .femur = {.pivot_a = word(0.7, 27), .pivot_b = word(5.0, 27)}, .hip = word(1.1, 27)};
    is = fixed_product(&p);
    wanted = 0.1 * 2.0 * 0.3 * 0.7 * 5.0 * 1.1;
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, ldexp((double)is.mantissa_q31, is.exponent - 31) / wanted);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_link_s_matrix_is_eliminated_within_its_words);
    RUN_TEST(test_a_link_is_solved_within_its_words);
    RUN_TEST(test_a_joint_s_pivot_stays_within_its_word);
    RUN_TEST(test_a_wide_product);
    return UNITY_END();
}
