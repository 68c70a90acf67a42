/* What is reported where something of K is not known: no load, no K across the plane, no axis. */
#include "app_bench.h"
#include "stiffness/stiffness.h"

void setUp(void) {}

void tearDown(void) {}

/* A joint that an encoder behind its gear measures does not yield any further; its spring counts in K all the same. */
static void test_measured_joints_are_held(void)
{
    for (uint32_t measured = 0; measured < 8u; measured++) {
        brace_loaded_joint_t springs[BRACE_LINK_COUNT];
        posture_t posture;
        posture_start(&posture);
        for (uint32_t i = 0; i < (uint32_t)BRACE_LINK_COUNT; i++) {
            posture.is_measured[i] = (measured >> i & 1u) != 0u;
            springs[i] = (brace_loaded_joint_t){1e-5f * (float)(i + 1u), 2e-5f * (float)(i + 1u)};
        }
        stiffness_hold_measured_joints(&posture, springs);
        for (uint32_t i = 0; i < (uint32_t)BRACE_LINK_COUNT; i++) {
            const float yields = (measured >> i & 1u) != 0u ? 0.0f : 1e-5f * (float)(i + 1u);
            TEST_ASSERT_EQUAL_FLOAT(yields, springs[i].yields_by_rad_per_n_mm);
            TEST_ASSERT_EQUAL_FLOAT(2e-5f * (float)(i + 1u), springs[i].slope_rad_per_n_mm);
        }
    }
}

static void stand_at(const brace_parameters_t *p, bool has_coxa, float theta0_rad, float theta2_rad)
{
    bench_start(p);
    brace_fake_without_force(&fake);
    fake.joint[BRACE_COXA].absent = !has_coxa;
    fake.joint[BRACE_COXA].sample.motor_rad = theta0_rad;
    fake.joint[BRACE_TIBIA].sample.motor_rad = theta2_rad;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(has_coxa ? 300 : 60); /* a round of K's uncertainty */
}

static brace_parameters_t space_parameters(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.link[BRACE_TIBIA].torsion_rad_per_n_mm = 3e-6f;
    return p;
}

/* A straight limb's joints measure no force, with a coxa joint or without: K is that without load, and says so. */
static void test_a_straight_limb_reports_K_without_its_load(void)
{
    for (int has_coxa = 0; has_coxa < 2; has_coxa++) {
        const brace_parameters_t p = has_coxa ? space_parameters() : bench_parameters();
        stand_at(&p, has_coxa != 0, 0.3f, 0.05f);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_TRUE(isnan(now()->force_x_n) && isnan(now()->force_z_n));
        TEST_ASSERT_FALSE(now()->load.is_counted);
        TEST_ASSERT_TRUE(isnan(now()->load.force_x_n) && isnan(now()->load.force_y_n) && isnan(now()->load.force_z_n));
        TEST_ASSERT_TRUE(isnan(now()->load.moved_x_mm) && isnan(now()->load.moved_y_mm) &&
                         isnan(now()->load.moved_z_mm));
        TEST_ASSERT_TRUE(isnan(now()->load.buckling_factor));
        TEST_ASSERT_BITS_HIGH(BRACE_FLAG_LOAD_UNKNOWN, now()->stiffness.now.flags);
        TEST_ASSERT_BITS_HIGH(BRACE_FLAG_LOAD_UNKNOWN, now()->stiffness.engaged.flags);
        TEST_ASSERT_EQUAL_FLOAT(now()->stiffness.now.k_xx_n_per_mm, now()->load.unloaded.k_xx_n_per_mm);
        TEST_ASSERT_EQUAL(has_coxa, now()->space.is_valid);
        if (has_coxa) {
            const float *lambda = now()->space.now.lambda_n_per_mm;
            const float most = lambda[2], plane_least = now()->stiffness.now.lambda_min_n_per_mm;
            TEST_ASSERT_BITS_HIGH(BRACE_FLAG_LOAD_UNKNOWN, now()->space.now.flags);
            TEST_ASSERT_FLOAT_WITHIN(1e-4f * most, now()->stiffness.now.lambda_max_n_per_mm, most);
            TEST_ASSERT_TRUE(fabsf(lambda[0] - plane_least) < 1e-4f * most ||
                             fabsf(lambda[1] - plane_least) < 1e-4f * most);
            TEST_ASSERT_EQUAL_FLOAT(now()->load.unloaded_across_n_per_mm, now()->space.across_n_per_mm);
        }
        brace_stiffness_sigma_t by_parameters;
        TEST_ASSERT_TRUE(now()->sigma_is_known);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_stiffness(&p.limb, now()->theta_rad[BRACE_FEMUR],
                                                                now()->theta_rad[BRACE_TIBIA],
                                                                &now()->stiffness.engaged, &by_parameters));
        /* Two ways to one figure: a derivative, and a quarter of a sigma's change, near the straight knee. */
        ASSERT_CLOSE(by_parameters.k_xx_n_per_mm, now()->sigma.k_xx_n_per_mm,
                     0.05 * (double)by_parameters.k_xx_n_per_mm);
        ASSERT_CLOSE(by_parameters.lambda_min_n_per_mm, now()->sigma.lambda_min_n_per_mm,
                     0.05 * (double)by_parameters.lambda_min_n_per_mm);
    }
}

/* A coxa joint that has been turned more than once round: K in the plane is reported, in space it is not. */
static void test_beyond_the_range_of_the_coxa_joint_K_is_of_the_plane(void)
{
    const brace_parameters_t p = space_parameters();
    static const float theta2_rad[] = {1.4f, 0.05f}; /* with a load, and where none is known */
    for (int i = 0; i < 2; i++) {
        stand_at(&p, true, 8.5f, theta2_rad[i]);
        TEST_ASSERT_TRUE(now()->k_is_valid);
        TEST_ASSERT_FALSE(now()->space.is_valid);
        TEST_ASSERT_BITS_HIGH(BRACE_FLAG_NEAR_SINGULAR, now()->space.now.flags);
        TEST_ASSERT_TRUE(isnan(now()->space.now.k_xx_n_per_mm) && isnan(now()->space.engaged.k_zz_n_per_mm));
        TEST_ASSERT_TRUE(isnan(now()->space.across_n_per_mm) && isnan(now()->space.engaged_across_n_per_mm));
    }
}

/* Links that do not yield, and joints that turn the tip one way only. */
static void test_a_straight_limb_that_yields_one_way_only_has_no_K(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.base = (brace_base_t){0.0f, 0.0f, 0.0f};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.limb.link[i].axial_mm_per_n = p.limb.link[i].bending_mm_per_n = 0.0f;
        p.limb.link[i].tilt_rad = 0.0f;
    }
    stand_at(&p, false, 0.0f, 0.0f);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_BITS_HIGH(BRACE_FLAG_NEAR_SINGULAR, now()->stiffness.now.flags);
    TEST_ASSERT_FALSE(now()->sigma_is_known);
    stand_at(&p, false, 0.0f, 1.4f);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

/* Across an axis of pi/2 on either side, two axes are near: their span is the short way round. */
static void test_the_span_of_an_axis_is_the_short_way_round(void)
{
    brace_parameters_t p = bench_parameters();
    for (float theta1_rad = 0.0f; theta1_rad < 3.0f; theta1_rad += 0.02f) {
        bench_start(&p);
        fake.joint[BRACE_FEMUR].sample.motor_rad = theta1_rad;
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = 500.0f;
        brace_fake_without_force(&fake);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
        ticks(60);
        if (now()->k_is_valid && fabsf(now()->stiffness.engaged.stiff_axis_rad) > 1.5f) {
            TEST_ASSERT_TRUE(now()->sigma_is_known);
            TEST_ASSERT_TRUE(now()->sigma.stiff_axis_rad < 0.2f);
        }
    }
}

static void test_a_round_K_has_no_known_axis(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb = sample_limb[SAMPLE_ROUND];
    p.limb.uncertainty = (brace_uncertainty_t){.compliance_rel = 0.1f, .angle_rad = 0.05f, .gain_rel = 0.02f};
    int unknown = 0;
    for (float theta2_rad = 0.3f; theta2_rad < 2.8f; theta2_rad += 0.05f) {
        stand_at(&p, false, 0.0f, theta2_rad);
        if (now()->sigma_is_known && now()->sigma.stiff_axis_rad >= BRACE_UNKNOWN_AXIS_RAD) {
            TEST_ASSERT_EQUAL_FLOAT(BRACE_UNKNOWN_AXIS_RAD, now()->sigma.stiff_axis_rad);
            TEST_ASSERT_BITS_HIGH(BRACE_FLAG_SATURATED, now()->sigma.flags);
            unknown++;
        }
    }
    TEST_ASSERT_TRUE(unknown > 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_measured_joints_are_held);
    RUN_TEST(test_a_straight_limb_reports_K_without_its_load);
    RUN_TEST(test_beyond_the_range_of_the_coxa_joint_K_is_of_the_plane);
    RUN_TEST(test_a_straight_limb_that_yields_one_way_only_has_no_K);
    RUN_TEST(test_the_span_of_an_axis_is_the_short_way_round);
    RUN_TEST(test_a_round_K_has_no_known_axis);
    return UNITY_END();
}
