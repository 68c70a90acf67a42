/* In space, floats and integers share no line but are the same sums. Here each part of the one is asked beside that of
 * the other, at one pose of one limb: the turns, the forces, what bends the links, what drives them, the matrix of the
 * straight limb and its solution, and K. So only words' rounding is between them, and no term is too small to show.
 * Whole results of both are compared in test_loaded_agree.c; whether the sums are right, the laws and the reference
 * say. */
#include <math.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the headers */
#include "fixed_space/invert.h"
#include "loaded/space_sum.h"

#include "even_limb.h"

static brace_loaded_space_t loaded;
static brace_loaded_space_fixed_t fixed;
static brace_space_rest_t rest;
static brace_space_fixed_rest_t words;
static double force_unit_n, length_unit_mm;

void setUp(void)
{
    start_anew();
}

void tearDown(void) {}

static int32_t word(double number, int format)
{
    return (int32_t)floor(ldexp(number, format));
}

static fixed3_t words_of(vec3_t v, double unit, int format)
{
    return fixed3(word((double)v.x / unit, format), word((double)v.y / unit, format), word((double)v.z / unit, format));
}

static void expect(double within, float wanted, int32_t is, int format, double unit)
{
    TEST_ASSERT_DOUBLE_WITHIN(within * unit, (double)wanted, ldexp((double)is, -format) * unit);
}

static void expect3(double within, vec3_t wanted, fixed3_t is, int format, double unit)
{
    expect(within, wanted.x, is.x, format, unit);
    expect(within, wanted.y, is.y, format, unit);
    expect(within, wanted.z, is.z, format, unit);
}

static void expect2(double within, brace_vec_t wanted, fixed_vec_t is, int format, double unit)
{
    expect(within, wanted.x, is.x, format, unit);
    expect(within, wanted.z, is.z, format, unit);
}

static float rad_of(int32_t angle_q29)
{
    return (float)ldexp((double)angle_q29, -29);
}

static vec3_t rads_of(fixed3_t angle_q29)
{
    return vec3(rad_of(angle_q29.x), rad_of(angle_q29.y), rad_of(angle_q29.z));
}

/* A limb at an equilibrium by integers, and its pose given to the floats. returns false where it does not settle */
static bool take_any_limb(int i)
{
    const double force_n = any(1.0, 60.0);
    be_even(i % 2 == 0 ? 0.1 : 0.25, force_n);
    be_pressed(force_n);
    brace_loaded_space_collapse(&limb, &weights, &loaded);
    brace_loaded_space_fixed_collapse(&loaded, &fixed);
    const float theta1 = (float)theta1_rad, theta2 = (float)theta2_rad;
    if (brace_loaded_space_fixed_settle(&fixed, theta1, theta2, &space_load, &words) != BRACE_OK ||
        brace_loaded_space_settle(&loaded, theta1, theta2, &space_load, &rest) != BRACE_OK) {
        return false;
    }
    const brace_space_fixed_pose_t *pose = &words.pose;
    rest.pose = (brace_space_pose_t){rads_of(pose->coxa), rads_of(pose->femur), rads_of(pose->tibia),
                                     rad_of(pose->base), rad_of(pose->yaw), rad_of(pose->hip), rad_of(pose->knee)};
    force_unit_n = ldexp(1.0, words.force_exponent);
    length_unit_mm = ldexp(1.0, fixed.length_exponent);
    return true;
}

static void expect_turns(const brace_space_turns_t *wanted, const fixed_turns3_t *is)
{
    const double within = 1e-6; /* floats of 1 have a last place of 1e-7 */
    expect2(within, wanted->base, is->base, 30, 1.0);
    expect2(within, wanted->yaw, is->yaw, 30, 1.0);
    expect2(within, wanted->coxa_z, is->coxa_z, 30, 1.0);
    expect2(within, wanted->coxa_y, is->coxa_y, 30, 1.0);
    expect2(within, wanted->coxa_x, is->coxa_x, 30, 1.0);
    expect2(within, wanted->hip, is->hip, 30, 1.0);
    expect2(within, wanted->femur_y, is->femur_y, 30, 1.0);
    expect2(within, wanted->femur_x, is->femur_x, 30, 1.0);
    expect2(within, wanted->knee, is->knee, 30, 1.0);
    expect2(within, wanted->tibia_y, is->tibia_y, 30, 1.0);
}

static void expect_bent(const brace_space_bent_t *wanted, const fixed_bent3_t *is)
{
    const double within = 1e-6;
    expect3(within, wanted->beyond_n, is->beyond_q30, 30, force_unit_n);
    expect3(within, wanted->own_n, is->own_q30, 30, force_unit_n);
    expect3(within, wanted->chord_mm, is->chord_q28, 28, length_unit_mm);
    expect3(within, wanted->across, is->across_q30, 30, 1.0);
    expect(within, wanted->sideways.x, is->sideways_x_q30, 30, 1.0);
    expect2(within, wanted->by_bend_mm, is->by_bend_q28, 28, length_unit_mm);
    expect(within, wanted->by_sideways_mm, is->by_sideways_q28, 28, length_unit_mm);
    expect(within, wanted->across_curl, is->across_curl_q30, 30, 1.0);
    expect(within, wanted->sideways_curl, is->sideways_curl_q30, 30, 1.0);
}

static void expect_pose(double within, const brace_space_pose_t *wanted, const brace_space_fixed_pose_t *is, int format,
                        double unit)
{
    expect3(within, wanted->coxa, is->coxa, format, unit);
    expect3(within, wanted->femur, is->femur, format, unit);
    expect3(within, wanted->tibia, is->tibia, format, unit);
    expect(within, wanted->base, is->base, format, unit);
    expect(within, wanted->yaw, is->yaw, format, unit);
    expect(within, wanted->hip, is->hip, format, unit);
    expect(within, wanted->knee, is->knee, format, unit);
}

/* A link bends by its turn, its springs and its weight; what drives its turns then. */
static void test_a_bent_limb_part_by_part(void)
{
    int told = 0;
    state = 5u;
    for (int i = 0; i < 40 * TIMES; i++) {
        if (!take_any_limb(i)) {
            continue;
        }
        told++;
        const double coxa_rad = any(-0.2, 0.2), femur_rad = any(-0.2, 0.2);
        curls_t curls = {(float)coxa_rad, (float)femur_rad};
        fixed_curls_t curl_words = {word(coxa_rad, 29), word(femur_rad, 29)};
        const commanded_t commanded = {rest.hip_commanded, rest.knee_commanded};
        noted_t noted = 0u;
        turns_of(&rest.pose, curls, &commanded, &rest.turns);
        fixed_turns_of(&words, curl_words, &words.turns, &noted);
        expect_turns(&rest.turns, &words.turns);

        const fixed_weights_t parts = {word((double)loaded.beyond_coxa_n / force_unit_n, 30),
                                       word((double)loaded.beyond_femur_n / force_unit_n, 30),
                                       word((double)loaded.femur.weight_n / force_unit_n, 30),
                                       word((double)loaded.tibia.weight_n / force_unit_n, 30)};
        brace_space_pose_t drives;
        brace_space_fixed_pose_t drive_words;
        rest.coxa.own_n = vec3(1.0f, 2.0f, 3.0f);
        words.coxa.own_q30 = fixed3(1, 2, 3);
        see_forces(&loaded, rest.tip_n, rest.down, &rest);
        fixed_see_forces(&parts, words_of(rest.tip_n, force_unit_n, 30), words_of(rest.down, 1.0, 30), &words);
        const vec3_t none_n = {0.0f, 0.0f, 0.0f}; /* the base bears the coxa link's weight */
        const fixed3_t none = {0, 0, 0};
        TEST_ASSERT_EQUAL_MEMORY(&none_n, &rest.coxa.own_n, sizeof none_n);
        TEST_ASSERT_EQUAL_MEMORY(&none, &words.coxa.own_q30, sizeof none);
        bend_limb(&loaded, &rest, &curls, true, &drives);
        fixed_bend_limb(&fixed, &words, &curl_words, true, &drive_words, &noted);
        TEST_ASSERT_FALSE(is_refused(noted));
        expect_bent(&rest.coxa, &words.coxa);
        expect_bent(&rest.femur, &words.femur);
        expect_bent(&rest.tibia, &words.tibia);
        expect_pose(1e-6, &drives, &drive_words, 27, force_unit_n * length_unit_mm);
        expect(1e-6, curls.coxa, curl_words.coxa, 29, 1.0);
        expect(1e-6, curls.femur, curl_words.femur, 29, 1.0);
    }
    TEST_ASSERT_TRUE(told > 30 * TIMES);
}

/* Rounding of 2^-24 in some hundred sums, over the square of the smallest pivot. */
static double factors_within;

static void find_within(const factors_t *f)
{
    const link_factor_t *const links[] = {&f->coxa, &f->femur, &f->tibia};
    float most = fmaxf(fmaxf(f->yaw.per_pivot, f->hip.per_pivot), fmaxf(f->knee.per_pivot, f->base_per_pivot));
    most = fmaxf(most, 1.0f);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        most = fmaxf(most, fmaxf(links[i]->y.per_pivot, links[i]->z.per_pivot));
    }
    factors_within = 3e-5 * (double)most * (double)most;
}

static void expect_yields(float wanted, int32_t is_q26)
{
    const double moment = force_unit_n * length_unit_mm;
    expect(factors_within * fmax(1.0, (double)wanted * moment), wanted, is_q26, 26, 1.0 / moment);
}

static void expect_factor(const joint_factor_t *wanted, const fixed_factor_t *is)
{
    const double moment = force_unit_n * length_unit_mm;
    expect3(factors_within, wanted->row, is->row_q24, 24, moment);
    expect_yields(wanted->yields, is->yields_q26);
    expect(factors_within, wanted->per_pivot, is->per_pivot_q27, 27, 1.0);
}

static void expect_link_factor(const link_factor_t *wanted, const fixed_link_factor_t *is)
{
    const double moment = force_unit_n * length_unit_mm;
    expect_factor(&wanted->y, &is->y);
    expect_factor(&wanted->z, &is->z);
    expect(factors_within, wanted->between, is->between_q24, 24, moment);
    expect(2e-6, wanted->twist_rad_per_n_mm, is->twist_q26, 26, 1.0 / moment);
}

static forces_t any_forces(void)
{
    const double most_n = 0.25 * force_unit_n;
    return (forces_t){vec3((float)any(-most_n, most_n), (float)any(-most_n, most_n), (float)any(-most_n, most_n)),
                      vec3((float)any(-most_n, most_n), (float)any(-most_n, most_n), (float)any(-most_n, most_n))};
}

/* The straight limb's matrix under any forces on its links, eliminated, and a step with it from a bent pose. */
static void test_the_straight_limb_part_by_part(void)
{
    int told = 0;
    state = 6u;
    for (int i = 0; i < 40 * TIMES; i++) {
        if (!take_any_limb(i)) {
            continue;
        }
        forces_t at[3];
        fixed_forces_t at_words[3];
        for (int link = 0; link < 3; link++) {
            at[link] = any_forces();
            at_words[link] = (fixed_forces_t){words_of(at[link].beyond_n, force_unit_n, 30),
                                              words_of(at[link].own_n, force_unit_n, 30)};
        }
        const commanded_t commanded = {rest.hip_commanded, rest.knee_commanded};
        const fixed_commanded_t commanded_words = {fixed_direction(words.theta1_turn),
                                                   fixed_direction(0u - words.theta2_turn)};
        const fixed_yields_t yields = {words.base_q26, words.yaw_q26, words.hip_q26, words.knee_q26, words.turn_shift};
        factors_t factors;
        fixed_factors_t factor_words;
        brace_space_pose_t drives, step;
        brace_space_fixed_pose_t drive_words, step_words;
        noted_t noted = 0u;
        straight_limb(&loaded, at, &commanded, &rest, &factors, &drives);
        fixed_straight_limb(&fixed, at_words, &commanded_words, &yields, words.whole_q30, &factor_words, &drive_words,
                            &noted);
        if (is_refused(noted)) {
            continue;
        }
        told++;
        const double moment = force_unit_n * length_unit_mm;
        expect_pose(1e-6, &drives, &drive_words, 27, moment);
        find_within(&factors);
        expect_link_factor(&factors.coxa, &factor_words.coxa);
        expect_link_factor(&factors.femur, &factor_words.femur);
        expect_link_factor(&factors.tibia, &factor_words.tibia);
        expect_factor(&factors.yaw, &factor_words.yaw);
        expect_factor(&factors.hip, &factor_words.hip);
        expect_factor(&factors.knee, &factor_words.knee);
        expect_yields(factors.base_yields, factor_words.base_yields_q26);
        expect(factors_within, factors.base_per_pivot, factor_words.base_per_pivot_q27, 27, 1.0);

        /* Floats leave out of a twist what turns beyond it drive. */
        factors.coxa.twist_rad_per_n_mm = factors.femur.twist_rad_per_n_mm = factors.tibia.twist_rad_per_n_mm = 0.0f;
        factor_words.coxa.twist_q26 = factor_words.femur.twist_q26 = factor_words.tibia.twist_q26 = 0;
        solve_straight(&factors, &drives, &rest.pose, &commanded, &step);
        fixed_solve_straight(&factor_words, &drive_words, &words.pose, &commanded_words, &step_words, &noted);
        if (!is_refused(noted)) {
            expect_pose(factors_within, &step, &step_words, 29, 1.0);
        }
    }
    TEST_ASSERT_TRUE(told > 30 * TIMES);
}

/* How far a coordinate's numbers may be apart: roundings of q24 and q26, over all the pivots beyond it. */
#define FREEDOM_WITHIN 5e-5

/* unit: what the coordinate is counted in, 1 rad or a spring's arm [mm] */
static void expect_freedom(const freedom_t *wanted, const fixed_freedom_t *is, double unit)
{
    const double yields = (double)wanted->yields * force_unit_n * length_unit_mm / (unit * unit);
    const double within = FREEDOM_WITHIN * (1.0 + yields);
    expect3(within, wanted->follows, is->follows, RANGES.ratio, unit);
    TEST_ASSERT_DOUBLE_WITHIN(within, yields, ldexp((double)is->yields_q26, -26));
}

static void expect_link_freedoms(const link_freedoms_t *wanted, const fixed_link_freedoms_t *is, uint32_t arm_shift,
                                 bool is_last)
{
    const double arm_mm = ldexp(length_unit_mm, -(int)arm_shift);
    expect_freedom(&wanted->across, &is->across, arm_mm);
    expect_freedom(&wanted->sideways, &is->sideways, arm_mm);
    expect3(FREEDOM_WITHIN, wanted->by_across, is->by_across, RANGES.ratio, arm_mm);
    expect3(FREEDOM_WITHIN, wanted->by_sideways, is->by_sideways, RANGES.ratio, arm_mm);
    expect_freedom(&wanted->y, &is->y, 1.0);
    expect_freedom(&wanted->z, &is->z, 1.0);
    expect(FREEDOM_WITHIN, wanted->z_by_y, is->z_by_y, RANGES.ratio, 1.0);
    if (!is_last) {
        expect_freedom(&wanted->x, &is->x, 1.0);
        expect(FREEDOM_WITHIN, wanted->y_by_x, is->y_by_x, RANGES.ratio, 1.0);
        expect(FREEDOM_WITHIN, wanted->z_by_x, is->z_by_x, RANGES.ratio, 1.0);
    }
}

/* Each coordinate's compliance when those beyond it are eliminated, and how these follow it. */
static void expect_freedoms(void)
{
    freedoms_t wanted;
    fixed_freedoms_t is;
    noted_t noted = 0u;
    (void)eliminate_limb(&loaded, &rest, &wanted);
    fixed_eliminate_limb(&fixed, &words, NULL, &is, &noted);
    TEST_ASSERT_FALSE(is_refused(noted));
    expect_link_freedoms(&wanted.tibia, &is.tibia, fixed.tibia.arm_shift, true);
    expect_link_freedoms(&wanted.femur, &is.femur, fixed.femur.arm_shift, false);
    expect_link_freedoms(&wanted.coxa, &is.coxa, fixed.coxa.arm_shift, false);
    expect_freedom(&wanted.knee, &is.knee, 1.0);
    expect_freedom(&wanted.hip, &is.hip, 1.0);
    expect_freedom(&wanted.yaw, &is.yaw, 1.0);
    expect(FREEDOM_WITHIN * 10.0, wanted.base_yields, is.base_yields_q26, 26, 1.0 / (force_unit_n * length_unit_mm));
}

/* K at the same turns and the same bent links. */
static void test_K_at_one_pose(void)
{
    int told = 0;
    state = 8u;
    for (int i = 0; i < 40 * TIMES; i++) {
        if (!take_any_limb(i)) {
            continue;
        }
        curls_t curls = {0.0f, 0.0f};
        fixed_curls_t curl_words = {0, 0};
        brace_space_pose_t drives;
        brace_space_fixed_pose_t drive_words;
        noted_t noted = 0u;
        const commanded_t commanded = {rest.hip_commanded, rest.knee_commanded};
        turns_of(&rest.pose, curls, &commanded, &rest.turns);
        fixed_turns_of(&words, curl_words, &words.turns, &noted);
        see_forces(&loaded, rest.tip_n, rest.down, &rest);
        rest.whole_n = vec3_plus_scaled(rest.tip_n, rest.down, loaded.beyond_coxa_n);
        bend_limb(&loaded, &rest, &curls, false, &drives);
        fixed_bend_limb(&fixed, &words, &curl_words, false, &drive_words, &noted);
        brace_space_result_t a, b;
        if (brace_loaded_space_stiffness(&loaded, &rest, &a) != BRACE_OK ||
            brace_loaded_space_fixed_stiffness(&fixed, &words, &b) != BRACE_OK) {
            continue;
        }
        told++;
        expect_freedoms();
        const float of_a[6] = {a.k.xx_n_per_mm, a.k.xy_n_per_mm, a.k.xz_n_per_mm,
                               a.k.yy_n_per_mm, a.k.yz_n_per_mm, a.k.zz_n_per_mm};
        const float of_b[6] = {b.k.xx_n_per_mm, b.k.xy_n_per_mm, b.k.xz_n_per_mm,
                               b.k.yy_n_per_mm, b.k.yz_n_per_mm, b.k.zz_n_per_mm};
        const double most = (double)(of_a[0] + of_a[3] + of_a[5]);
        for (int e = 0; e < 6; e++) {
            TEST_ASSERT_DOUBLE_WITHIN(2e-5 * most, (double)of_a[e], (double)of_b[e]);
        }
        const float moved_a[6] = {a.displacement_mm.x, a.displacement_mm.y, a.displacement_mm.z,
                                  a.tibia_mm.x, a.tibia_mm.y, a.tibia_mm.z};
        const float moved_b[6] = {b.displacement_mm.x, b.displacement_mm.y, b.displacement_mm.z,
                                  b.tibia_mm.x, b.tibia_mm.y, b.tibia_mm.z};
        for (int e = 0; e < 6; e++) {
            TEST_ASSERT_DOUBLE_WITHIN(5e-6 * length_unit_mm, (double)moved_a[e], (double)moved_b[e]);
        }
    }
    TEST_ASSERT_TRUE(told > 30 * TIMES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_bent_limb_part_by_part);
    RUN_TEST(test_the_straight_limb_part_by_part);
    RUN_TEST(test_K_at_one_pose);
    return UNITY_END();
}
