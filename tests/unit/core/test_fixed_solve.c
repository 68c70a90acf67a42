/* The integer path's elimination in the plane, beside the same elimination in double precision: the same numbers, and
 * a refusal where one of them leaves its word, by the bounds that fixed_vec.h names. */
#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the header */
#include "loaded/fixed_buckling.h"
#include "fixed_words.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* A link's matrix under a load, I + bend [aa ab; ab bb], and its root's row, eliminated in double precision. worst: how
 * far the largest number is beyond its bound, as a share of it. */
typedef struct {
    double pivot_a, pivot_b, yields_a, yields_b, b_by_a, root_by_a, root_by_b, resists, worst;
} eliminated_t;

static double worse(double worst, double is, double most)
{
    return fmax(worst, fabs(is) / most - 1.0);
}

/* least: a smaller pivot counts as this one; 0: none does */
static eliminated_t eliminated(const double m[6], double bend, double least)
{
    eliminated_t e = {.pivot_a = 1.0 + bend * m[3], .worst = -1.0};
    e.worst = worse(e.worst, bend * m[3], 4.0);
    e.pivot_a = least > 0.0 ? fmax(e.pivot_a, least) : e.pivot_a;
    e.worst = fmax(e.worst, 1.0 - 16.0 * e.pivot_a);
    e.yields_a = bend / e.pivot_a;
    e.b_by_a = m[4] * e.yields_a, e.root_by_a = m[1] * e.yields_a;
    const double bb = m[5] - m[4] * e.b_by_a, rb = m[2] - m[4] * e.root_by_a;
    e.worst = worse(worse(worse(e.worst, e.yields_a, 4.0), e.b_by_a, 4.0), e.root_by_a, 4.0);
    e.worst = worse(worse(e.worst, m[4] * e.b_by_a, 4.0), m[4] * e.root_by_a, 4.0);
    e.pivot_b = 1.0 + bend * bb;
    e.pivot_b = least > 0.0 ? fmax(e.pivot_b, least) : e.pivot_b;
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
    int solved = 0, refused = 0;
    for (int n = 0; n < 800 * TIMES; n++) {
        const double bend = pow(10.0, any(-2.5, 0.59));
        int32_t words[6];
        double m[6];
        for (int i = 0; i < 6; i++) {
            words[i] = word(any(-8.0, 8.0) * pow(10.0, any(-2.0, 0.0)), 27);
            m[i] = number(words[i], 27);
        }
        const fixed_matrix_t matrix = {words[0], words[1], words[2], words[3], words[4], words[5]};
        const bool is_on_the_way = n % 2 == 0;
        const eliminated_t e = eliminated(m, number(word(bend, 29), 29), is_on_the_way ? 0.25 : 0.0);
        fixed_factors_t f;
        const bool is_solved = fixed_factors_of(&matrix, word(bend, 29), is_on_the_way, &f);
        if (fabs(e.worst) > 1e-4) {
            TEST_ASSERT_EQUAL(e.worst < 0.0, is_solved);
        }
        if (e.worst >= 0.0 || !is_solved) {
            refused++;
            continue;
        }
        solved++;
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
    TEST_ASSERT_TRUE(solved > 200 * TIMES && refused > 80 * TIMES);
}

/* On the way to the equilibrium: what drives a link's root when its curvatures are eliminated, with what is beyond the
 * link; and how far they turn then. What the matrix refuses, and what drives it out of its words, is refused. */
static void test_a_link_is_solved_within_its_words(void)
{
    int solved = 0, refused = 0;
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
        const fixed_pull_t pull = {.resists = {w[0], w[1], w[2], w[3], w[4], w[5]},
                                   .drives = {d[0], d[1], d[2]},
                                   .end_resists = word(end, 27),
                                   .end_drives = word(end_drives, 27)};
        for (int i = 0; i < 6; i++) { /* what acts at the link's end acts on each of its turns */
            m[i] = number(w[i], 27) + end + beyond;
        }
        for (int i = 0; i < 3; i++) {
            drives[i] = number(d[i], 27) + end_drives + beyond_drives;
        }
        fixed_solved_t s = {.driven = 0}; /* as if all were sound, should nothing be written */
        const bool is_solved = fixed_solve_in(&pull, word(bend, 29), word(beyond, 27), word(beyond_drives, 27), &s);
        const eliminated_t e = eliminated(m, number(word(bend, 29), 29), 0.25);
        const double from_a = e.b_by_a * drives[1], on_b = drives[2] - from_a;
        const double less = e.root_by_a * drives[1] + e.root_by_b * on_b;
        const double worst = worse(worse(e.worst, from_a, 4.0), less, 4.0);
        if (fabs(worst) > 1e-3) {
            TEST_ASSERT_EQUAL(worst < 0.0, is_solved);
        }
        if (worst >= 0.0 || !is_solved) {
            refused++;
            continue;
        }
        solved++;
        const double within = 1e-5 / (e.pivot_a * e.pivot_a * e.pivot_b);
        TEST_ASSERT_DOUBLE_WITHIN(within, drives[1], number(s.a_driven, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, on_b, number(s.b_driven, 27));
        TEST_ASSERT_DOUBLE_WITHIN(within, drives[0] - less, number(s.driven, 27));
        fixed_far_shape_t shape;
        lost_t lost = 0u;
        fixed_solve_out(&s, word(root, 27), &shape, &lost);
        const double b = e.yields_b * on_b - e.root_by_b * root;
        const double a = e.yields_a * drives[1] - e.root_by_a * root - e.b_by_a * b;
        if (fabs(fabs(b) - 8.0) > 1e-3 && fabs(fabs(a) - 8.0) > 1e-3) {
            TEST_ASSERT_EQUAL(fabs(b) > 8.0 || fabs(a) > 8.0, lost >= LOST);
        }
        if (fabs(b) < 7.99 && fabs(a) < 7.99) {
            TEST_ASSERT_EQUAL_INT32(word(root, 27), shape.root);
            TEST_ASSERT_DOUBLE_WITHIN(4.0 * within, b, number(shape.b, 27));
            TEST_ASSERT_DOUBLE_WITHIN(4.0 * within, a, number(shape.a, 27));
        }
    }
    TEST_ASSERT_TRUE(solved > 200 * TIMES && refused > 20 * TIMES);
}

/* A joint's pivot, from a sixteenth to 5. */
static void test_a_joint_s_pivot_stays_within_its_word(void)
{
    for (int n = 0; n < 300 * TIMES; n++) {
        const double yields = any(0.01, 3.9), pivot_wanted = -0.5 + 7.5 / (300 * TIMES) * n;
        const double resists = (pivot_wanted - 1.0) / yields;
        if (fabs(resists) > 15.9) {
            continue;
        }
        int32_t pivot;
        const bool is_solved = fixed_joint_of(word(yields, 29), word(resists, 27), false, &pivot);
        if (fabs(pivot_wanted - 0.0625) > 1e-5 && fabs(pivot_wanted - 5.0) > 1e-5) {
            TEST_ASSERT_EQUAL(pivot_wanted > 0.0625 && pivot_wanted < 5.0, is_solved);
        }
        if (is_solved) {
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
    const fixed_pivots_t p = {.tibia = {.pivot_a = word(0.1, 27), .pivot_b = word(2.0, 27)},
                              .knee = word(0.3, 27),
                              .femur = {.pivot_a = word(0.7, 27), .pivot_b = word(5.0, 27)},
                              .hip = word(1.1, 27)};
    is = fixed_product(&p);
    wanted = 0.1 * 2.0 * 0.3 * 0.7 * 5.0 * 1.1;
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, ldexp((double)is.mantissa_q31, is.exponent - 31) / wanted);
}

static fixed_vec_t any_vec(double most, int format)
{
    return (fixed_vec_t){word(any(-most, most), format), word(any(-most, most), format)};
}

static fixed_link_t any_link(void)
{
    const fixed_vec_t none = {0, 0}, beam = any_vec(0.6, 28), beyond = any_vec(1.0, 30);
    return (fixed_link_t){.to_beam = none,
                          .beam = beam,
                          .rigid = none,
                          .root_root = none,
                          .end_root = none,
                          .bend = word(pow(10.0, any(-2.0, 0.5)), 29),
                          .beyond = beyond,
                          .own = none,
                          .on_rigid = beyond};
}

/* A step from the straight limb: whatever it takes on, no link's end has turned by more than 1.2 rad, every angle along
 * a link is below 4 rad, and nothing it takes on has a matrix that cannot be eliminated within its words. */
static void test_a_step_bends_no_link_too_far(void)
{
    int taken = 0, shortened = 0;
    for (int n = 0; n < 2000 * TIMES; n++) {
        fixed_limb_t limb = {.femur = any_link(), .tibia = any_link()};
        const double hip = pow(10.0, any(-2.0, 0.5)), knee = pow(10.0, any(-2.0, 0.5));
        fixed_pull_t pull;
        fixed_pull_straight(&limb.tibia, &pull);
        const fixed_matrix_t *w = &pull.resists;
        const double m[6] = {number(w->rr, 27), number(w->ra, 27), number(w->rb, 27),
                             number(w->aa, 27), number(w->ab, 27), number(w->bb, 27)};
        const eliminated_t e = eliminated(m, number(limb.tibia.bend, 29), 0.25);
        int32_t turned_q27;
        const bool is_taken = fixed_bounded_step(&limb, true, word(hip, 29), word(knee, 29), &turned_q27);
        if (e.worst > 1e-3 || knee * e.resists > 4.001 || knee * e.resists < -4.001) {
            TEST_ASSERT_FALSE(is_taken);
        }
        if (is_taken) {
            taken++;
            shortened += number(turned_q27, 27) > 1.2;
            const fixed_shape_t *const shapes[] = {&limb.femur_shape, &limb.tibia_shape};
            for (int link = 0; link < 2; link++) {
                const double root = fabs(number(shapes[link]->root, 29)), a = fabs(number(shapes[link]->a, 29));
                const double b = fabs(number(shapes[link]->b, 29));
                TEST_ASSERT_TRUE(root <= 3.1 && a <= 1.2 && b <= 1.2 && root + 1.1 * a + b <= 4.0);
                TEST_ASSERT_TRUE(fabs(number(fixed_end_turn(shapes[link]), 29)) <= 1.2 + 1e-6);
            }
        }
    }
    TEST_ASSERT_TRUE(taken > 500 * TIMES && taken < 1990 * TIMES && shortened > 100 * TIMES);
}

/* --- the search for the buckling factor ----------------------------------------------------------------------- */

/* Bits up are 2^bits; bits down are rounded down, to nothing or -1 in the end. */
static void test_shifts_of_the_search(void)
{
    for (int up = -40; up <= 20; up++) {
        for (int n = 0; n < 20; n++) {
            const int32_t is = word(any(-1.0, 1.0), 10);
            TEST_ASSERT_DOUBLE_WITHIN(0.0, floor(ldexp((double)is, up)), (double)shifted_up(is, up));
        }
    }
    for (int n = 0; n < 30 * TIMES; n++) {
        const int32_t a = word(any(-1.0, 1.0) * pow(10.0, any(-9.0, 0.0)), 30), b = word(any(-1.0, 1.0) * 1e-3, 30);
        const int32_t room = room_above(a, b);
        const double most = fmax(fabs((double)a + 0.5), fabs((double)b + 0.5)); /* -1 has the magnitude of 0 */
        TEST_ASSERT_TRUE(ldexp(most, room) < 0x1p30 + 1.0 && (ldexp(most, room + 1) > 0x1p30 - 1.0 || room == 29));
        const fixed_wide_t wide = {a, (int32_t)(n % 9) - 4};
        TEST_ASSERT_DOUBLE_WITHIN(0.0, floor(ldexp((double)a, wide.exponent - 40)), (double)wide_in_unit(wide, 40));
        TEST_ASSERT_DOUBLE_WITHIN(0.0, (double)a, (double)wide_in_unit(wide, wide.exponent));
    }
}

/* The unit of the search has room for the largest of all words, whichever that is and whatever its sign. What grows
 * with the square of the load counts 16 times. */
static void test_each_word_counts_in_the_unit_of_the_search(void)
{
    fixed_rest_t rest = {.root_softens = 0};
    int32_t *const words[] = {&rest.resists.rr,  &rest.resists.ra,   &rest.resists.rb,
                              &rest.resists.aa,  &rest.resists.ab,   &rest.resists.bb,
                              &rest.end_resists, &rest.root_softens, &rest.end_softens};
    for (uint32_t i = 0; i < sizeof words / sizeof *words; i++) {
        const uint32_t times = i < 7u ? 1u : 16u;
        const int32_t size = 0x00765432;
        memset(&rest, 0, sizeof rest);
        *words[i] = size;
        TEST_ASSERT_EQUAL_HEX32((uint32_t)size * times, fixed_sizes_of(&rest));
        if (i < 7u) {
            *words[i] = -size;
            TEST_ASSERT_EQUAL_HEX32((uint32_t)size - 1u, fixed_sizes_of(&rest));
        }
    }
}

/* A parabola through three determinants: at 1, at the load that is the root of two times that, and at one below, which
 * is no load, or 1, 2 or 4 half octaves less. A step of Newton's method from the chord's root leaves the square of how
 * far the root is from there. Nothing lies outside the two loads. */
static void test_the_root_of_a_parabola(void)
{
    static const double below[] = {0.70710678118654752, 0.5, 0.25, 0.0};
    static const int32_t k_q30[] = {Q31(0.5857864376 / 2), Q31(0.4530818393 / 2), Q31(0.3557642 / 2),
                                    Q31(0.2928932188 / 2)};
    static const int32_t l_q29[] = {Q31(1.414213562 / 4), Q31(0.8284271247 / 4), Q31(0.5522847498 / 4),
                                    Q31(0.4142135624 / 4)};
    const double high = 1.4142135623730951;
    for (int n = 0; n < 300 * TIMES; n++) {
        const double root = any(1.01, 1.40), other = n % 2 == 0 ? any(2.0, 20.0) : any(-20.0, -1.0);
        const int which = n % 4;
        const double unit = pow(10.0, any(-3.0, 0.0)) / fabs((0.0 - root) * (0.0 - other)) * 0.9;
        const double sign = other > 0.0 ? 1.0 : -1.0;
        const double at[3] = {sign * unit * (below[which] - root) * (below[which] - other),
                              sign * unit * (1.0 - root) * (1.0 - other), sign * unit * (high - root) * (high - other)};
        const double chord = at[1] / (at[1] - at[2]), is_q = (root - 1.0) / (high - 1.0);
        const int32_t is =
            fixed_root_q30(word(at[0], 30), word(at[1], 30), word(at[2], 30), k_q30[which], l_q29[which]);
        const double rho = (at[0] - at[1]) / (at[1] - at[2]);
        if (fabs(rho) < 7.9) {
            const double rounding = 0x1p-28 / (at[1] - at[2]), left = 4.0 * (chord - is_q) * (chord - is_q);
            TEST_ASSERT_DOUBLE_WITHIN(left + rounding + 1e-6, is_q, number(is, 30));
        }
    }
}

/* The step that fixed_buckling.h names, whatever the three determinants are: within the two loads, and from the chord's
 * root not at all where the parabola does not fall there. */
static void test_a_step_from_the_chord_s_root(void)
{
    static const double k[] = {0.5857864376, 0.4530818393, 0.3557642, 0.2928932188};
    static const double l[] = {1.414213562, 0.8284271247, 0.5522847498, 0.4142135624};
    int ends[3] = {0, 0, 0};
    for (int n = 0; n < 600 * TIMES; n++) {
        const double low = pow(10.0, any(-1.5, -0.1)), high = -pow(10.0, any(-1.5, -0.1)), before = any(-0.9, 0.9);
        const int which = n % 4;
        const int32_t is = fixed_root_q30(word(before, 30), word(low, 30), word(high, 30), word(0.5 * k[which], 31),
                                          word(0.25 * l[which], 31));
        const double chord = low / (low - high), rho = fmax(-8.0, fmin(8.0, (before - low) / (low - high)));
        const double g = -k[which] * (1.0 - l[which] * rho), slope = 1.0 - g * (2.0 * chord - 1.0);
        const double root = chord - g * chord * (1.0 - chord) / slope;
        if (fabs(slope - 0.0625) > 1e-5) {
            const double wanted = slope < 0.0625 ? chord : fmax(0.0, fmin(1.0, root));
            TEST_ASSERT_DOUBLE_WITHIN(2e-6 / (slope * slope), wanted, number(is, 30));
            ends[slope < 0.0625 ? 0 : root < 0.0 ? 1 : root > 1.0 ? 2 : 0]++;
        }
    }
    TEST_ASSERT_TRUE(ends[0] > 100 * TIMES && ends[1] + ends[2] > 0);
}

/* A tibia that all but buckles about the knee passes on nearly 16 times what it resists, and the femur's end is
 * softened beside it: the sum leaves its word, and the limb is refused. (The sanitized build stops where it
 * overflows.) */
static void test_a_tibia_close_to_its_limit_is_refused(void)
{
    for (int n = 0; n < 200 * TIMES; n++) {
        const double resists = any(-1.1, -0.9), pivot = any(0.0625, 0.066);
        const fixed_rest_t tibia = {.resists = {.rr = word(resists, 27)}};
        const fixed_rest_t femur = {.end_softens = word(any(0.2, 0.5), 27)};
        const int32_t knee = word((pivot - 1.0) / resists, 29);
        const fixed_stance_t stance = {.femur = &femur, .tibia = &tibia, .knee = knee};
        fixed_pivots_t p;
        TEST_ASSERT_FALSE(fixed_pivots_of(&stance, &p));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_link_s_matrix_is_eliminated_within_its_words);
    RUN_TEST(test_a_link_is_solved_within_its_words);
    RUN_TEST(test_a_joint_s_pivot_stays_within_its_word);
    RUN_TEST(test_a_tibia_close_to_its_limit_is_refused);
    RUN_TEST(test_a_wide_product);
    RUN_TEST(test_a_step_bends_no_link_too_far);
    RUN_TEST(test_shifts_of_the_search);
    RUN_TEST(test_each_word_counts_in_the_unit_of_the_search);
    RUN_TEST(test_the_root_of_a_parabola);
    RUN_TEST(test_a_step_from_the_chord_s_root);
    return UNITY_END();
}
