#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "brace/limb.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

static brace_limb_t limb;

void setUp(void)
{
    limb = sample_limb[SAMPLE_PAPER];
}

void tearDown(void) {}

static void test_limbs_that_exist(void)
{
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&sample_limb[i]));
    }
}

static void test_null(void)
{
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_limb_check(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_limb_check_together(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_limb_check_lengths(NULL));
}

static void test_every_field_must_be_finite(void)
{
    float *field = &limb.coxa_mm;
    for (size_t i = 0; i < sizeof limb / sizeof *field; i++) {
        const float saved = field[i];
        field[i] = NAN;
        TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_limb_check(&limb));
        field[i] = -INFINITY;
        TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_limb_check(&limb));
        field[i] = saved;
    }
}

static void test_every_field_has_an_upper_bound(void)
{
    float *field = &limb.coxa_mm;
    for (size_t i = 0; i < sizeof limb / sizeof *field; i++) {
        const float saved = field[i];
        field[i] = 2e4f;
        TEST_ASSERT_EQUAL_MESSAGE(BRACE_E_PARAMETER, brace_limb_check(&limb), "too large");
        field[i] = -2e4f;
        TEST_ASSERT_EQUAL_MESSAGE(BRACE_E_PARAMETER, brace_limb_check(&limb), "too small");
        field[i] = saved;
    }
}

typedef struct {
    size_t offset;
    float least, most;
} bound_t;

static void test_bounds_are_inclusive_and_sharp(void)
{
    static const bound_t bound[] = {
        {offsetof(brace_limb_t, coxa_mm), 1.0f, 1e4f}, /* this coxa passes moments on */
        {offsetof(brace_limb_t, femur_mm), 1.0f, 1e4f},
        {offsetof(brace_limb_t, tibia_mm), 1.0f, 1e4f},
        {offsetof(brace_limb_t, link[BRACE_FEMUR].axial_mm_per_n), 0.0f, 1e3f},
        {offsetof(brace_limb_t, link[BRACE_TIBIA].bending_mm_per_n), 0.0f, 1e3f},
        {offsetof(brace_limb_t, link[BRACE_COXA].lateral_mm_per_n), 0.0f, 1e3f},
        {offsetof(brace_limb_t, link[BRACE_COXA].torsion_rad_per_n_mm), 0.0f, 1.0f},
        {offsetof(brace_limb_t, link[BRACE_FEMUR].moment_transfer), 0.0f, 1.0f},
        {offsetof(brace_limb_t, joint[BRACE_TIBIA].compliance_rad_per_n_mm), 0.0f, 1.0f},
        {offsetof(brace_limb_t, joint[BRACE_COXA].gap_rad), 0.0f, 0.5f},
        {offsetof(brace_limb_t, joint[BRACE_FEMUR].zero_offset_rad), -0.5f, 0.5f},
        {offsetof(brace_limb_t, base.x_mm_per_n), 0.0f, 1e3f},
        {offsetof(brace_limb_t, base.rotation_rad_per_n_mm), 0.0f, 1.0f},
        {offsetof(brace_limb_t, uncertainty.length_mm), 0.0f, 100.0f},
        {offsetof(brace_limb_t, uncertainty.angle_rad), 0.0f, 0.5f},
        {offsetof(brace_limb_t, uncertainty.gain_rel), 0.0f, 1.0f},
    };
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        float *field = (float *)((char *)&limb + bound[i].offset);
        const float saved = *field;
        *field = bound[i].least;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
        *field = nextafterf(bound[i].least, -INFINITY);
        TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
        *field = bound[i].most;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
        *field = nextafterf(bound[i].most, INFINITY);
        TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
        *field = saved;
    }
}

/* Zero has a sign, and a field that may be zero takes it with either. */
static void test_minus_zero_is_zero(void)
{
    limb.link[BRACE_COXA].moment_transfer = -0.0f;
    limb.coxa_mm = -0.0f;
    limb.base.x_mm_per_n = -0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
    limb.femur_mm = -0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
}

static void all_rigid(void)
{
    memset(limb.link, 0, sizeof limb.link);
    memset(limb.joint, 0, sizeof limb.joint);
    memset(&limb.base, 0, sizeof limb.base);
}

static void test_something_must_yield_in_each_direction(void)
{
    all_rigid();
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 1e-5f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.base.rotation_rad_per_n_mm = 1e-5f; /* about the same axis */
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 1e-5f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
}

static void test_knee_spring_and_tibia_bending_are_one_direction(void)
{
    all_rigid();
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 1e-5f;
    limb.link[BRACE_TIBIA].bending_mm_per_n = 0.1f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.link[BRACE_TIBIA].tilt_rad = 0.1f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
    limb.link[BRACE_TIBIA].tilt_rad = -0.1f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 0.0f; /* tilted, but alone */
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.link[BRACE_FEMUR].moment_transfer = 1.0f; /* of a femur that does not bend */
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.base.z_mm_per_n = 1e-38f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
}

static void test_a_bending_femur_that_passes_moments_yields_in_two_directions(void)
{
    all_rigid();
    limb.link[BRACE_FEMUR].bending_mm_per_n = 0.1f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.link[BRACE_FEMUR].moment_transfer = 0.05f; /* however few */
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
}

/* Each subset of the plane's parts yields, with a tilted tibia and moments passed on or not: the limb is taken where C,
 * as docs/physics.md has it, has an inverse at some posture. */
static void test_a_limb_is_taken_where_c_has_an_inverse_at_some_posture(void)
{
    for (uint32_t subset = 0; subset < 2048u; subset++) {
        float is[11];
        for (uint32_t i = 0; i < 11u; i++) {
            is[i] = (float)(subset >> i & 1u);
        }
        all_rigid();
        limb.link[BRACE_FEMUR] = (brace_link_t){
            .axial_mm_per_n = 0.3f * is[0], .bending_mm_per_n = 0.4f * is[1], .moment_transfer = 0.8f * is[2]};
        limb.link[BRACE_TIBIA] =
            (brace_link_t){.axial_mm_per_n = 0.2f * is[3], .bending_mm_per_n = 0.5f * is[4], .tilt_rad = 0.3f * is[5]};
        limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 1e-5f * is[6];
        limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 2e-5f * is[7];
        limb.base = (brace_base_t){0.1f * is[8], 0.2f * is[9], 1e-5f * is[10]};
        bool has_inverse = false;
        for (int posture = 0; posture < 4; posture++) {
            const reference_planar_t r = reference_planar(&limb, 0.4 + 0.9 * posture, 0.7 + 0.5 * posture);
            const double trace = r.c_xx + r.c_zz;
            has_inverse = has_inverse || r.c_xx * r.c_zz - r.c_xz * r.c_xz > 1e-9 * trace * trace;
        }
        TEST_ASSERT_EQUAL(has_inverse ? BRACE_OK : BRACE_E_PARAMETER, brace_limb_check(&limb));
    }
}

static void test_a_coxa_without_moment_transfer_may_have_no_length(void)
{
    limb.coxa_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
    limb.link[BRACE_COXA].moment_transfer = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_limb_check(&limb));
    limb.coxa_mm = -1e-6f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_limb_check(&limb));
}

static void test_true_angle_adds_the_offset(void)
{
    limb.joint[BRACE_TIBIA].zero_offset_rad = -0.25f;
    TEST_ASSERT_EQUAL_FLOAT(0.75f, brace_limb_true_angle(&limb, BRACE_TIBIA, 1.0f));
    TEST_ASSERT_EQUAL_FLOAT(1.0f, brace_limb_true_angle(&limb, BRACE_FEMUR, 1.0f));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_limbs_that_exist);
    RUN_TEST(test_null);
    RUN_TEST(test_every_field_must_be_finite);
    RUN_TEST(test_every_field_has_an_upper_bound);
    RUN_TEST(test_bounds_are_inclusive_and_sharp);
    RUN_TEST(test_minus_zero_is_zero);
    RUN_TEST(test_something_must_yield_in_each_direction);
    RUN_TEST(test_knee_spring_and_tibia_bending_are_one_direction);
    RUN_TEST(test_a_bending_femur_that_passes_moments_yields_in_two_directions);
    RUN_TEST(test_a_limb_is_taken_where_c_has_an_inverse_at_some_posture);
    RUN_TEST(test_a_coxa_without_moment_transfer_may_have_no_length);
    RUN_TEST(test_true_angle_adds_the_offset);
    return UNITY_END();
}
