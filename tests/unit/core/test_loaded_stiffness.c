/* K under a load: the check values of docs/physics.md, which another program and an engine agree on; no load; what is
 * refused. tests/judges/engine judges random limbs. */
#include <math.h>
#include <string.h>

#include "brace/loaded.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

static brace_limb_t limb;
static brace_gravity_t weights;
static brace_load_t load;

void setUp(void)
{
    limb = sample_limb[SAMPLE_PAPER];
    limb.link[BRACE_FEMUR].moment_transfer = limb.link[BRACE_TIBIA].moment_transfer = 0.0f;
    memset(&weights, 0, sizeof weights);
    load = (brace_load_t){.down = {0.0f, -1.0f}};
}

void tearDown(void) {}

/* The same sums in the same order: the same bits. */
static void expect_the_same_in_two_steps(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                         brace_status_t status, const brace_loaded_stiffness_t *whole)
{
    brace_loaded_rest_t rest;
    brace_loaded_stiffness_t result;
    memcpy(&result, whole, sizeof result);
    result.stiffness.k_xx_n_per_mm = result.stiffness.k_zz_n_per_mm = 0.0f;
    brace_status_t in_steps = brace_loaded_settle(loaded, theta1_rad, theta2_rad, &load, &rest);
    if (in_steps == BRACE_OK) {
        in_steps = brace_loaded_stiffness_at(loaded, &rest, &result);
    }
    TEST_ASSERT_EQUAL(status, in_steps);
    if (status == BRACE_OK) {
        TEST_ASSERT_EQUAL_MEMORY(whole, &result, sizeof result);
    }
}

static brace_status_t status_at(float theta1_rad, float theta2_rad, brace_loaded_stiffness_t *result)
{
    brace_loaded_t loaded;
    brace_loaded_collapse(&limb, &weights, &loaded);
    const float hip = limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float knee = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    load.hip = (brace_loaded_joint_t){hip, hip};
    load.knee = (brace_loaded_joint_t){knee, knee};
    const brace_status_t status = brace_loaded_stiffness(&loaded, theta1_rad, theta2_rad, &load, result);
    expect_the_same_in_two_steps(&loaded, theta1_rad, theta2_rad, status, result);
    return status;
}

static brace_loaded_stiffness_t loaded_at(float theta1_rad, float theta2_rad)
{
    brace_loaded_stiffness_t result;
    memset(&result, 0, sizeof result);
    TEST_ASSERT_EQUAL(BRACE_OK, status_at(theta1_rad, theta2_rad, &result));
    return result;
}

/* tip displacement [mm] and K [N/mm] at a commanded posture under a force */
typedef struct {
    float theta1_rad, theta2_rad, x_n, z_n;
    double x_mm, z_mm, k_xx, k_xz, k_zz;
} known_t;

static void expect(const known_t *known, double k_off, double mm_off)
{
    load.tip = (brace_force_t){known->x_n, known->z_n};
    const brace_loaded_stiffness_t r = loaded_at(known->theta1_rad, known->theta2_rad);
    const double xx = (double)r.stiffness.k_xx_n_per_mm - known->k_xx;
    const double xz = (double)r.stiffness.k_xz_n_per_mm - known->k_xz;
    const double zz = (double)r.stiffness.k_zz_n_per_mm - known->k_zz;
    const double size = sqrt(known->k_xx * known->k_xx + 2.0 * known->k_xz * known->k_xz + known->k_zz * known->k_zz);
    TEST_ASSERT_DOUBLE_WITHIN(k_off, 0.0, sqrt(xx * xx + 2.0 * xz * xz + zz * zz) / size);
    TEST_ASSERT_DOUBLE_WITHIN(mm_off, known->x_mm, (double)r.displacement.x_mm);
    TEST_ASSERT_DOUBLE_WITHIN(mm_off, known->z_mm, (double)r.displacement.z_mm);
}

/* Two steps of Newton's method leave a hundredth of a millimetre where the tip moves by 60 mm; K sees its square. */
static void test_check_values_of_ellipsoids(void)
{
    static const known_t known[] = {
        {1.0f, 1.4f, 0.0f, 10.0f, 3.80735, 31.80811, 4.256242, -0.334349, 0.331800},
        {1.0f, 1.4f, 0.0f, -20.0f, -13.30591, -56.27056, 3.399383, -1.065312, 0.728438},
        {0.3f, 0.6f, 0.0f, 10.0f, 5.05100, 40.91618, 18.234468, -1.407903, 0.348259},
        {0.3f, 0.6f, -20.0f, 0.0f, -4.65112, -16.69184, 12.914473, -2.788440, 0.813156},
    };
    for (uint32_t i = 0; i < sizeof known / sizeof *known; i++) {
        expect(&known[i], 1e-5, 1e-2);
    }
}

/* The page's limb has 100 segments a link, which differ from a beam by 1e-4 of the bending. */
static void test_check_values_of_beams(void)
{
    static const known_t known[] = {
        {1.0f, 1.4f, 0.0f, 0.0f, 0.0, 0.0, 4.672129, -0.758153, 0.395809},
        {1.0f, 1.4f, 0.0f, 10.0f, 4.23079, 38.12313, 5.091304, -0.306721, 0.272640},
        {0.3f, 0.6f, 0.0f, 10.0f, 5.72214, 48.83450, 22.428601, -1.369207, 0.283982},
    };
    limb.link[BRACE_FEMUR].moment_transfer = limb.link[BRACE_TIBIA].moment_transfer = 1.0f;
    for (uint32_t i = 0; i < sizeof known / sizeof *known; i++) {
        expect(&known[i], 1e-4, 1e-2);
    }
}

static void test_no_load_is_the_linear_limb(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        limb = sample_limb[sample];
        for (int i = -9; i <= 9; i++) {
            for (int j = 1; j <= 9; j++) {
                const float theta1 = 0.3f * (float)i, theta2 = 0.3f * (float)j;
                const reference_planar_t r = reference_planar(&limb, (double)theta1, (double)theta2);
                const brace_loaded_stiffness_t k = loaded_at(theta1, theta2);
                /* as brace/general.h promises; the slender limb is flagged there too */
                const double limit = (k.stiffness.flags & BRACE_FLAG_NEAR_SINGULAR) != 0u ? 2e-4 : 4e-6;
                TEST_ASSERT_DOUBLE_WITHIN(limit, 0.0, reference_error(&r, &k.stiffness));
                TEST_ASSERT_FLOAT_WITHIN(1e-3f, 0.0f, k.displacement.x_mm); /* some roundings of the reach */
                TEST_ASSERT_FLOAT_WITHIN(1e-3f, 0.0f, k.displacement.z_mm);
                TEST_ASSERT_TRUE(isinf(k.buckling_factor));
            }
        }
    }
}

/* A straight limb of rigid links whose knee alone yields, pressed along itself by f: the knee's spring k carries the
 * turn q against f L, so it buckles at f = k / L, L the tibia's length. */
static void test_buckling_factor_of_one_hinge(void)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i] = (brace_link_t){.axial_mm_per_n = 1e-5f, .bending_mm_per_n = 1e-5f};
    }
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 0.0f;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 2e-5f;
    for (int i = 0; i < 6; i++) {
        const float factor = 1.5f + 1.3f * (float)i;
        load.tip.x_n = -1.0f / (2e-5f * limb.tibia_mm * factor);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, 1.0, (double)(loaded_at(0.0f, 0.0f).buckling_factor / factor));
    }
    load.tip.x_n = 50.0f; /* pulled: it stiffens */
    TEST_ASSERT_TRUE(isinf(loaded_at(0.0f, 0.0f).buckling_factor));
}

/* A joint whose angle is measured behind its spring stands where it is measured, and yields all the same. */
static void test_a_measured_angle_is_the_equilibrium(void)
{
    brace_loaded_stiffness_t measured;
    brace_loaded_t loaded;
    load.tip = (brace_force_t){-6.0f, 9.0f};
    const brace_loaded_stiffness_t commanded = loaded_at(1.0f, 1.4f);
    brace_loaded_collapse(&limb, &weights, &loaded);
    load.hip.yields_by_rad_per_n_mm = load.knee.yields_by_rad_per_n_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_stiffness(&loaded, 1.0f + commanded.hip_turn_rad,
                                                       1.4f - commanded.knee_turn_rad, &load, &measured));
    const float size = commanded.stiffness.lambda_max_n_per_mm;
    TEST_ASSERT_FLOAT_WITHIN(1e-5f * size, commanded.stiffness.k_xx_n_per_mm, measured.stiffness.k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f * size, commanded.stiffness.k_zz_n_per_mm, measured.stiffness.k_zz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f * commanded.buckling_factor, commanded.buckling_factor, measured.buckling_factor);
}

static void test_what_is_refused(void)
{
    brace_loaded_stiffness_t result;
    memset(&result, 0x5a, sizeof result);
    const brace_loaded_stiffness_t untouched = result;
    load.tip.x_n = NAN;
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, status_at(1.0f, 1.4f, &result));
    load.tip.x_n = 2e4f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, status_at(1.0f, 1.4f, &result));
    load.tip.x_n = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, status_at(9.0f, 0.0f, &result));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, status_at(NAN, 0.0f, &result));
    load.tip = (brace_force_t){-2000.0f, 0.0f}; /* far beyond what holds */
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_at(0.0f, 0.0f, &result));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &result, sizeof result);
}

/* Joints alone move a straight limb across itself only: along it nothing yields, and there is no K. */
static void test_a_straight_limb_of_rigid_links_has_no_K(void)
{
    brace_loaded_stiffness_t result, untouched;
    limb.link[BRACE_FEMUR] = limb.link[BRACE_TIBIA] = (brace_link_t){0};
    limb.base = (brace_base_t){0};
    memset(&result, 0x55, sizeof result);
    memcpy(&untouched, &result, sizeof result);
    for (int i = -3; i <= 3; i++) {
        TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, status_at(0.5f * (float)i, 0.0f, &result));
        TEST_ASSERT_EQUAL_MEMORY(&untouched.stiffness, &result.stiffness, sizeof result.stiffness);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, status_at(0.5f, 1.0f, &result));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_values_of_ellipsoids);
    RUN_TEST(test_check_values_of_beams);
    RUN_TEST(test_no_load_is_the_linear_limb);
    RUN_TEST(test_buckling_factor_of_one_hinge);
    RUN_TEST(test_a_measured_angle_is_the_equilibrium);
    RUN_TEST(test_a_straight_limb_of_rigid_links_has_no_K);
    RUN_TEST(test_what_is_refused);
    return UNITY_END();
}
