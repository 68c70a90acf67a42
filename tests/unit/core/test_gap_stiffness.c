/* K with a joint free, against a joint made a hundred times softer, and the rank-one formula in double. */
#include <string.h>

#include "brace/chain.h"
#include "brace/gap_stiffness.h"
#include "close.h"
#include "sample_limbs.h"

static const float postures[][2] = {{1.0f, 1.4f}, {0.3f, 0.6f}, {-0.4f, 2.2f}, {0.9f, -1.1f}, {0.2f, 2.8f}};
enum { POSTURES = sizeof postures / sizeof postures[0] };

void setUp(void) {}
void tearDown(void) {}

static brace_stiffness_t stiffness_of(const brace_limb_t *limb, const float *theta)
{
    brace_chain_t chain;
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_chain_build(limb, &chain));
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_chain_stiffness(&chain, theta[0], theta[1], &k));
    return k;
}

static brace_pose_t pose_of(const brace_limb_t *limb, const float *theta)
{
    brace_pose_t pose;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_kinematics_forward(limb, theta[0], theta[1], &pose));
    return pose;
}

/* K - (K p)(K p)' / (p' K p), in double, of the entries as they are. */
static void the_rank_one_formula_is_met(void)
{
    const brace_limb_t *limb = &sample_limb[SAMPLE_PAPER];
    for (int i = 0; i < POSTURES; i++) {
        const brace_stiffness_t k = stiffness_of(limb, postures[i]);
        const brace_pose_t pose = pose_of(limb, postures[i]);
        for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
            const brace_point_t p = joint == BRACE_FEMUR ? pose.lever_femur : pose.lever_tibia;
            const double kx = (double)k.k_xx_n_per_mm * (double)p.x_mm + (double)k.k_xz_n_per_mm * (double)p.z_mm;
            const double kz = (double)k.k_xz_n_per_mm * (double)p.x_mm + (double)k.k_zz_n_per_mm * (double)p.z_mm;
            const double pkp = kx * (double)p.x_mm + kz * (double)p.z_mm;
            brace_gap_stiffness_t gap;
            TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, 1u << joint, &gap));
            /* entries of K are good to 2e-6 of lambda_max, the difference to a few of those */
            const double tolerance = 3e-5 * (double)k.lambda_max_n_per_mm;
            ASSERT_CLOSE((double)k.k_xx_n_per_mm - kx * kx / pkp, gap.now.k_xx_n_per_mm, tolerance);
            ASSERT_CLOSE((double)k.k_xz_n_per_mm - kx * kz / pkp, gap.now.k_xz_n_per_mm, tolerance);
            ASSERT_CLOSE((double)k.k_zz_n_per_mm - kz * kz / pkp, gap.now.k_zz_n_per_mm, tolerance);
        }
    }
}

/* The tip turned about the free joint meets no force; what is left is the eigenform reported; flags and bounds. */
static void nothing_is_carried_about_the_free_joint(void)
{
    for (int s = 0; s < SAMPLE_SLENDER; s++) {
        for (int i = 0; i < POSTURES; i++) {
            const brace_stiffness_t k = stiffness_of(&sample_limb[s], postures[i]);
            const brace_pose_t pose = pose_of(&sample_limb[s], postures[i]);
            brace_gap_stiffness_t gap;
            TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, BRACE_GAP_TIBIA, &gap));
            const brace_stiffness_t *now = &gap.now;
            const double x = (double)pose.lever_tibia.x_mm, z = (double)pose.lever_tibia.z_mm;
            const double scale = 1e-6 * (double)now->lambda_max_n_per_mm * hypot(x, z);
            ASSERT_CLOSE(0.0, (double)now->k_xx_n_per_mm * x + (double)now->k_xz_n_per_mm * z, scale);
            ASSERT_CLOSE(0.0, (double)now->k_xz_n_per_mm * x + (double)now->k_zz_n_per_mm * z, scale);
            ASSERT_CLOSE(now->lambda_max_n_per_mm, now->k_xx_n_per_mm + now->k_zz_n_per_mm,
                         1e-6 * (double)now->lambda_max_n_per_mm);
            ASSERT_CLOSE((double)now->lambda_max_n_per_mm * sin(2.0 * (double)now->stiff_axis_rad),
                         2.0 * (double)now->k_xz_n_per_mm, 2e-6 * (double)now->lambda_max_n_per_mm);
            TEST_ASSERT_TRUE(now->lambda_min_n_per_mm == 0.0f);
            TEST_ASSERT_TRUE(now->flags & BRACE_FLAG_GAP_OPEN);
            TEST_ASSERT_FALSE(gap.engaged.flags & BRACE_FLAG_GAP_OPEN);
            /* engaged - now is positive semi-definite: the bounds are in order */
            const double xx = (double)k.k_xx_n_per_mm - (double)now->k_xx_n_per_mm;
            const double xz = (double)k.k_xz_n_per_mm - (double)now->k_xz_n_per_mm;
            const double zz = (double)k.k_zz_n_per_mm - (double)now->k_zz_n_per_mm;
            const double slack = 1e-5 * (double)k.lambda_max_n_per_mm;
            TEST_ASSERT_TRUE(xx > -slack && zz > -slack);
            TEST_ASSERT_TRUE(0.5 * (xx + zz) - sqrt(0.25 * (xx - zz) * (xx - zz) + xz * xz) > -slack);
        }
    }
}

/* A limb with the joint's compliance at its largest tends to the limb with the joint free. */
static void it_is_the_limit_of_a_soft_joint(void)
{
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        brace_limb_t soft = sample_limb[SAMPLE_PAPER];
        soft.joint[joint].compliance_rad_per_n_mm = 2e-3f;
        for (int i = 0; i < POSTURES; i++) {
            const brace_stiffness_t k = stiffness_of(&sample_limb[SAMPLE_PAPER], postures[i]);
            const brace_stiffness_t limit = stiffness_of(&soft, postures[i]);
            const brace_pose_t pose = pose_of(&soft, postures[i]);
            brace_gap_stiffness_t gap;
            brace_gap_stiffness_known(&k, &pose, 1u << joint, &gap);
            const brace_point_t p = joint == BRACE_FEMUR ? pose.lever_femur : pose.lever_tibia;
            const double kx = (double)k.k_xx_n_per_mm * (double)p.x_mm + (double)k.k_xz_n_per_mm * (double)p.z_mm;
            const double kz = (double)k.k_xz_n_per_mm * (double)p.x_mm + (double)k.k_zz_n_per_mm * (double)p.z_mm;
            const double pkp = kx * (double)p.x_mm + kz * (double)p.z_mm;
            /* what the soft joint still carries: (K p)(K p)' / (p' K p) / (1 + added p' K p) */
            const double left = (kx * kx + kz * kz) / pkp / (1.0 + 2e-3 * pkp);
            const double tolerance = 1.05 * left + 1e-4 * (double)k.lambda_max_n_per_mm;
            TEST_ASSERT_TRUE(tolerance < 0.2 * (double)k.lambda_max_n_per_mm);
            ASSERT_CLOSE(limit.k_xx_n_per_mm, gap.now.k_xx_n_per_mm, tolerance);
            ASSERT_CLOSE(limit.k_xz_n_per_mm, gap.now.k_xz_n_per_mm, tolerance);
            ASSERT_CLOSE(limit.k_zz_n_per_mm, gap.now.k_zz_n_per_mm, tolerance);
        }
    }
}

/* An axis has no direction: of its two ends that with x >= 0 is reported, and straight up of those with x = 0. */
static void the_axis_of_what_is_carried_points_outwards(void)
{
    const brace_stiffness_t k = stiffness_of(&sample_limb[SAMPLE_PAPER], postures[0]);
    brace_pose_t pose = pose_of(&sample_limb[SAMPLE_PAPER], postures[0]);
    for (int i = 1; i <= 400; i++) {
        const float size_mm = 0.737f * (float)i * (i % 2 == 0 ? 1.0f : -1.0f);
        brace_gap_stiffness_t gap;
        pose.lever_femur = (brace_point_t){size_mm, 0.0f}; /* what is carried lies across it */
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, BRACE_GAP_FEMUR, &gap));
        ASSERT_CLOSE(1.5707963, gap.now.stiff_axis_rad, 1e-6);
        pose.lever_femur = (brace_point_t){0.3f * size_mm, 0.4f * size_mm};
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, BRACE_GAP_FEMUR, &gap));
        ASSERT_CLOSE(atan(-0.75), gap.now.stiff_axis_rad, 1e-6);
    }
}

static void both_free_carry_nothing_and_none_free_changes_nothing(void)
{
    const brace_limb_t *limb = &sample_limb[SAMPLE_PAPER];
    const brace_stiffness_t k = stiffness_of(limb, postures[0]);
    brace_pose_t pose = pose_of(limb, postures[0]);
    brace_gap_stiffness_t gap;
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, BRACE_GAP_FEMUR | BRACE_GAP_TIBIA, &gap));
    TEST_ASSERT_TRUE(gap.now.k_xx_n_per_mm == 0.0f && gap.now.k_xz_n_per_mm == 0.0f && gap.now.k_zz_n_per_mm == 0.0f &&
                     gap.now.lambda_max_n_per_mm == 0.0f);
    TEST_ASSERT_EQUAL_UINT32(BRACE_FLAG_GAP_OPEN, gap.now.flags & ~k.flags);
    const float straight[] = {0.5f, 0.0f};
    pose = pose_of(limb, straight);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, BRACE_GAP_FEMUR | BRACE_GAP_TIBIA, &gap));
    TEST_ASSERT_TRUE(gap.now.flags & BRACE_FLAG_NEAR_SINGULAR);
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &pose, BRACE_GAP_NONE, &gap));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&gap.now, &k, sizeof k));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&gap.engaged, &k, sizeof k));
}

static void a_tip_on_a_free_joints_axis_is_refused_and_touches_nothing(void)
{
    const brace_stiffness_t k = stiffness_of(&sample_limb[SAMPLE_PAPER], postures[0]);
    brace_pose_t at_axis = pose_of(&sample_limb[SAMPLE_PAPER], postures[0]);
    brace_gap_stiffness_t gap, before;
    memset(&gap, 0x5a, sizeof gap);
    before = gap;
    at_axis.lever_femur = (brace_point_t){0.0f, 0.0f};
    TEST_ASSERT_EQUAL_INT(BRACE_E_SINGULAR, brace_gap_stiffness_known(&k, &at_axis, BRACE_GAP_FEMUR, &gap));
    TEST_ASSERT_EQUAL_INT(0, memcmp(&before, &gap, sizeof gap));
    TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&k, &at_axis, BRACE_GAP_TIBIA, &gap));
}

/* An axis has no direction: it is reported as the half with x >= 0, and upwards where x is 0. A joint that is free and
 * at the tip itself carries nothing that a lever could show. */
static void the_axis_of_a_free_joint_is_reported_one_way(void)
{
    static const brace_point_t lever[] = {{0.0f, 200.0f}, {0.0f, -200.0f}, {200.0f, 0.0f}, {-200.0f, 0.0f}};
    static const double axis_rad[] = {0.0, 0.0, 1.5707963, 1.5707963};
    const brace_stiffness_t round = {
        .k_xx_n_per_mm = 2.0f, .k_zz_n_per_mm = 2.0f, .lambda_min_n_per_mm = 2.0f, .lambda_max_n_per_mm = 2.0f};
    for (int i = 0; i < 4; i++) {
        brace_pose_t pose = {.lever_femur = lever[i], .lever_tibia = {0.0f, 0.0f}};
        brace_gap_stiffness_t gap;
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&round, &pose, BRACE_GAP_FEMUR, &gap));
        ASSERT_CLOSE(axis_rad[i], gap.now.stiff_axis_rad, 1e-6);
        ASSERT_CLOSE(2.0, gap.now.lambda_max_n_per_mm, 1e-6);
        TEST_ASSERT_EQUAL_INT(BRACE_E_SINGULAR, brace_gap_stiffness_known(&round, &pose, BRACE_GAP_TIBIA, &gap));
        pose.lever_tibia = lever[i];
        pose.lever_femur = (brace_point_t){0.0f, 0.0f};
        TEST_ASSERT_EQUAL_INT(BRACE_OK, brace_gap_stiffness_known(&round, &pose, BRACE_GAP_TIBIA, &gap));
        TEST_ASSERT_EQUAL_INT(BRACE_E_SINGULAR, brace_gap_stiffness_known(&round, &pose, BRACE_GAP_FEMUR, &gap));
        TEST_ASSERT_EQUAL_INT(BRACE_E_SINGULAR,
                              brace_gap_stiffness_known(&round, &pose, BRACE_GAP_FEMUR | BRACE_GAP_TIBIA, &gap));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_rank_one_formula_is_met);
    RUN_TEST(nothing_is_carried_about_the_free_joint);
    RUN_TEST(it_is_the_limit_of_a_soft_joint);
    RUN_TEST(the_axis_of_what_is_carried_points_outwards);
    RUN_TEST(both_free_carry_nothing_and_none_free_changes_nothing);
    RUN_TEST(a_tip_on_a_free_joints_axis_is_refused_and_touches_nothing);
    RUN_TEST(the_axis_of_a_free_joint_is_reported_one_way);
    return UNITY_END();
}
