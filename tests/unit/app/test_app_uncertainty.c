/* The uncertainty of K in the snapshot has three parts: the uncertainty of the parameters, a load that the mean over
 * the joints' samples has not followed yet, and a gap in which a joint may stand anywhere. How long it holds:
 * jobs/uncertainty/test_sigma_holds.c. That three sigmas hold K: tests/judges/engine/test_core_uncertainty.py. */
#include "app_bench.h"
#include "brace/uncertainty_causes.h"

#define DOWN ((brace_vec_t){0.0f, -1.0f})
#define SAME_SIGMA 2e-4 /* N/mm: two float paths to a K of some 4 N/mm, and a difference between them */
#define SAME_RATIO 0.02 /* between a round and a tick a little later, in which the limb stands a few mrad elsewhere */

static brace_parameters_t parameters;

void setUp(void)
{
    parameters = bench_parameters();
    parameters.gravity = (brace_gravity_t){.direction_rad = -1.57079633f};
    parameters.limb.uncertainty =
        (brace_uncertainty_t){.length_mm = 0.3f, .angle_rad = 0.002f, .compliance_rel = 0.03f};
}

void tearDown(void) {}

static brace_loaded_joint_t joint_spring(int index)
{
    const float compliance_rad_per_n_mm = parameters.limb.joint[index].compliance_rad_per_n_mm;
    const bool stands = app.controller.posture.is_measured[index]; /* behind the spring */
    return (brace_loaded_joint_t){stands ? 0.0f : compliance_rad_per_n_mm, compliance_rad_per_n_mm};
}

static brace_stiffness_sigma_t reported(void)
{
    TEST_ASSERT_TRUE(now()->sigma_is_known);
    return now()->sigma;
}

/* What the core makes of the parameters at the load that K counts. */
static brace_stiffness_sigma_t by_parameters(void)
{
    const float *unbent_rad = app.controller.posture.unbent_rad;
    const brace_snapshot_load_t *counted = &now()->load;
    const brace_loaded_joint_t hip = joint_spring(BRACE_FEMUR), knee = joint_spring(BRACE_TIBIA);
    const brace_load_t load = {.tip = {counted->force_x_n, counted->force_z_n}, .down = DOWN, .hip = hip, .knee = knee};
    brace_stiffness_sigma_t sigma;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_loaded(&parameters.limb, &parameters.gravity, unbent_rad[BRACE_FEMUR],
                                                         unbent_rad[BRACE_TIBIA], &load, &sigma));
    return sigma;
}

static brace_k_sigma_t by_parameters_in_space(void)
{
    const brace_snapshot_load_t *counted = &now()->load;
    const brace_space_load_t load = {.tip_n = {counted->force_x_n, counted->force_y_n, counted->force_z_n},
                                     .down = {0.0f, 0.0f, -1.0f},
                                     .yaw = joint_spring(BRACE_COXA),
                                     .hip = joint_spring(BRACE_FEMUR),
                                     .knee = joint_spring(BRACE_TIBIA)};
    brace_k_sigma_t sigma;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_uncertainty_loaded_space(&parameters.limb, &parameters.gravity,
                                                               app.controller.posture.unbent_rad, &load, &sigma));
    return sigma;
}

static void expect_same(float expected, float sigma)
{
    ASSERT_CLOSE(expected, sigma, SAME_SIGMA + SAME_RATIO * (double)expected);
}

/* Not known is no number, least of all zero. */
static void expect_not_known(void)
{
    TEST_ASSERT_FALSE(now()->sigma_is_known);
    TEST_ASSERT_EQUAL_UINT32(0, now()->sigma_age_us);
    const brace_stiffness_sigma_t *sigma = &now()->sigma;
    const brace_space_sigma_t *space = &now()->sigma_space;
    TEST_ASSERT_TRUE(isnan(sigma->k_xx_n_per_mm) && isnan(sigma->k_xz_n_per_mm) && isnan(sigma->k_zz_n_per_mm));
    TEST_ASSERT_TRUE(isnan(sigma->lambda_min_n_per_mm) && isnan(sigma->lambda_max_n_per_mm));
    TEST_ASSERT_TRUE(isnan(sigma->stiff_axis_rad) && isnan(space->k_xx_n_per_mm) && isnan(space->across_n_per_mm));
}

static void expect_no_more_than_parameters(void)
{
    const brace_stiffness_sigma_t sigma = reported(), expected = by_parameters();
    expect_same(expected.k_xx_n_per_mm, sigma.k_xx_n_per_mm);
    expect_same(expected.k_xz_n_per_mm, sigma.k_xz_n_per_mm);
    expect_same(expected.k_zz_n_per_mm, sigma.k_zz_n_per_mm);
    expect_same(expected.lambda_min_n_per_mm, sigma.lambda_min_n_per_mm);
    expect_same(expected.lambda_max_n_per_mm, sigma.lambda_max_n_per_mm);
    expect_same(expected.stiff_axis_rad, sigma.stiff_axis_rad);
}

/* A limb without a sensor at its tip whose joints have carried these torques for long. */
static void start_carrying(float femur_n_mm, float tibia_n_mm)
{
    bench_start(&parameters);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = femur_n_mm;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = tibia_n_mm;
    ticks(100);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
}

/* K of a limb whose joints have carried these torques for long: what the controller reports then. */
static brace_stiffness_t k_carrying(float femur_n_mm, float tibia_n_mm)
{
    start_carrying(femur_n_mm, tibia_n_mm);
    return now()->stiffness.engaged;
}

static float with_spans(float sigma, float from, float to, float or_to)
{
    return sqrtf(sigma * sigma + ((to - from) * (to - from) + (or_to - from) * (or_to - from)) / 3.0f);
}

/* What sigma should be where the femur joint's load and that of the tibia joint may be others: each adds a span, from
 * the K that is reported to K with that load. */
typedef struct {
    brace_stiffness_sigma_t reported, expected;
    double span_n_per_mm, span_rad;
} spans_t;

static spans_t spans_to(float femur_n_mm, float tibia_n_mm)
{
    const brace_stiffness_t k = now()->stiffness.engaged;
    const float femur_reported_n_mm = now()->play[BRACE_FEMUR].load_n_mm;
    const float tibia_reported_n_mm = now()->play[BRACE_TIBIA].load_n_mm;
    const brace_stiffness_sigma_t sigma = reported(), least = by_parameters();
    const brace_stiffness_t a = k_carrying(femur_n_mm, tibia_reported_n_mm);
    const brace_stiffness_t b = k_carrying(femur_reported_n_mm, tibia_n_mm);
    const double span =
        fmax(fabs((double)(a.k_xz_n_per_mm - k.k_xz_n_per_mm)), fabs((double)(b.k_xz_n_per_mm - k.k_xz_n_per_mm)));
    TEST_ASSERT_TRUE(span > 0.05); /* or this test shows nothing */
    return (spans_t){
        .reported = sigma,
        .expected = {with_spans(least.k_xx_n_per_mm, k.k_xx_n_per_mm, a.k_xx_n_per_mm, b.k_xx_n_per_mm),
                     with_spans(least.k_xz_n_per_mm, k.k_xz_n_per_mm, a.k_xz_n_per_mm, b.k_xz_n_per_mm),
                     with_spans(least.k_zz_n_per_mm, k.k_zz_n_per_mm, a.k_zz_n_per_mm, b.k_zz_n_per_mm),
                     with_spans(least.lambda_min_n_per_mm, k.lambda_min_n_per_mm, a.lambda_min_n_per_mm,
                                b.lambda_min_n_per_mm),
                     with_spans(least.lambda_max_n_per_mm, k.lambda_max_n_per_mm, a.lambda_max_n_per_mm,
                                b.lambda_max_n_per_mm),
                     with_spans(least.stiff_axis_rad, k.stiff_axis_rad, a.stiff_axis_rad, b.stiff_axis_rad), 0},
        .span_n_per_mm = span,
        .span_rad = fabs((double)(b.stiff_axis_rad - k.stiff_axis_rad))};
}

static void expect_spans_to(float femur_n_mm, float tibia_n_mm)
{
    const spans_t s = spans_to(femur_n_mm, tibia_n_mm);
    const double most = 0.15 * s.span_n_per_mm; /* levers are those under the load reported, not under the other */
    ASSERT_CLOSE(s.expected.k_xx_n_per_mm, s.reported.k_xx_n_per_mm, most);
    ASSERT_CLOSE(s.expected.k_xz_n_per_mm, s.reported.k_xz_n_per_mm, most);
    ASSERT_CLOSE(s.expected.k_zz_n_per_mm, s.reported.k_zz_n_per_mm, most);
    ASSERT_CLOSE(s.expected.lambda_min_n_per_mm, s.reported.lambda_min_n_per_mm, most);
    ASSERT_CLOSE(s.expected.lambda_max_n_per_mm, s.reported.lambda_max_n_per_mm, most);
    ASSERT_CLOSE(s.expected.stiff_axis_rad, s.reported.stiff_axis_rad, 0.2 * s.span_rad);
}

static void test_a_sensed_load_leaves_open_what_the_parameters_do(void)
{
    bench_start(&parameters);
    fake.force_x_n = 3.0f;
    fake.force_z_n = 12.0f;
    ticks(100);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = 3000.0f; /* the sensor measures the load, not the joints */
    ticks(1);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
    expect_no_more_than_parameters();
}

static void test_a_load_by_the_joints_that_stands_leaves_open_the_same(void)
{
    start_carrying(-2000.0f, 1500.0f);
    expect_no_more_than_parameters();
}

/* A motor's friction carries a part of the load, and nobody sees it. */
static void test_what_the_friction_of_the_motors_may_hold_counts(void)
{
    parameters.drive[BRACE_FEMUR].motor_friction_n_mm = parameters.drive[BRACE_TIBIA].motor_friction_n_mm = 2000.0f;
    start_carrying(-2000.0f, 1500.0f);
    expect_spans_to(-4400.0f, 3900.0f); /* with its tolerance of a fifth */
}

static void test_a_load_that_the_mean_has_not_followed_counts_from_its_first_sample_on(void)
{
    start_carrying(-2000.0f, 1500.0f);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -6000.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 4000.0f;
    ticks(1);
    expect_spans_to(-2000.0f - 4000.0f / sqrtf(3.0f), 1500.0f + 2500.0f / sqrtf(3.0f)); /* of three samples, one */
}

static void test_once_three_samples_report_another_load_all_of_it_counts(void)
{
    start_carrying(-2000.0f, 1500.0f);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -6000.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 4000.0f;
    ticks(3);
    expect_spans_to(-6000.0f, 4000.0f);
}

static void test_it_counts_less_as_the_mean_follows_and_no_more_once_it_has(void)
{
    start_carrying(-2000.0f, 1500.0f);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -4000.0f; /* more beside a standing angle is a stuck encoder */
    ticks(1);
    float before_n_per_mm = reported().k_xx_n_per_mm;
    for (int i = 0; i < 4; i++) {
        ticks(15);
        TEST_ASSERT_TRUE(reported().k_xx_n_per_mm < before_n_per_mm);
        before_n_per_mm = reported().k_xx_n_per_mm;
    }
    ticks(400);
    expect_no_more_than_parameters();
}

static void test_a_joint_with_play_has_a_mean_of_its_own(void)
{
    parameters.limb.joint[BRACE_FEMUR].gap_rad = parameters.limb.joint[BRACE_TIBIA].gap_rad = 0.006f;
    start_carrying(-2000.0f, 1500.0f);
    TEST_ASSERT_EQUAL_HEX32(0, engaged_flags());
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -6000.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 4000.0f;
    ticks(10);
    TEST_ASSERT_EQUAL_HEX32(0, now()->stiffness.now.flags);
    expect_spans_to(-6000.0f, 4000.0f);
}

static void test_a_spring_that_hardens_does_so_by_the_newest_load(void)
{
    parameters.drive[BRACE_FEMUR].hardening_n_mm_per_rad3 = 2e7f;
    parameters.drive[BRACE_TIBIA].hardening_n_mm_per_rad3 = 2e7f;
    start_carrying(-2000.0f, 1500.0f);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -5000.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 3500.0f;
    ticks(3);
    expect_spans_to(-5000.0f, 3500.0f);
}

/* A load that has come moves the motor before its torque grows: what it carries is the torque less what its own inertia
 * takes. A tick's way that is longer by 8e-5 rad than the one before is 80 rad/s2: 4,000 N mm of 50 N mm s2/rad. */
static void test_what_accelerates_a_motor_is_load_too(void)
{
    parameters.drive[BRACE_FEMUR].motor_inertia_n_mm_s2_per_rad = 50.0f;
    parameters.drive[BRACE_TIBIA].motor_inertia_n_mm_s2_per_rad = 50.0f;
    start_carrying(-2000.0f, 1500.0f);
    for (int i = 1; i <= 3; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad += 8e-5f * (float)i;
        fake.joint[BRACE_TIBIA].sample.motor_rad -= 5e-5f * (float)i;
        ticks(1);
    }
    expect_spans_to(-6000.0f, 4000.0f);
}

static void test_a_motor_that_keeps_its_speed_carries_its_torque(void)
{
    parameters.drive[BRACE_FEMUR].motor_inertia_n_mm_s2_per_rad = 50.0f;
    start_carrying(-2000.0f, 1500.0f);
    for (int i = 0; i < 5; i++) {
        fake.joint[BRACE_FEMUR].sample.motor_rad += 0.0009765625f; /* 2^-10: no rounding in a float near 1 */
        ticks(1);
    }
    expect_no_more_than_parameters();
}

/* Behind the spring, a joint turns as soon as a load comes; its motor may not have moved at all. */
static void test_an_encoder_behind_the_gear_reports_no_acceleration_of_the_motor(void)
{
    parameters.drive[BRACE_FEMUR].motor_inertia_n_mm_s2_per_rad = 50.0f;
    start_carrying(-2000.0f, 1500.0f);
    fake.joint[BRACE_FEMUR].sample.link_rad = fake.joint[BRACE_FEMUR].sample.motor_rad;
    fake.joint[BRACE_FEMUR].sample.motor_rad = __builtin_nanf("");
    ticks(50);
    fake.joint[BRACE_FEMUR].sample.link_rad += 8e-5f;
    ticks(1);
    expect_no_more_than_parameters();
}

/* Three samples show how fast a motor becomes faster. Before, its torque may be load or all for itself. Five give three
 * such loads. */
static void test_a_load_by_fewer_than_five_samples_leaves_all_open(void)
{
    bench_start(&parameters);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    int in_a_row = 0, endless = 0;
    for (int i = 0; i < 600; i++) {
        const bool is_out = i >= 30 && i < 60; /* longer than a sample may be old */
        fake.joint[BRACE_TIBIA].not_newer = is_out;
        ticks(1);
        in_a_row = is_out && !app.controller.joints.joint[BRACE_TIBIA].sound ? 0 : in_a_row + (is_out ? 0 : 1);
        const float carries_n_mm = app.controller.joints.joint[BRACE_TIBIA].carries_n_mm[0];
        TEST_ASSERT_EQUAL(in_a_row < 3, isnan(carries_n_mm) || in_a_row == 0);
        if (now()->k_is_valid && in_a_row < 5) {
            TEST_ASSERT_FALSE(now()->sigma_is_known);
            TEST_ASSERT_TRUE(isnan(now()->sigma.k_xx_n_per_mm));
            endless++;
        }
    }
    TEST_ASSERT_TRUE(endless > 0);
    expect_no_more_than_parameters();
}

/* Half a gap may lie between the reported angle and the true one. */
static void test_a_joint_that_may_stand_anywhere_in_its_gap_counts_with_its_angle(void)
{
    parameters.limb.joint[BRACE_FEMUR].gap_rad = parameters.limb.joint[BRACE_TIBIA].gap_rad = 0.006f;
    bench_start(&parameters);
    ticks(100);
    TEST_ASSERT_TRUE((now()->stiffness.now.flags & BRACE_FLAG_GAP_OPEN) != 0u);
    parameters.limb.uncertainty.angle_rad = sqrtf(0.002f * 0.002f + 0.003f * 0.003f);
    expect_no_more_than_parameters();
}

static void test_a_newest_load_without_an_equilibrium_leaves_all_open(void)
{
    parameters.drive[BRACE_FEMUR].torque_range_n_mm = parameters.drive[BRACE_TIBIA].torque_range_n_mm = 110000.0f;
    start_carrying(-2000.0f, 1500.0f);
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -110000.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = -110000.0f;
    ticks(1);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    expect_not_known();
}

static void yields_across_its_plane(void)
{
    parameters.limb.joint[BRACE_COXA].compliance_rad_per_n_mm = 8e-6f;
    parameters.limb.link[BRACE_FEMUR].lateral_mm_per_n = 0.06f;
    parameters.limb.link[BRACE_TIBIA].lateral_mm_per_n = 0.25f;
    parameters.limb.link[BRACE_TIBIA].moment_transfer = 1.0f;
}

/* With the coxa joint at 0 and no load across, the limb's plane is that of x and z: what a joint's load does to K's
 * entries there is one thing, found for K in the plane and for K in space. */
static void test_a_load_in_the_plane_counts_in_space_as_in_the_plane(void)
{
    yields_across_its_plane();
    bench_start(&parameters);
    fake.joint[BRACE_COXA].absent = false;
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -2000.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 1500.0f;
    ticks(500);
    const sigma_result_t *found = &app.controller.sigma.told;
    TEST_ASSERT_TRUE(found->is_there);
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        TEST_ASSERT_TRUE(found->load_counts[joint]);
        const brace_k_sigma_t *by_load = &found->by_load[joint];
        ASSERT_CLOSE(1.0, by_load->space.k_xx_n_per_mm / by_load->plane.k_xx_n_per_mm, SAME_RATIO);
        ASSERT_CLOSE(1.0, by_load->space.k_zz_n_per_mm / by_load->plane.k_zz_n_per_mm, SAME_RATIO);
    }
}

/* Across the plane only the coxa joint measures the load. */
static void test_of_a_limb_in_space_the_coxa_joint_s_load_counts_beside_a_sensor(void)
{
    yields_across_its_plane();
    bench_start(&parameters);
    fake.joint[BRACE_COXA].absent = false;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    fake.force_x_n = -5.0f;
    ticks(500);
    TEST_ASSERT_TRUE(now()->force_is_sensed && now()->load.is_counted);
    const brace_k_sigma_t least = by_parameters_in_space();
    expect_same(least.plane.k_xx_n_per_mm, reported().k_xx_n_per_mm);
    expect_same(least.plane.lambda_min_n_per_mm, reported().lambda_min_n_per_mm);
    expect_same(least.space.k_xy_n_per_mm, now()->sigma_space.k_xy_n_per_mm);
    expect_same(least.space.k_yy_n_per_mm, now()->sigma_space.k_yy_n_per_mm);
    expect_same(least.space.lambda_n_per_mm[2], now()->sigma_space.lambda_n_per_mm[2]);
    expect_same(least.space.across_n_per_mm, now()->sigma_space.across_n_per_mm);
    fake.joint[BRACE_COXA].sample.torque_n_mm = -4000.0f;
    ticks(3);
    TEST_ASSERT_TRUE(reported().k_xx_n_per_mm > 1.01f * least.plane.k_xx_n_per_mm ||
                     reported().k_zz_n_per_mm > 1.01f * least.plane.k_zz_n_per_mm ||
                     now()->sigma_space.k_yy_n_per_mm > 1.01f * least.space.k_yy_n_per_mm);
}

/* A limb that is turned as a whole, and its load with it, is as uncertain as before: also where the stiff axis of one K
 * points up and that of the other down, which is the same way. */
static void test_a_limb_that_is_turned_is_as_uncertain(void)
{
    const float half_turn_rad = 3.14159265f;
    parameters.drive[BRACE_FEMUR].motor_friction_n_mm = parameters.drive[BRACE_TIBIA].motor_friction_n_mm = 2000.0f;
    start_carrying(-2000.0f, 1500.0f);
    const brace_stiffness_sigma_t sigma = reported();
    const float upright_rad = 0.5f * half_turn_rad - now()->stiffness.engaged.stiff_axis_rad;
    for (int i = -20; i <= 20; i++) {
        const float turn_rad = upright_rad + 0.01f * (float)i, theta1_rad = 1.0f + turn_rad;
        fake.joint[BRACE_FEMUR].sample.motor_rad = theta1_rad > 3.0f ? theta1_rad - half_turn_rad : theta1_rad;
        bench_believe();
        ticks(100);
        ASSERT_CLOSE(sigma.stiff_axis_rad, reported().stiff_axis_rad, 1e-3 + 1e-2 * (double)sigma.stiff_axis_rad);
        ASSERT_CLOSE(sigma.lambda_max_n_per_mm, reported().lambda_max_n_per_mm,
                     1e-2 * (double)sigma.lambda_max_n_per_mm);
    }
}

static void test_without_a_valid_K_there_is_no_sigma(void)
{
    bench_start(&parameters);
    expect_not_known();
    ticks(100);
    TEST_ASSERT_TRUE(now()->sigma_is_known);
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(30);
    TEST_ASSERT_FALSE(now()->k_is_valid);
    expect_not_known();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_sensed_load_leaves_open_what_the_parameters_do);
    RUN_TEST(test_a_load_by_the_joints_that_stands_leaves_open_the_same);
    RUN_TEST(test_what_the_friction_of_the_motors_may_hold_counts);
    RUN_TEST(test_a_load_that_the_mean_has_not_followed_counts_from_its_first_sample_on);
    RUN_TEST(test_once_three_samples_report_another_load_all_of_it_counts);
    RUN_TEST(test_it_counts_less_as_the_mean_follows_and_no_more_once_it_has);
    RUN_TEST(test_a_joint_with_play_has_a_mean_of_its_own);
    RUN_TEST(test_a_spring_that_hardens_does_so_by_the_newest_load);
    RUN_TEST(test_what_accelerates_a_motor_is_load_too);
    RUN_TEST(test_a_motor_that_keeps_its_speed_carries_its_torque);
    RUN_TEST(test_an_encoder_behind_the_gear_reports_no_acceleration_of_the_motor);
    RUN_TEST(test_a_load_by_fewer_than_five_samples_leaves_all_open);
    RUN_TEST(test_a_joint_that_may_stand_anywhere_in_its_gap_counts_with_its_angle);
    RUN_TEST(test_a_newest_load_without_an_equilibrium_leaves_all_open);
    RUN_TEST(test_a_load_in_the_plane_counts_in_space_as_in_the_plane);
    RUN_TEST(test_of_a_limb_in_space_the_coxa_joint_s_load_counts_beside_a_sensor);
    RUN_TEST(test_a_limb_that_is_turned_is_as_uncertain);
    RUN_TEST(test_without_a_valid_K_there_is_no_sigma);
    return UNITY_END();
}
