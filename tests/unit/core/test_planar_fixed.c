#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "brace/planar_fixed.h"
#include "fixed/fixed_det.h"
#include "fixed/fixed_inverse.h"
#include "fixed/fixed_kept.h"
#include "fixed/fixed_table.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

#define Q28 268435456.0
#define PI 3.14159265358979324

/* Beyond the worst that the sweeps over hundreds of limbs found (5e-7); an eighth of what is promised. */
#define ERROR_LIMIT 6e-7
#define AXIS_LIMIT_RAD 3e-7

static brace_planar_fixed_t fixed;

static int32_t q28(double angle_rad)
{
    return (int32_t)floor(angle_rad * Q28 + 0.5);
}

static brace_stiffness_t stiffness_at(int32_t theta1_q28, int32_t theta2_q28)
{
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_fixed_stiffness(&fixed, theta1_q28, theta2_q28, &k));
    return k;
}

static void collapse(int sample)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_fixed_collapse(&sample_limb[sample], &fixed));
}

void setUp(void)
{
    memset(&fixed, 0, sizeof fixed);
}

void tearDown(void) {}

static void test_check_value_of_the_physics_page(void)
{
    collapse(SAMPLE_PAPER);
    const brace_stiffness_t k = stiffness_at(q28(1.0), q28(1.4));
    const double limit = ERROR_LIMIT * 4.0;
    TEST_ASSERT_DOUBLE_WITHIN(limit, 3.96389818, (double)k.k_xx_n_per_mm);
    TEST_ASSERT_DOUBLE_WITHIN(limit, -0.63872477, (double)k.k_xz_n_per_mm);
    TEST_ASSERT_DOUBLE_WITHIN(limit, 0.42806021, (double)k.k_zz_n_per_mm);
    TEST_ASSERT_EQUAL(0, k.flags);
}

static void test_every_sample_over_the_workspace(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        collapse(sample);
        for (int i = -12; i <= 12; i++) {
            for (int j = -24; j <= 24; j++) {
                const int32_t theta1 = q28(PI * i / 12.0), theta2 = q28(PI * j / 24.0);
                const brace_stiffness_t k = stiffness_at(theta1, theta2);
                const reference_planar_t r = reference_planar(&sample_limb[sample], theta1 / Q28, theta2 / Q28);
                TEST_ASSERT_TRUE(reference_error(&r, &k) < ERROR_LIMIT);
                TEST_ASSERT_TRUE(reference_axis_error(&r, &k) < AXIS_LIMIT_RAD);
            }
        }
    }
}

/* Ellipsoids tilted either way, as far as they go. */
static void test_every_tilt_over_the_knee_s_angles(void)
{
    int answered = 0;
    for (int i = 0; i < 64; i++) {
        brace_limb_t limb = sample_limb[i % 2 == 0 ? SAMPLE_TILTED : SAMPLE_PAPER];
        limb.link[BRACE_FEMUR].tilt_rad = 0.4f * (float)(i / 2 % 8 - 4);
        limb.link[BRACE_TIBIA].tilt_rad = 0.5f * (float)(i / 16 - 2) + 0.25f;
        if (brace_planar_fixed_collapse(&limb, &fixed) != BRACE_OK || fixed.flags != 0u) {
            continue;
        }
        answered++;
        for (int j = -12; j <= 12; j++) {
            const int32_t theta2 = q28(PI * j / 12.0);
            const brace_stiffness_t k = stiffness_at(q28(0.3), theta2);
            const reference_planar_t r = reference_planar(&limb, q28(0.3) / Q28, theta2 / Q28);
            TEST_ASSERT_TRUE(reference_error(&r, &k) < ERROR_LIMIT);
        }
    }
    TEST_ASSERT_TRUE(answered > 40);
}

static void test_close_to_straight_and_folded(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        collapse(sample);
        for (int bit = 0; bit < 28; bit++) {
            const int32_t near[4] = {1 << bit, -(1 << bit), q28(PI) - (1 << bit), -q28(PI) + (1 << bit)};
            for (int i = 0; i < 4; i++) {
                const brace_stiffness_t k = stiffness_at(q28(0.3), near[i]);
                const reference_planar_t r = reference_planar(&sample_limb[sample], q28(0.3) / Q28, near[i] / Q28);
                TEST_ASSERT_TRUE(reference_error(&r, &k) < ERROR_LIMIT);
            }
        }
    }
}

static void test_every_word_is_an_angle(void)
{
    const int32_t word[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX};
    collapse(SAMPLE_TILTED);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            const brace_stiffness_t k = stiffness_at(word[i], word[j]);
            const reference_planar_t r = reference_planar(&sample_limb[SAMPLE_TILTED], word[i] / Q28, word[j] / Q28);
            TEST_ASSERT_TRUE(reference_error(&r, &k) < ERROR_LIMIT);
        }
    }
}

static void test_turning_the_limb_leaves_the_eigenvalues(void)
{
    collapse(SAMPLE_TILTED);
    const brace_stiffness_t at_rest = stiffness_at(0, q28(1.1));
    for (int i = -7; i <= 7; i++) {
        const brace_stiffness_t k = stiffness_at(q28(0.4 * i), q28(1.1));
        TEST_ASSERT_EQUAL_MEMORY(&at_rest.lambda_min_n_per_mm, &k.lambda_min_n_per_mm, sizeof(float));
        TEST_ASSERT_EQUAL_MEMORY(&at_rest.lambda_max_n_per_mm, &k.lambda_max_n_per_mm, sizeof(float));
        const double turned = (double)k.stiff_axis_rad - (double)at_rest.stiff_axis_rad - 0.4 * i;
        TEST_ASSERT_DOUBLE_WITHIN(AXIS_LIMIT_RAD, 0.0, turned - PI * floor(turned / PI + 0.5));
    }
}

static void test_round_compliance_has_equal_eigenvalues_and_some_axis(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_ROUND];
    limb.base.x_mm_per_n = limb.base.z_mm_per_n = 0.05f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_fixed_collapse(&limb, &fixed));
    const brace_stiffness_t k = stiffness_at(q28(0.7), q28(-2.0));
    TEST_ASSERT_FLOAT_WITHIN(3e-6f, 5.0f, k.k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(3e-6f, 5.0f, k.k_zz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(3e-6f, 0.0f, k.k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(3e-6f, 5.0f, k.lambda_min_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(3e-6f, 5.0f, k.lambda_max_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1.5708f, 0.0f, k.stiff_axis_rad);
}

static void test_null_is_refused_and_nothing_touched(void)
{
    brace_stiffness_t k, untouched;
    memset(&k, 0x5a, sizeof k);
    untouched = k;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_fixed_stiffness(NULL, 0, 0, &k));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &k, sizeof k);
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_fixed_stiffness(&fixed, 0, 0, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_fixed_collapse(&sample_limb[0], NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_fixed_collapse(NULL, &fixed));
}

static void refused(const brace_limb_t *limb, brace_status_t status)
{
    brace_planar_fixed_t before;
    memset(&fixed, 0x5a, sizeof fixed);
    before = fixed;
    TEST_ASSERT_EQUAL(status, brace_planar_fixed_collapse(limb, &fixed));
    TEST_ASSERT_EQUAL_MEMORY(&before, &fixed, sizeof fixed);
}

static void test_what_it_cannot_serve_is_refused_and_nothing_touched(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    limb.base.x_mm_per_n = 0.1f;
    refused(&limb, BRACE_E_UNSUPPORTED); /* the base yields unequally */

    limb = sample_limb[SAMPLE_SLENDER];
    limb.link[BRACE_FEMUR].axial_mm_per_n = 1e-9f;
    limb.link[BRACE_TIBIA].axial_mm_per_n = 1e-9f;
    refused(&limb, BRACE_E_UNSUPPORTED); /* too slender for 32 bits */

    limb = sample_limb[SAMPLE_PAPER];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i].axial_mm_per_n *= 1e-12f;
        limb.link[i].bending_mm_per_n *= 1e-12f;
        limb.joint[i].compliance_rad_per_n_mm *= 1e-12f;
    }
    refused(&limb, BRACE_E_UNSUPPORTED); /* too hard */
    limb = sample_limb[SAMPLE_PAPER];
    limb.femur_mm = limb.tibia_mm = 9e3f;
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 0.9f;
    refused(&limb, BRACE_E_UNSUPPORTED); /* too soft */

    limb = sample_limb[SAMPLE_PAPER];
    limb.femur_mm = NAN;
    refused(&limb, BRACE_E_NOT_FINITE);
    limb.femur_mm = -1.0f;
    refused(&limb, BRACE_E_PARAMETER);
}

static void test_slender_limbs_are_flagged_where_the_error_grows(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_SLENDER];
    limb.link[BRACE_FEMUR].axial_mm_per_n = 1e-6f;
    limb.link[BRACE_TIBIA].axial_mm_per_n = 1e-6f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_fixed_collapse(&limb, &fixed));
    TEST_ASSERT_EQUAL(BRACE_FLAG_NEAR_SINGULAR, stiffness_at(0, q28(1.0)).flags);
    collapse(SAMPLE_SLENDER);
    TEST_ASSERT_EQUAL(0, stiffness_at(0, q28(1.0)).flags);
}

static void test_seed_table_holds_what_it_says(void)
{
    for (int i = 16; i < 64; i++) {
        for (int j = 0; j < 16; j++) {
            const double z = (i + j / 16.0) / 64.0;
            const double guess = (brace_fixed_seed[i].at_q13 - brace_fixed_seed[i].slope_q13 * (j / 16.0)) / 8192.0;
            TEST_ASSERT_DOUBLE_WITHIN(1.9e-4, 1.0, guess * sqrt(z));
        }
    }
}

static void test_cell_table_points_where_its_cells_are(void)
{
    for (int i = 0; i < 3600; i++) {
        const double angle = 2.0 * PI * (i + 0.5) / 3600.0;
        const int32_t s = (int32_t)floor(8.0 * sin(angle)), c = (int32_t)floor(-8.0 * cos(angle));
        const double opposite = 2.0 * PI * brace_fixed_cell[s & 15][c & 15] / 64.0;
        TEST_ASSERT_TRUE(cos(opposite - angle - PI) > cos(0.107));
    }
}

/* Whether K can be found from det C depends on det over mean^2, whatever the unit of length and however stiff the limb.
 * A tilted limb is flagged sooner. */
static void test_judging_does_not_depend_on_units(void)
{
    static const struct {
        double ratio;
        brace_status_t status;
        bool is_flagged, is_flagged_if_tilted;
    } row[] = {{1e-7, BRACE_E_UNSUPPORTED, false, false},
               {1e-6, BRACE_OK, true, true},
               {1e-5, BRACE_OK, false, true},
               {1e-3, BRACE_OK, false, false}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        for (int n = 0; n < 18; n++) {
            const double mean = pow(10.0, n / 3 - 3), least = row[i].ratio * mean * mean;
            const int tilt = n % 3;
            const brace_det_t det = {{3.0 * least, 2.0 * least * 0.6, 2.0 * least * 0.8},
                                     {tilt == 1 ? 0.1 * mean : 0.0, tilt == 2 ? 0.1 * mean : 0.0, 0.3 * mean}};
            uint32_t flags = 99u;
            TEST_ASSERT_EQUAL(row[i].status, brace_det_judge(&det, mean, &flags));
            if (row[i].status == BRACE_OK) {
                const bool is_flagged = tilt == 0 ? row[i].is_flagged : row[i].is_flagged_if_tilted;
                TEST_ASSERT_EQUAL_UINT32(is_flagged ? BRACE_FLAG_NEAR_SINGULAR : 0u, flags);
            }
        }
    }
}

static double axis_of(double length, double angle)
{
    const int32_t x = (int32_t)lround(length * cos(angle)), z = (int32_t)lround(length * sin(angle));
    const fixed_circle_t circle = {UINT32_MAX, x, z, 0xf0000000u, 127u << 23, 127u << 23, 0u};
    brace_stiffness_t k;
    stiffness_of_circle(&circle, &k);
    return (double)k.stiff_axis_rad;
}

/* The deviator's length is that many of 2^31; the axis' promise follows from it. */
static void test_axis_of_a_nearly_round_compliance(void)
{
    for (int bits = 12; bits < 24; bits++) {
        const double length = ldexp(1.0, bits), limit = AXIS_LIMIT_RAD * 0x1p31 / (2.0 * length);
        for (int i = 0; i < 48; i++) {
            const double angle = PI * (i + 0.3) / 24.0, off = axis_of(length, angle) - axis_of(0x1p30, angle);
            TEST_ASSERT_DOUBLE_WITHIN(limit, 0.0, off - PI * floor(off / PI + 0.5));
        }
    }
}

static void test_a_harmonic_is_kept_by_its_largest_and_least_value(void)
{
    const int64_t unit = (int64_t)1 << 32;
    brace_fixed_harmonic_t h = {50 * unit, 0, 60}; /* 50 - 30 to 50 + 30 */
    TEST_ASSERT_TRUE(stays_within(&h, 18, 82));
    TEST_ASSERT_FALSE(stays_within(&h, 21, 82));
    TEST_ASSERT_FALSE(stays_within(&h, 18, 79));
    h.per_cos = 60; /* 42.4 to either side */
    TEST_ASSERT_TRUE(stays_within(&h, 6, 94));
    TEST_ASSERT_FALSE(stays_within(&h, 9, 94));
    TEST_ASSERT_FALSE(stays_within(&h, 6, 91));
}

static void test_a_structure_beyond_its_words_is_not_kept(void)
{
    collapse(SAMPLE_TILTED);
    const brace_planar_fixed_t good = fixed;
    TEST_ASSERT_TRUE(is_kept(&fixed));
    fixed.mean.constant_q32 = 0;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.minus_dev_x.constant_q32 = INT64_MIN;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.dev_z.constant_q32 = INT64_MAX;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.cross.constant_q32 = INT64_MIN;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.rest.constant_q32 = 0;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.rest_weight -= 1;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.exponent_k = 0u;
    TEST_ASSERT_FALSE(is_kept(&fixed));
    fixed = good, fixed.exponent_min = 255u << 23;
    TEST_ASSERT_FALSE(is_kept(&fixed));
}

/* Each entry is the sine and the cosine of its 64th of a turn, to the last place. */
static void test_the_table_is_sine_and_cosine(void)
{
    for (int i = 0; i < 64; i++) {
        const double angle_rad = i * (2.0 * PI / 64.0), one = (double)BRACE_FIXED_ONE;
        TEST_ASSERT_DOUBLE_WITHIN(0.501, one * sin(angle_rad), (double)brace_fixed_sincos[i].sin_q31);
        TEST_ASSERT_DOUBLE_WITHIN(0.501, one * cos(angle_rad), (double)brace_fixed_sincos[i].cos_q31);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_axis_of_a_nearly_round_compliance);
    RUN_TEST(test_a_harmonic_is_kept_by_its_largest_and_least_value);
    RUN_TEST(test_a_structure_beyond_its_words_is_not_kept);
    RUN_TEST(test_check_value_of_the_physics_page);
    RUN_TEST(test_every_sample_over_the_workspace);
    RUN_TEST(test_every_tilt_over_the_knee_s_angles);
    RUN_TEST(test_close_to_straight_and_folded);
    RUN_TEST(test_every_word_is_an_angle);
    RUN_TEST(test_turning_the_limb_leaves_the_eigenvalues);
    RUN_TEST(test_round_compliance_has_equal_eigenvalues_and_some_axis);
    RUN_TEST(test_null_is_refused_and_nothing_touched);
    RUN_TEST(test_what_it_cannot_serve_is_refused_and_nothing_touched);
    RUN_TEST(test_slender_limbs_are_flagged_where_the_error_grows);
    RUN_TEST(test_the_table_is_sine_and_cosine);
    RUN_TEST(test_seed_table_holds_what_it_says);
    RUN_TEST(test_cell_table_points_where_its_cells_are);
    RUN_TEST(test_judging_does_not_depend_on_units);
    return UNITY_END();
}
