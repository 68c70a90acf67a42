#include <math.h>
#include <string.h>

#include "brace/chain.h"
#include "brace/planar.h"
#include "reference_planar.h"
#include "sample_limbs.h"
#include "unity.h"

#define PI 3.14159265358979324

/* What the header promises. */
#define ERROR_LIMIT 2e-6
#define AXIS_LIMIT_RAD 1e-6

static brace_planar_t planar;

void setUp(void)
{
    memset(&planar, 0, sizeof planar);
}

void tearDown(void) {}

static brace_stiffness_t stiffness_at(float theta1_rad, float theta2_rad)
{
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, theta1_rad, theta2_rad, &k));
    TEST_ASSERT_EQUAL(0, k.flags);
    return k;
}

static void expect_reference(const brace_limb_t *limb, float theta1_rad, float theta2_rad)
{
    const reference_planar_t r = reference_planar(limb, (double)theta1_rad, (double)theta2_rad);
    const brace_stiffness_t k = stiffness_at(theta1_rad, theta2_rad);
    TEST_ASSERT_DOUBLE_WITHIN(ERROR_LIMIT, 0.0, reference_error(&r, &k));
    TEST_ASSERT_DOUBLE_WITHIN(AXIS_LIMIT_RAD, 0.0, reference_axis_error(&r, &k));
    TEST_ASSERT_TRUE(fabsf(k.stiff_axis_rad) <= 1.5707964f);
}

static void test_check_value_of_the_physics_page(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[SAMPLE_PAPER], &planar));
    const brace_stiffness_t k = stiffness_at(1.0f, 1.4f);
    TEST_ASSERT_FLOAT_WITHIN(4e-6f, 3.96389818f, k.k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-6f, -0.63872477f, k.k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(4e-6f, 0.42806022f, k.k_zz_n_per_mm);
}

static void test_every_sample_over_the_workspace(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        const brace_limb_t *limb = &sample_limb[sample];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(limb, &planar));
        for (int i = -9; i <= 9; i++) {
            for (int j = -31; j <= 31; j++) {
                expect_reference(limb, (float)(i * PI / 9.0), (float)(j * PI / 31.0));
            }
        }
    }
}

static void test_close_to_straight_and_folded(void)
{
    for (int sample = 0; sample < SAMPLE_COUNT; sample++) {
        const brace_limb_t *limb = &sample_limb[sample];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(limb, &planar));
        for (float off = 1e-7f; off < 0.3f; off *= 2.3f) {
            expect_reference(limb, -2.0f, off);
            expect_reference(limb, 0.7f, -off);
            expect_reference(limb, 1.9f, (float)PI - off);
            expect_reference(limb, -0.2f, off - (float)PI);
        }
    }
}

/* Springs so soft that the links are needles beside them. */
static void test_soft_springs(void)
{
    for (int tilted = 0; tilted < 2; tilted++) {
        brace_limb_t limb = sample_limb[tilted ? SAMPLE_TILTED : SAMPLE_PAPER];
        limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 3e-3f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
        for (int j = -31; j <= 31; j++) {
            expect_reference(&limb, 0.3f, (float)(j * PI / 31.0));
        }
        for (float off = 1e-7f; off < 0.3f; off *= 2.3f) {
            expect_reference(&limb, -2.0f, off);
            expect_reference(&limb, 1.9f, (float)PI - off);
        }
    }
}

/* Springs and a tibia that hardly yield: cross, the harmonic whose square det C holds, has no zero, and rounding alone
 * decides on which side of a double root it is less its least value. */
static void test_limbs_whose_cross_has_no_zero(void)
{
    static const brace_limb_t limbs[] = {
        {57.0f,
         286.069397f,
         271.373871f,
         {SAMPLE_COXA,
          {0.0154404128f, 0.0323467851f, 0, 0, 0, 0.850912869f},
          {0.000203383577f, 0, 0.0543169826f, 0, 0, 0}},
         {{0, 0, 0}, {0, 0, 0}, {2.29014745e-8f, 0, 0}},
         {0, 0, 2.15120011e-8f},
         SAMPLE_TRUST},
        {57.0f,
         339.89267f,
         190.062073f,
         {SAMPLE_COXA, {0.000199050832f, 0, 0.290568858f, 0, 0, 0.0375759341f}, {0.00231902068f, 0, 0, 0, 0, 0}},
         {{0, 0, 0}, {1.02772839e-8f, 0, 0}, {2.26146938e-7f, 0, 0}},
         {0.099118337f, 0.099118337f, 9.43714713e-6f},
         SAMPLE_TRUST},
        {57.0f,
         112.32048f,
         269.501892f, /* cross is larger at the folded knee than at the straight one */
         {SAMPLE_COXA,
          {0.000739535782f, 0.000793574785f, 0.413384825f, 0, 0, 1.0f},
          {0.158013433f, 0.000146886756f, -0.472988665f, 0, 0, 0.13802582f}},
         {{0, 0, 0}, {0, 0, 0}, {3.51434246e-5f, 0, 0}},
         {0, 0, 0},
         SAMPLE_TRUST},
        {57.0f,
         76.062233f,
         76.062233f,
         {SAMPLE_COXA,
          {0.36697498f, 0.20090574f, -0.210052192f, 0, 0, 0},
          {0.000748627703f, 0.337607712f, 0.532165229f, 0, 0, 0}},
         {{0, 0, 0}, {2.96964827e-5f, 0, 0}, {8.24372546e-6f, 0, 0}},
         {0, 0, 0},
         SAMPLE_TRUST}};
    enum { LIMBS = sizeof limbs / sizeof *limbs };
    brace_limb_t limb;
    int taken = 0;
    for (int i = 0; i < 150 * LIMBS; i++) { /* these, and their neighbours, which round otherwise */
        limb = limbs[i % LIMBS];
        limb.femur_mm *= 1.0f + 1e-3f * (float)(i / LIMBS);
        if (brace_planar_collapse(&limb, &planar) != BRACE_OK) {
            continue; /* the general path serves it */
        }
        taken++;
        for (int j = 1; j <= 8; j++) {
            expect_reference(&limb, 0.4f * (float)(j - 4), 0.35f * (float)j);
        }
    }
    TEST_ASSERT_GREATER_THAN(100, taken);
}

/* Links whose softer way is turned by a right angle, or that yield along themselves alone: cross is a multiple of the
 * square of cos h, and vanishes at the folded knee only. What rounding leaves beside it is dropped. */
static void test_limbs_whose_cross_vanishes_at_the_folded_knee_alone(void)
{
    static const float right = 1.57079633f;
    static const struct {
        float femur_mm, tibia_mm;
        brace_link_t femur, tibia;
        float hip_rad_per_n_mm, base_mm_per_n;
    } row[] = {
        {277.37f, 284.38f, {8.21e-3f, 0.318f, -right, 0, 0, 0}, {0.382f, 0.301f, 0, 0, 0, 0}, 3.5e-5f, 3.9e-4f},
        {129.3708f, 123.8373f, {0, 1.236917e-3f, 0, 0, 0, 1.0f}, {2.198443e-4f, 0.2701192f, -right, 0, 0, 0}, 0, 0},
        {155.677f,
         101.1211f,
         {1.585603e-4f, 0.09022907f, -right, 0, 0, 0},
         {3.106798e-3f, 0, 0, 0, 0, 0},
         6.233817e-5f,
         0.08798388f},
        {178.3619f,
         178.3619f,
         {8.301299e-4f, 0, right, 0, 0, 1.0f},
         {6.222959e-4f, 0.2208137f, right, 0, 0, 0},
         2.194319e-5f,
         0.01736364f},
        {61.5889f,
         359.412f,
         {3.17069e-4f, 2.87292e-4f, 0, 0, 0, 0},
         {0.0117317f, 4.06091e-4f, 0, 0, 0, 0},
         2.84498e-6f,
         0}};
    for (uint32_t i = 0; i < 2u * sizeof row / sizeof *row; i++) {
        const uint32_t which = i / 2u;
        const float times = i % 2u == 0u ? 1.0f : 256.0f; /* the same limb, far softer */
        const float base_mm_per_n = times * row[which].base_mm_per_n;
        brace_limb_t limb = sample_limb[SAMPLE_PAPER];
        limb.femur_mm = row[which].femur_mm;
        limb.tibia_mm = row[which].tibia_mm;
        limb.link[BRACE_FEMUR] = row[which].femur;
        limb.link[BRACE_TIBIA] = row[which].tibia;
        for (int link = BRACE_FEMUR; link <= BRACE_TIBIA; link++) {
            limb.link[link].axial_mm_per_n *= times;
            limb.link[link].bending_mm_per_n *= times;
        }
        limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = times * row[which].hip_rad_per_n_mm;
        limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 0.0f;
        limb.base = (brace_base_t){base_mm_per_n, base_mm_per_n, 0};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
        for (int j = -31; j <= 31; j++) {
            expect_reference(&limb, 0.3f, (float)(j * PI / 31.0));
        }
    }
}

static void test_a_base_that_yields_equally_is_in_it(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_TILTED];
    limb.base = (brace_base_t){0.02f, 0.02f, 4e-6f};
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
    for (int j = -6; j <= 6; j++) {
        expect_reference(&limb, 0.3f, (float)j * 0.5f);
    }
}

static void test_a_round_compliance_has_some_axis_and_finite_numbers(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_ROUND];
    limb.link[BRACE_TIBIA].tilt_rad = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&limb, &planar));
    for (int j = -10; j <= 10; j++) {
        const brace_stiffness_t k = stiffness_at(0.3f * (float)j, 0.29f * (float)j);
        TEST_ASSERT_TRUE(fabsf(k.stiff_axis_rad) <= 1.5707964f);
        TEST_ASSERT_FLOAT_WITHIN(1.4e-5f, 1.0f / 0.15f, k.lambda_min_n_per_mm);
        TEST_ASSERT_FLOAT_WITHIN(1.4e-5f, 1.0f / 0.15f, k.lambda_max_n_per_mm);
        TEST_ASSERT_FLOAT_WITHIN(1.4e-5f, 0.0f, k.k_xz_n_per_mm);
    }
}

/* The limb turned as a whole turns K: eigenvalues stay, the axis goes along. To two roundings of the angle. */
static void test_turning_the_limb_turns_k(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[SAMPLE_TILTED], &planar));
    const brace_stiffness_t at_zero = stiffness_at(0.0f, 1.2f);
    for (int i = -12; i <= 12; i++) {
        const float turn = 0.25f * (float)i;
        const brace_stiffness_t k = stiffness_at(turn, 1.2f);
        const double off = (double)k.stiff_axis_rad - (double)at_zero.stiff_axis_rad - (double)turn;
        TEST_ASSERT_DOUBLE_WITHIN(2.0 * AXIS_LIMIT_RAD, 0.0, off - PI * floor(off / PI + 0.5));
        TEST_ASSERT_FLOAT_WITHIN(1e-6f * at_zero.lambda_max_n_per_mm, at_zero.lambda_max_n_per_mm,
                                 k.lambda_max_n_per_mm);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f * at_zero.lambda_min_n_per_mm, at_zero.lambda_min_n_per_mm,
                                 k.lambda_min_n_per_mm);
    }
}

static void test_whole_turns_of_the_femur_change_nothing(void)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[SAMPLE_BEAM], &planar));
    const brace_stiffness_t near = stiffness_at(-1.0f, 0.8f), far = stiffness_at(-1.0f + 6.2831853f, 0.8f);
    TEST_ASSERT_FLOAT_WITHIN(3e-6f * near.lambda_max_n_per_mm, near.k_xz_n_per_mm, far.k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(3e-6f * near.lambda_max_n_per_mm, near.k_xx_n_per_mm, far.k_xx_n_per_mm);
}

static void test_reach_is_sharp_and_refusal_leaves_the_output_alone(void)
{
    brace_stiffness_t k, before;
    memset(&k, 0x5a, sizeof k);
    before = k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&sample_limb[SAMPLE_PAPER], &planar));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_planar_stiffness(&planar, 0.0f, 5.568f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_planar_stiffness(&planar, -4.0f, 4.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_planar_stiffness(&planar, 1e9f, 0.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_planar_stiffness(&planar, NAN, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_planar_stiffness(&planar, 1.0f, NAN, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_planar_stiffness(&planar, INFINITY, 1.0f, &k));
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_planar_stiffness(&planar, 1.0f, -INFINITY, &k));
    TEST_ASSERT_EQUAL_MEMORY(&before, &k, sizeof k);
    expect_reference(&sample_limb[SAMPLE_PAPER], 0.0f, 5.567f);
    expect_reference(&sample_limb[SAMPLE_PAPER], -5.567f, 0.0f);
    expect_reference(&sample_limb[SAMPLE_PAPER], 3.9f, -3.9f);
}

static void refused(const brace_limb_t *limb, brace_status_t status)
{
    memset(&planar, 0x5a, sizeof planar);
    const brace_planar_t before = planar;
    TEST_ASSERT_EQUAL(status, brace_planar_collapse(limb, &planar));
    TEST_ASSERT_EQUAL_MEMORY(&before, &planar, sizeof planar);
}

static void test_what_only_the_general_path_can_serve_is_refused(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    limb.base.x_mm_per_n = 0.01f;
    refused(&limb, BRACE_E_UNSUPPORTED);
    limb = sample_limb[SAMPLE_PAPER];
    memset(limb.link, 0, sizeof limb.link); /* springs only: singular when straight */
    refused(&limb, BRACE_E_UNSUPPORTED);
    limb.tibia_mm = limb.femur_mm; /* the hip's alone: nothing yields when folded */
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 0.0f;
    refused(&limb, BRACE_E_UNSUPPORTED);
    limb = sample_limb[SAMPLE_EQUAL]; /* nearly nothing yields when folded: the mean loses its digits there */
    limb.link[BRACE_FEMUR] = (brace_link_t){0.0212f, 0.045f, 0.0f, 0, 0, 1.0f};
    limb.link[BRACE_TIBIA] = (brace_link_t){1.0e-4f, 0.00135f, 0.0f, 0, 0, 0};
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 2e-5f;
    refused(&limb, BRACE_E_UNSUPPORTED);
    limb = sample_limb[SAMPLE_SLENDER]; /* tilted needles: C is nearly singular where their directions meet */
    limb.link[BRACE_FEMUR].axial_mm_per_n = limb.link[BRACE_TIBIA].axial_mm_per_n = 1e-6f;
    refused(&limb, BRACE_E_UNSUPPORTED);
    limb = sample_limb[SAMPLE_PAPER]; /* no springs: the mean hardly swings, what is left of det swings more */
    limb.link[BRACE_FEMUR] = (brace_link_t){3.6e-4f, 4.2e-6f, 0.0f, 0, 0, 4.5e-4f};
    limb.link[BRACE_TIBIA] = (brace_link_t){0.66f, 0.0f, 0.0f, 0, 0, 0};
    limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = 0.0f;
    refused(&limb, BRACE_E_UNSUPPORTED);
}

static void test_what_is_no_limb_is_refused(void)
{
    brace_limb_t limb = sample_limb[SAMPLE_PAPER];
    refused(NULL, BRACE_E_NULL);
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_planar_collapse(&limb, NULL));
    limb.link[BRACE_FEMUR].bending_mm_per_n = NAN;
    refused(&limb, BRACE_E_PARAMETER);
    limb = sample_limb[SAMPLE_PAPER];
    limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm = -1e-5f;
    refused(&limb, BRACE_E_PARAMETER);
    limb = sample_limb[SAMPLE_PAPER];
    limb.link[BRACE_TIBIA].bending_mm_per_n = -2.6f; /* pushes back, folded more than all else yields */
    refused(&limb, BRACE_E_PARAMETER);
    limb = sample_limb[SAMPLE_PAPER];
    limb.femur_mm = INFINITY;
    refused(&limb, BRACE_E_PARAMETER);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_check_value_of_the_physics_page);
    RUN_TEST(test_every_sample_over_the_workspace);
    RUN_TEST(test_close_to_straight_and_folded);
    RUN_TEST(test_soft_springs);
    RUN_TEST(test_limbs_whose_cross_has_no_zero);
    RUN_TEST(test_limbs_whose_cross_vanishes_at_the_folded_knee_alone);
    RUN_TEST(test_a_base_that_yields_equally_is_in_it);
    RUN_TEST(test_a_round_compliance_has_some_axis_and_finite_numbers);
    RUN_TEST(test_turning_the_limb_turns_k);
    RUN_TEST(test_whole_turns_of_the_femur_change_nothing);
    RUN_TEST(test_reach_is_sharp_and_refusal_leaves_the_output_alone);
    RUN_TEST(test_what_only_the_general_path_can_serve_is_refused);
    RUN_TEST(test_what_is_no_limb_is_refused);
    return UNITY_END();
}
