/* K under the load of now: the same as the core's estimator at that posture and load, whoever measures the load, and a
 * flag where none can be counted. */
#include "app_bench.h"

#define DOWN_RAD (-1.57079633f)

static brace_parameters_t parameters;

void setUp(void)
{
    parameters = bench_parameters();
    parameters.limb.link[BRACE_FEMUR].moment_transfer = 1.0f;
    parameters.limb.link[BRACE_TIBIA].moment_transfer = 0.5f;
    parameters.gravity.femur_n = 2.0f;
    parameters.gravity.knee_n = 1.0f;
    parameters.gravity.tibia_n = 1.5f;
}

void tearDown(void) {}

static void start_pressed(float x_n, float z_n)
{
    bench_start(&parameters);
    fake.force_x_n = x_n;
    fake.force_z_n = z_n;
    ticks(5);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static brace_vec_t down_at(double direction_rad, double lean_rad)
{
    return (brace_vec_t){(float)(cos(lean_rad) * cos(direction_rad)), (float)(cos(lean_rad) * sin(direction_rad))};
}

/* Two ways through the same arithmetic with another rounding of the direction of down. */
#define SAME_K 1e-5

/* Without an FPU the application asks the core's integers, and the expected factor is the float path's. The search
 * keeps ten bits and more of it: 1e-3. Elsewhere both are one path, apart by what the direction's rounding makes. */
#ifdef __SOFTFP__
#define SAME_FACTOR 1e-3f
#else
#define SAME_FACTOR 1e-5f
#endif

static void expect_k(const brace_loaded_stiffness_t *expected)
{
    const brace_stiffness_t *k = &now()->stiffness.now;
    const double most = (double)expected->stiffness.lambda_max_n_per_mm;
    TEST_ASSERT_TRUE(now()->load.is_counted);
    ASSERT_CLOSE(expected->stiffness.k_xx_n_per_mm, k->k_xx_n_per_mm, SAME_K * most);
    ASSERT_CLOSE(expected->stiffness.k_xz_n_per_mm, k->k_xz_n_per_mm, SAME_K * most);
    ASSERT_CLOSE(expected->stiffness.k_zz_n_per_mm, k->k_zz_n_per_mm, SAME_K * most);
    ASSERT_CLOSE(expected->displacement.x_mm, now()->load.moved_x_mm, 1e-3);
    ASSERT_CLOSE(expected->displacement.z_mm, now()->load.moved_z_mm, 1e-3);
    if (isinf(expected->buckling_factor)) {
        TEST_ASSERT_TRUE(isinf(now()->load.buckling_factor));
    } else {
        const float factor = expected->buckling_factor;
        TEST_ASSERT_FLOAT_WITHIN(SAME_FACTOR * factor, factor, now()->load.buckling_factor);
    }
}

static void test_K_and_the_equilibrium_are_those_under_the_sensed_force_and_the_weight(void)
{
    static const brace_force_t tip[] = {{0.0f, 0.0f}, {0.01f, 0.0f}, {0.0f, 10.0f}, {-12.0f, 4.0f}, {8.0f, -6.0f}};
    for (uint32_t i = 0; i < sizeof tip / sizeof *tip; i++) {
        start_pressed(tip[i].x_n, tip[i].z_n);
        const brace_loaded_stiffness_t expected =
            equilibrium(&parameters, 1.0f, 1.4f, tip[i], down_at((double)DOWN_RAD, 0.0));
        expect_k(&expected);
        TEST_ASSERT_EQUAL_FLOAT(tip[i].x_n, now()->load.force_x_n);
        TEST_ASSERT_EQUAL_FLOAT(tip[i].z_n, now()->load.force_z_n);
        const double unbent_x = 185.0 * cos(1.0) + 313.5 * cos(0.4), unbent_z = 185.0 * sin(1.0) - 313.5 * sin(0.4);
        ASSERT_CLOSE(unbent_x + (double)expected.displacement.x_mm, now()->tip_mm.x_mm, 2e-3);
        ASSERT_CLOSE(unbent_z + (double)expected.displacement.z_mm, now()->tip_mm.z_mm, 2e-3);
        ASSERT_CLOSE(1.0 + (double)expected.hip_turn_rad, now()->theta_rad[BRACE_FEMUR], 1e-6);
        ASSERT_CLOSE(1.4 - (double)expected.knee_turn_rad, now()->theta_rad[BRACE_TIBIA], 1e-6);
    }
}

/* What the base turns is no part of the joint's angle: the two share the turn as they share what yields. */
static void test_the_base_s_rotation_is_no_part_of_the_joint_s_angle(void)
{
    parameters.limb.base.rotation_rad_per_n_mm = 3e-5f;
    start_pressed(0.0f, 5.0f);
    const brace_loaded_stiffness_t expected =
        equilibrium(&parameters, 1.0f, 1.4f, (brace_force_t){0.0f, 5.0f}, down_at((double)DOWN_RAD, 0.0));
    expect_k(&expected);
    ASSERT_CLOSE(1.0 + 0.25 * (double)expected.hip_turn_rad, now()->theta_rad[BRACE_FEMUR], 1e-5);
}

static void test_K_without_load_is_reported_beside_it(void)
{
    start_pressed(0.0f, 10.0f);
    brace_planar_t planar;
    brace_stiffness_t expected;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_collapse(&parameters.limb, &planar));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_planar_stiffness(&planar, 1.0f, 1.4f, &expected));
    TEST_ASSERT_EQUAL_FLOAT(expected.k_xx_n_per_mm, now()->load.unloaded.k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(expected.k_xz_n_per_mm, now()->load.unloaded.k_xz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(expected.k_zz_n_per_mm, now()->load.unloaded.k_zz_n_per_mm);
    TEST_ASSERT_TRUE(fabsf(now()->stiffness.now.k_xx_n_per_mm - expected.k_xx_n_per_mm) > 0.2f);
}

/* An encoder behind the gear measures the angle that the load has turned the joint to: the joint yields no further, and
 * neither zero offset nor play is added. Its spring counts in K all the same. */
static void test_a_joint_measured_behind_its_gear_stands_where_it_is_measured(void)
{
    const float soft_rad_per_n_mm = parameters.limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    parameters.limb.joint[BRACE_TIBIA].zero_offset_rad = 0.1f;
    bench_start(&parameters);
    fake.force_z_n = 8.0f;
    fake.joint[BRACE_TIBIA].sample.link_rad = 1.35f;
    ticks(5);
    const float hip = parameters.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const brace_load_t load = {
        .tip = {0.0f, 8.0f}, .down = {0.0f, -1.0f}, .hip = {hip, hip}, .knee = {0.0f, soft_rad_per_n_mm}};
    brace_loaded_t loaded;
    brace_loaded_stiffness_t expected;
    brace_loaded_collapse(&parameters.limb, &parameters.gravity, &loaded);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_stiffness(&loaded, 1.0f, 1.35f, &load, &expected));
    expect_k(&expected);
    TEST_ASSERT_EQUAL_FLOAT(1.35f, now()->theta_rad[BRACE_TIBIA]);
    fake.joint[BRACE_TIBIA].sample.link_rad = 1e6f; /* absurd: as if there were none */
    ticks(1);
    TEST_ASSERT_TRUE(fabsf(now()->theta_rad[BRACE_TIBIA] - 1.5f) < 0.05f);
}

/* Torque = q / compliance + h q^3: the joint turns by q, and its slope there is 1 / (1 / compliance + 3 h q^2). */
static void test_a_spring_that_hardens_turns_by_its_secant_and_yields_by_its_slope(void)
{
    parameters.drive[BRACE_TIBIA].hardening_n_mm_per_rad3 = 2e8f;
    bench_start(&parameters);
    const double q = 0.012, torque_n_mm = q / 1.6e-5 + 2e8 * q * q * q;
    fake.force_z_n = 2.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = (float)torque_n_mm;
    ticks(300);
    const float hip = parameters.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const brace_load_t load = {.tip = {0.0f, 2.0f},
                               .down = {0.0f, -1.0f},
                               .hip = {hip, hip},
                               .knee = {(float)(q / torque_n_mm), (float)(1.0 / (1.0 / 1.6e-5 + 6e8 * q * q))}};
    brace_loaded_t loaded;
    brace_loaded_stiffness_t expected;
    brace_loaded_collapse(&parameters.limb, &parameters.gravity, &loaded);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_stiffness(&loaded, 1.0f, 1.4f, &load, &expected));
    ASSERT_CLOSE(expected.stiffness.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-4);
    ASSERT_CLOSE(expected.displacement.z_mm, now()->load.moved_z_mm, 1e-2);
}

/* Without a sensor the joints measure the force: their torques about the axes of the limb as it stands bent. The motors
 * here carry what a force of (3, 7) N and the weights turn about them, worked out from the equilibrium's shape. */
static void test_without_a_sensor_the_force_follows_from_the_levers_of_the_bent_limb(void)
{
    parameters.gravity = (brace_gravity_t){.direction_rad = DOWN_RAD};
    bench_start(&parameters);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    const brace_force_t force = {3.0f, 7.0f};
    const brace_loaded_stiffness_t bent = equilibrium(&parameters, 1.0f, 1.4f, force, down_at((double)DOWN_RAD, 0.0));
    const double tip_x = 185.0 * cos(1.0) + 313.5 * cos(0.4) + (double)bent.displacement.x_mm;
    const double tip_z = 185.0 * sin(1.0) - 313.5 * sin(0.4) + (double)bent.displacement.z_mm;
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = (float)-(tip_x * 7.0 - tip_z * 3.0);
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = (float)((double)bent.tibia_mm.x * 7.0 - (double)bent.tibia_mm.z * 3.0);
    ticks(50);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    ASSERT_CLOSE(3.0, now()->force_x_n, 1e-2);
    ASSERT_CLOSE(7.0, now()->force_z_n, 1e-2);
    ASSERT_CLOSE(bent.stiffness.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-3);
}

static void test_the_parameters_say_where_down_is(void)
{
    static const float direction_rad[] = {0.3f, 3.1f, -2.0f}, lean_rad[] = {0.0f, 0.4f, -1.2f};
    for (int i = 0; i < 3; i++) {
        parameters.gravity.direction_rad = direction_rad[i];
        parameters.gravity.lean_rad = lean_rad[i];
        start_pressed(1.0f, 6.0f);
        const brace_loaded_stiffness_t expected = equilibrium(&parameters, 1.0f, 1.4f, (brace_force_t){1.0f, 6.0f},
                                                              down_at((double)direction_rad[i], (double)lean_rad[i]));
        expect_k(&expected);
        TEST_ASSERT_EQUAL_FLOAT(direction_rad[i], now()->gravity_direction_rad);
        TEST_ASSERT_EQUAL_FLOAT(lean_rad[i], now()->gravity_lean_rad);
    }
}

static void expect_no_load(void)
{
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_LOAD_UNKNOWN, now()->stiffness.now.flags);
    TEST_ASSERT_EQUAL_FLOAT(now()->load.unloaded.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm);
    TEST_ASSERT_FALSE(now()->load.is_counted);
    TEST_ASSERT_TRUE(isnan(now()->load.force_x_n) && isnan(now()->load.moved_z_mm));
    TEST_ASSERT_TRUE(isnan(now()->load.buckling_factor));
    brace_pose_t unbent; /* a load of before bends nothing any more */
    const float theta1_rad = now()->theta_rad[BRACE_FEMUR], theta2_rad = now()->theta_rad[BRACE_TIBIA];
    TEST_ASSERT_EQUAL(BRACE_OK, brace_kinematics_forward(&parameters.limb, theta1_rad, theta2_rad, &unbent));
    ASSERT_CLOSE(unbent.tip.x_mm, now()->tip_mm.x_mm, 1e-4);
    ASSERT_CLOSE(unbent.tip.z_mm, now()->tip_mm.z_mm, 1e-4);
}

/* Near the straight knee the joints measure no force. */
static void test_without_a_force_K_is_the_one_without_load_and_flagged(void)
{
    bench_start(&parameters);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.joint[BRACE_TIBIA].sample.motor_rad = 0.02f;
    ticks(5);
    expect_no_load();
    TEST_ASSERT_EQUAL_FLOAT(0.02f, now()->theta_rad[BRACE_TIBIA]);
    for (int i = 1; i <= 500; i++) { /* the knee bends, the load is known, and the knee straightens again */
        fake.joint[BRACE_TIBIA].sample.motor_rad = 0.02f + 0.002f * (float)(i < 250 ? i : 500 - i);
        ticks(1);
        TEST_ASSERT_TRUE(i != 250 || now()->load.is_counted);
    }
    ticks(5);
    expect_no_load();
}

/* The flags follow the buckling factor and the tip's way; where no rest is found or the force is beyond the estimator
 * there is no K. */
static void test_a_load_that_softens_the_limb_is_flagged_and_one_that_folds_it_has_no_K(void)
{
    bool softened = false, folded = false;
    parameters.gravity = (brace_gravity_t){.direction_rad = DOWN_RAD};
    bench_start(&parameters);
    ticks(5);
    for (int i = 0; i < 140; i++) {
        fake.force_x_n = i < 80 ? -2.0f * (float)i : fake.force_x_n * 1.07f;
        ticks(1);
        const uint32_t flags = now()->stiffness.now.flags;
        if (now()->k_is_valid) {
            TEST_ASSERT_TRUE(now()->load.buckling_factor > 1.0f);
            TEST_ASSERT_EQUAL(hypotf(now()->load.moved_x_mm, now()->load.moved_z_mm) >
                                  0.2f * (parameters.limb.femur_mm + parameters.limb.tibia_mm),
                              (flags & BRACE_FLAG_MOVED_FAR) != 0u);
            TEST_ASSERT_EQUAL(now()->load.buckling_factor < 3.0f, (flags & BRACE_FLAG_SOFTENED) != 0u);
            softened = softened || (flags & BRACE_FLAG_SOFTENED) != 0u;
        } else {
            folded = true;
            TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_NEAR_SINGULAR | BRACE_FLAG_SOFTENED, flags);
            TEST_ASSERT_TRUE(isnan(now()->stiffness.now.k_xx_n_per_mm));
        }
    }
    TEST_ASSERT_TRUE(softened && folded);
    fake.force_x_n = 2e4f; /* beyond what brace/loaded.h takes */
    ticks(1);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_NEAR_SINGULAR, now()->stiffness.now.flags);
    fake.force_x_n = 0.0f;
    ticks(1);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL_HEX32(0, now()->stiffness.now.flags);
}

/* The limb is moved while nobody reads a joint. What is known of its bend is of before then: the first tick that can
 * have K has it. */
static void test_after_a_while_unseen_the_first_tick_has_K(void)
{
    parameters.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm = 2e-5f;
    start_pressed(0.0f, 8.0f);
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(300);
    TEST_ASSERT_FALSE(now()->load.is_counted);
    fake.joint[BRACE_FEMUR].not_newer = false;
    fake.joint[BRACE_FEMUR].sample.motor_rad = 2.14f;
    fake.joint[BRACE_TIBIA].sample.motor_rad = -1.4f;
    for (int tick = 0; tick < 1500; tick++) {
        ticks(1);
        TEST_ASSERT_EQUAL_HEX32(0u, now()->stiffness.now.flags & BRACE_FLAG_SOFTENED);
        if (tick == 2) {
            bench_believe();
        }
    }
    TEST_ASSERT_TRUE(now()->load.is_counted && now()->k_is_valid);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_K_and_the_equilibrium_are_those_under_the_sensed_force_and_the_weight);
    RUN_TEST(test_the_base_s_rotation_is_no_part_of_the_joint_s_angle);
    RUN_TEST(test_K_without_load_is_reported_beside_it);
    RUN_TEST(test_a_joint_measured_behind_its_gear_stands_where_it_is_measured);
    RUN_TEST(test_a_spring_that_hardens_turns_by_its_secant_and_yields_by_its_slope);
    RUN_TEST(test_without_a_sensor_the_force_follows_from_the_levers_of_the_bent_limb);
    RUN_TEST(test_the_parameters_say_where_down_is);
    RUN_TEST(test_without_a_force_K_is_the_one_without_load_and_flagged);
    RUN_TEST(test_a_load_that_softens_the_limb_is_flagged_and_one_that_folds_it_has_no_K);
    RUN_TEST(test_after_a_while_unseen_the_first_tick_has_K);
    return UNITY_END();
}
