#include <math.h>
#include <string.h>

#include "brace/spatial.h"
#include "reference_planar.h"
#include "reference_spatial.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324
#define ERROR_LIMIT 4e-6 /* what the header says; 1e-5 is promised */

static brace_spatial_t spatial;

static void collapse(const brace_limb_t *limb)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_spatial_collapse(limb, &spatial));
}

static brace_stiffness_spatial_t stiffness_at(float theta0, float theta1, float theta2)
{
    brace_stiffness_spatial_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_spatial_stiffness(&spatial, theta0, theta1, theta2, &k));
    return k;
}

static void matrix_of(const brace_stiffness_spatial_t *k, double m[3][3])
{
    m[0][0] = (double)k->k_xx_n_per_mm;
    m[1][1] = (double)k->k_yy_n_per_mm;
    m[2][2] = (double)k->k_zz_n_per_mm;
    m[0][1] = m[1][0] = (double)k->k_xy_n_per_mm;
    m[0][2] = m[2][0] = (double)k->k_xz_n_per_mm;
    m[1][2] = m[2][1] = (double)k->k_yz_n_per_mm;
}

/* K entry by entry; the eigenvalues by their sum, the sum of their inverses and their product; the axis as an
 * eigenvector of the largest. */
static void assert_right(const brace_limb_t *limb, float theta0, float theta1, float theta2)
{
    const brace_stiffness_spatial_t k = stiffness_at(theta0, theta1, theta2);
    const reference_spatial_t r = reference_spatial(limb, (double)theta0, (double)theta1, (double)theta2);
    const double low = (double)k.lambda_n_per_mm[0], middle = (double)k.lambda_n_per_mm[1];
    const double most = (double)k.lambda_n_per_mm[2];
    double m[3][3];
    matrix_of(&k, m);
    for (int i = 0; i < 3; i++) {
        double off = -most * (double)k.stiff_axis[i];
        for (int j = 0; j < 3; j++) {
            TEST_ASSERT_TRUE(fabs(m[i][j] - r.k[i][j]) < ERROR_LIMIT * most);
            off += r.k[i][j] * (double)k.stiff_axis[j];
        }
        TEST_ASSERT_TRUE(fabs(off) < ERROR_LIMIT * most);
    }
    TEST_ASSERT_TRUE(cos((double)theta0) * (double)k.stiff_axis[0] + sin((double)theta0) * (double)k.stiff_axis[1] >
                     -1e-6);
    TEST_ASSERT_TRUE(low > 0.0 && low <= middle && middle <= most);
    TEST_ASSERT_TRUE(fabs((low + middle + most) / (r.k[0][0] + r.k[1][1] + r.k[2][2]) - 1.0) < ERROR_LIMIT);
    TEST_ASSERT_TRUE(fabs((1 / low + 1 / middle + 1 / most) / (r.c[0][0] + r.c[1][1] + r.c[2][2]) - 1.0) < ERROR_LIMIT);
    TEST_ASSERT_TRUE(fabs(low * middle * most * r.det_c - 1.0) < 2.0 * ERROR_LIMIT);
    const double length = (double)(k.stiff_axis[0] * k.stiff_axis[0] + k.stiff_axis[1] * k.stiff_axis[1] +
                                   k.stiff_axis[2] * k.stiff_axis[2]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, length);
}

void setUp(void) {}

void tearDown(void) {}

static void test_every_sample_over_the_workspace(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        collapse(&sample_limb[sample]);
        for (int i = -6; i <= 6; i++) {
            for (int j = -12; j <= 12; j++) {
                assert_right(&sample_limb[sample], 0.37f * (float)(j % 9), (float)(PI * i / 6.0),
                             (float)(PI * j / 12.0));
            }
        }
    }
}

static void test_a_base_that_yields_unequally(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_TILTED];
    limb.base.x_mm_per_n = 0.03f;
    limb.base.z_mm_per_n = 0.002f;
    for (int with_coxa = 0; with_coxa < 2; with_coxa++) {
        collapse(&limb);
        for (int i = -10; i <= 10; i++) {
            assert_right(&limb, 0.5f, 0.3f * (float)i, 0.3f * (float)(10 - i) - 1.0f);
        }
        limb.link[BRACE_COXA] = (brace_link_t){0.0f, 0.0f, 0.0f, 0.01f, 0.0f, 0.0f};
    }
}

static void test_close_to_straight_and_folded(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        collapse(&sample_limb[sample]);
        for (float off = 1e-7f; off < 0.3f; off *= 4.0f) {
            assert_right(&sample_limb[sample], 0.2f, 0.4f, off);
            assert_right(&sample_limb[sample], 0.2f, 0.4f, (float)PI - off);
        }
    }
}

static void test_planar_is_spatial_in_its_plane_with_a_rigid_coxa(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        brace_limb_t limb = sample_limb[sample];
        limb.link[BRACE_COXA] = (brace_link_t){0};
        collapse(&limb);
        const brace_stiffness_spatial_t k = stiffness_at(0.0f, 0.8f, 1.3f);
        const reference_planar_t r = reference_planar(&limb, (double)0.8f, (double)1.3f);
        TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * r.lambda_max, r.k_xx, (double)k.k_xx_n_per_mm);
        TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * r.lambda_max, r.k_xz, (double)k.k_xz_n_per_mm);
        TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * r.lambda_max, r.k_zz, (double)k.k_zz_n_per_mm);
        TEST_ASSERT_TRUE(k.k_xy_n_per_mm == 0.0f && k.k_yz_n_per_mm == 0.0f);
    }
}

static void test_yaw_turns_k_and_leaves_the_eigenvalues(void)
{
    collapse(&sample_limb[SAMPLE_BEAM]);
    const brace_stiffness_spatial_t flat = stiffness_at(0.0f, 0.8f, 1.3f);
    double m[3][3], turned[3][3];
    matrix_of(&flat, m);
    for (int i = -5; i <= 5; i++) {
        const float yaw = 0.7f * (float)i;
        const double c = cos((double)yaw), s = sin((double)yaw), turn[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
        const brace_stiffness_spatial_t k = stiffness_at(yaw, 0.8f, 1.3f);
        matrix_of(&k, turned);
        TEST_ASSERT_EQUAL_MEMORY(flat.lambda_n_per_mm, k.lambda_n_per_mm, sizeof k.lambda_n_per_mm);
        for (int p = 0; p < 9; p++) {
            double sum = 0.0;
            for (int q = 0; q < 9; q++) {
                sum += turn[p / 3][q / 3] * m[q / 3][q % 3] * turn[p % 3][q % 3];
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-6 * (double)k.lambda_n_per_mm[2], sum, turned[p / 3][p % 3]);
        }
    }
}

static void test_axis_across_the_plane_when_that_is_stiffest(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_ROUND];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i].lateral_mm_per_n = 1e-4f;
    }
    collapse(&limb);
    const brace_stiffness_spatial_t k = stiffness_at(0.5f, 0.8f, 1.3f);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, -sinf(0.5f), k.stiff_axis[0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, cosf(0.5f), k.stiff_axis[1]);
    TEST_ASSERT_TRUE(k.stiff_axis[2] == 0.0f);
    assert_right(&limb, 0.5f, 0.8f, 1.3f);
}

static void assert_refused(brace_status_t status, float theta0, float theta1, float theta2)
{
    brace_stiffness_spatial_t k, untouched;
    memset(&k, 0x5a, sizeof k);
    untouched = k;
    TEST_ASSERT_EQUAL(status, brace_spatial_stiffness(&spatial, theta0, theta1, theta2, &k));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &k, sizeof k);
}

static void test_angles_that_are_none_are_refused_and_nothing_touched(void)
{
    collapse(&sample_limb[SAMPLE_PAPER]);
    for (int i = 0; i < 3; i++) {
        const float bad[3] = {i == 0, i == 1, i == 2};
        const float wide = 8.0f, none = NAN, infinite = INFINITY;
        assert_refused(BRACE_E_RANGE, wide * bad[0], -wide * bad[1], wide * bad[2]);
        assert_refused(BRACE_E_NOT_FINITE, i == 0 ? none : 1, i == 1 ? none : 1, i == 2 ? none : 1);
        assert_refused(BRACE_E_NOT_FINITE, i == 0 ? infinite : 1, i == 1 ? -infinite : 1, i == 2 ? infinite : 1);
    }
    (void)stiffness_at(7.9f, -7.9f, 7.9f);
}

static void test_rigid_limbs_are_refused(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    limb.joint[BRACE_COXA].compliance_rad_per_n_mm = 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i].lateral_mm_per_n = limb.link[i].torsion_rad_per_n_mm = 0.0f;
    }
    collapse(&limb);
    assert_refused(BRACE_E_SINGULAR, 0.1f, 0.2f, 0.3f);
}

static void test_null_is_refused(void)
{
    brace_stiffness_spatial_t k;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_stiffness(NULL, 0.0f, 0.0f, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_stiffness(&spatial, 0.0f, 0.0f, 0.0f, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_collapse(&sample_limb[0], NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_collapse(NULL, &spatial));
    brace_stiffness_t plane = {0};
    float across;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_in_plane(NULL, 0.0f, 1.0f, &plane, &across));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_in_plane(&spatial, 0.0f, 1.0f, NULL, &across));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_in_plane(&spatial, 0.0f, 1.0f, &plane, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_turn(0.0f, NULL, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_spatial_turn(0.0f, &plane, 1.0f, NULL));
}

static void test_bad_limbs_are_refused_and_nothing_touched(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    brace_spatial_t before;
    memset(&spatial, 0x5a, sizeof spatial);
    before = spatial;
    limb.tibia_mm = INFINITY;
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_spatial_collapse(&limb, &spatial));
    limb.tibia_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_spatial_collapse(&limb, &spatial));
    TEST_ASSERT_EQUAL_MEMORY(&before, &spatial, sizeof spatial);
}

static void test_slender_postures_are_flagged(void)
{
    const float parallel = -0.7f; /* the two softest directions fall together: the tilts differ by as much */
    brace_limb_t limb = sample_limb[SAMPLE_SLENDER];
    limb.link[BRACE_COXA] = (brace_link_t){0.0f, 0.0f, 0.0f, 0.005f, 0.0f, 0.0f};
    collapse(&limb);
    TEST_ASSERT_EQUAL(0, stiffness_at(0.0f, 0.0f, parallel).flags);
    limb.link[BRACE_FEMUR].axial_mm_per_n = limb.link[BRACE_TIBIA].axial_mm_per_n = 4e-6f;
    collapse(&limb);
    TEST_ASSERT_EQUAL(0, stiffness_at(0.0f, 0.0f, parallel).flags);
    assert_right(&limb, 0.0f, 0.0f, parallel);
    limb.link[BRACE_FEMUR].axial_mm_per_n = limb.link[BRACE_TIBIA].axial_mm_per_n = 1e-7f;
    collapse(&limb);
    TEST_ASSERT_EQUAL(BRACE_FLAG_NEAR_SINGULAR, stiffness_at(0.0f, 0.0f, parallel).flags);
    TEST_ASSERT_EQUAL(0, stiffness_at(0.0f, 0.0f, 1.0f).flags);
}

/* The coxa stands still in the plane: it adds what it would add alone, whatever the knee does, and with moment transfer
 * what physics.md says of a cantilever whose far end carries force and moment. */
static void test_the_coxa_adds_its_cantilever_in_the_plane(void)
{
    const brace_limb_t limb = sample_limb[SAMPLE_BEAM];
    const brace_link_t *coxa = &limb.link[BRACE_COXA];
    const double theta1 = 0.7, theta2 = 1.1, kappa = (double)coxa->moment_transfer;
    const double b = (double)coxa->bending_mm_per_n, length = (double)limb.coxa_mm;
    const double px = 185.0 * cos(theta1) + 313.5 * cos(theta1 - theta2);
    const double pz = 185.0 * sin(theta1) + 313.5 * sin(theta1 - theta2);
    reference_planar_t r = reference_planar(&limb, theta1, theta2);
    reference_ellipsoid(&r, coxa, 0.0);
    const double nx = -sin((double)coxa->tilt_rad), nz = cos((double)coxa->tilt_rad);
    reference_add(&r, 3.0 * b * kappa / length, nx, nz, -pz, px);
    reference_add(&r, 3.0 * b * kappa / (length * length), -pz, px, -pz, px);
    const double det = r.c_xx * r.c_zz - r.c_xz * r.c_xz;

    brace_stiffness_t plane;
    float across;
    collapse(&limb);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_spatial_in_plane(&spatial, (float)theta1, (float)theta2, &plane, &across));
    const double most = (double)plane.lambda_max_n_per_mm;
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * most, r.c_zz / det, (double)plane.k_xx_n_per_mm);
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * most, -r.c_xz / det, (double)plane.k_xz_n_per_mm);
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT * most, r.c_xx / det, (double)plane.k_zz_n_per_mm);
}

static void test_springs_of_the_moment(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_TILTED];
    collapse(&limb);
    brace_spatial_t softened = spatial;
    limb.joint[BRACE_COXA].compliance_rad_per_n_mm = 2.5e-5f;
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 1.75e-5f;
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 3.5e-5f;
    brace_spatial_set_springs(&softened, 2.5e-5f, 1.75e-5f + limb.base.rotation_rad_per_n_mm, 3.5e-5f);
    spatial = softened;
    for (int i = -5; i <= 5; i++) {
        assert_right(&limb, 0.3f * (float)i, 0.4f, 0.25f * (float)i + 0.1f);
    }
}

/* Nothing yields across: the plane has its K, and K in space does not exist. */
static void test_nothing_that_yields_across_leaves_the_plane(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    limb.joint[BRACE_COXA].compliance_rad_per_n_mm = 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb.link[i].lateral_mm_per_n = limb.link[i].torsion_rad_per_n_mm = 0.0f;
    }
    limb.link[BRACE_COXA] = (brace_link_t){0};
    collapse(&limb);
    brace_stiffness_t plane;
    float across = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_spatial_in_plane(&spatial, 0.8f, 1.3f, &plane, &across));
    TEST_ASSERT_TRUE(isnan(across));
    const reference_planar_t r = reference_planar(&limb, (double)0.8f, (double)1.3f);
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT, 0.0, reference_error(&r, &plane));
    brace_stiffness_spatial_t k, before;
    memset(&k, 0x5a, sizeof k);
    before = k;
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, brace_spatial_turn(0.3f, &plane, across, &k));
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
}

/* While gaps are open a part is singular: the plane's block carries along one line only, or nothing goes across. */
static void test_singular_parts_are_carried_round_too(void)
{
    const float along = 0.6f, yaw = 0.9f, k_along = 7.0f;
    const float u[3] = {cosf(along) * cosf(yaw), cosf(along) * sinf(yaw), sinf(along)};
    const brace_stiffness_t plane = {k_along * cosf(along) * cosf(along),
                                     k_along * cosf(along) * sinf(along),
                                     k_along * sinf(along) * sinf(along),
                                     0.0f,
                                     k_along,
                                     along,
                                     BRACE_FLAG_GAP_OPEN};
    brace_stiffness_spatial_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_spatial_turn(yaw, &plane, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_FLAG_GAP_OPEN, k.flags);
    double m[3][3];
    matrix_of(&k, m);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, u[i], k.stiff_axis[i]);
        for (int j = 0; j < 3; j++) {
            TEST_ASSERT_DOUBLE_WITHIN(5e-6, (double)(k_along * u[i] * u[j]), m[i][j]);
        }
    }
    TEST_ASSERT_TRUE(k.lambda_n_per_mm[0] == 0.0f && k.lambda_n_per_mm[1] == 0.0f && k.lambda_n_per_mm[2] == k_along);

    TEST_ASSERT_EQUAL(BRACE_OK, brace_spatial_turn(yaw, &plane, 9.0f, &k));
    TEST_ASSERT_TRUE(k.lambda_n_per_mm[0] == 0.0f && k.lambda_n_per_mm[1] == k_along && k.lambda_n_per_mm[2] == 9.0f);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, -sinf(yaw), k.stiff_axis[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_over_the_workspace);
    RUN_TEST(test_a_base_that_yields_unequally);
    RUN_TEST(test_close_to_straight_and_folded);
    RUN_TEST(test_planar_is_spatial_in_its_plane_with_a_rigid_coxa);
    RUN_TEST(test_yaw_turns_k_and_leaves_the_eigenvalues);
    RUN_TEST(test_axis_across_the_plane_when_that_is_stiffest);
    RUN_TEST(test_angles_that_are_none_are_refused_and_nothing_touched);
    RUN_TEST(test_rigid_limbs_are_refused);
    RUN_TEST(test_null_is_refused);
    RUN_TEST(test_bad_limbs_are_refused_and_nothing_touched);
    RUN_TEST(test_slender_postures_are_flagged);
    RUN_TEST(test_the_coxa_adds_its_cantilever_in_the_plane);
    RUN_TEST(test_springs_of_the_moment);
    RUN_TEST(test_nothing_that_yields_across_leaves_the_plane);
    RUN_TEST(test_singular_parts_are_carried_round_too);
    return UNITY_END();
}
