/* Force on the tip: from the sensor, its model undone, or from what the joints carry. */
#include "loading_bench.h"

/* What the controller would give the backlash machine of a joint, if the force is known. */
static void expect(int index, brace_backlash_sample_t *sample)
{
    const controller_t *c = &app.controller;
    if (c->tip_force.known && c->posture.has_levers) {
        flank_expect_load(sample, index, &c->tip_force, &c->posture, c->gravity.down, &c->parameters.in_force);
    }
}

void setUp(void)
{
    const brace_parameters_t p = bench_parameters();
    stand(&p);
}

void tearDown(void) {}

/* Levers are those of motors 8 mrad away: 1e-2. The bench's world knows no bent levers; the controller's count that 9 N
 * bend the limb by up to 20 mm of 450 mm. */
#define SLOPE_ERROR 5e-2

/* A limb that hardly yields: the bench's world knows no bent levers. */
static brace_parameters_t rigid_parameters(void)
{
    brace_parameters_t p = bench_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.limb.link[i].axial_mm_per_n *= 1e-3f;
        p.limb.link[i].bending_mm_per_n *= 1e-3f;
        p.limb.joint[i].compliance_rad_per_n_mm *= 1e-3f;
    }
    return p;
}

static void test_without_a_sensor_the_joints_measure_the_force_less_gravity(void)
{
    brace_parameters_t p = rigid_parameters();
    p.gravity.tibia_n = 2.0f;
    stand(&p);
    weight_n = 2.0;
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(200);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    ASSERT_CLOSE(1.0, now()->force_x_n, 0.01);
    ASSERT_CLOSE(6.0, now()->force_z_n, 0.01);
    p = bench_parameters();
    stand(&p);
    brace_fake_without_force(&fake);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(200);
    run(&along_x);
    TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome);
    TEST_ASSERT_FALSE(result()->force_is_sensed);
    ASSERT_CLOSE(3.5, result()->least_squares.k_x_n_per_mm, 3.5 * SLOPE_ERROR);
}

static void test_the_sensed_force_says_what_the_joints_should_carry(void)
{
    brace_parameters_t p = rigid_parameters();
    p.gravity.tibia_n = 2.0f;
    stand(&p);
    weight_n = 2.0;
    ticks(3);
    for (int i = 0; i < 2; i++) {
        brace_backlash_sample_t sample = {.load_is_expected = false};
        expect(BRACE_FEMUR + i, &sample);
        TEST_ASSERT_TRUE(sample.load_is_expected);
        ASSERT_CLOSE(fake.joint[BRACE_FEMUR + i].sample.torque_n_mm, sample.expected_n_mm, 1.0);
        TEST_ASSERT_TRUE(sample.expected_off_n_mm > 0.0f);
    }
    brace_fake_fail_next(&fake, BRACE_FAKE_TIP_FORCE_READ, 1, BRACE_HAL_E_DEVICE);
    ticks(1);
    brace_backlash_sample_t sample = {.load_is_expected = false};
    expect(BRACE_FEMUR + 0, &sample);
    TEST_ASSERT_FALSE(sample.load_is_expected);
}

/* Six sigma of each of the sensor's components through the joint's lever; the tip's from the joints' axes. */
static void test_the_sensor_s_noise_is_in_what_the_expected_load_may_be_off_by(void)
{
    const double tip_x = femur_mm * cos(1.0) + tibia_mm * cos(1.0 - 1.4),
                 tip_z = femur_mm * sin(1.0) + tibia_mm * sin(1.0 - 1.4);
    const double from_x[2] = {tip_x, tip_x - femur_mm * cos(1.0)}, from_z[2] = {tip_z, tip_z - femur_mm * sin(1.0)};
    float off_n_mm[2][2];
    for (int quiet = 0; quiet < 2; quiet++) {
        brace_parameters_t p = rigid_parameters();
        p.sensor.noise_n = quiet ? 0.0f : 0.5f;
        stand(&p);
        for (int i = 0; i < 2; i++) {
            brace_backlash_sample_t sample = {.load_is_expected = false};
            expect(BRACE_FEMUR + i, &sample);
            TEST_ASSERT_TRUE(sample.load_is_expected);
            off_n_mm[quiet][i] = sample.expected_off_n_mm;
        }
    }
    for (int i = 0; i < 2; i++) {
        ASSERT_CLOSE(6.0 * 0.5 * (fabs(from_x[i]) + fabs(from_z[i])), off_n_mm[0][i] - off_n_mm[1][i], 1.0);
    }
}

/* Dry friction holds up to coulomb + ratio * |spring's torque|, with the spring carrying the load and the friction:
 * solved here step by step. */
static void test_dry_friction_is_in_it_the_constant_and_the_load_s_share(void)
{
    static const double constant_n_mm[] = {0.0, 40.0, 0.0, 40.0}, ratio[] = {0.0, 0.0, 0.2, 0.2};
    float none_n_mm[2] = {0.0f};
    for (int i = 0; i < 4; i++) {
        brace_parameters_t p = bench_parameters();
        p.gravity.tibia_n = 2.0f;
        for (int j = 0; j < 2; j++) {
            p.drive[BRACE_FEMUR + j].coulomb_n_mm = (float)constant_n_mm[i];
            p.drive[BRACE_FEMUR + j].coulomb_per_load_ratio = (float)ratio[i];
        }
        stand(&p);
        for (int j = 0; j < 2; j++) {
            brace_backlash_sample_t sample = {.load_is_expected = false};
            expect(BRACE_FEMUR + j, &sample);
            TEST_ASSERT_TRUE(sample.load_is_expected);
            none_n_mm[j] = i == 0 ? sample.expected_off_n_mm : none_n_mm[j];
            double friction_n_mm = 0.0;
            for (int step = 0; step < 60; step++) {
                friction_n_mm = constant_n_mm[i] + ratio[i] * (fabs((double)sample.expected_n_mm) + friction_n_mm);
            }
            TEST_ASSERT_TRUE(fabsf(sample.expected_n_mm) > 50.0f);
            ASSERT_CLOSE(friction_n_mm, sample.expected_off_n_mm - none_n_mm[j], 1.0);
        }
    }
}

static void test_the_sensor_model_is_undone(void)
{
    brace_parameters_t p = bench_parameters();
    p.sensor.bias_x_n = 0.4f;
    p.sensor.bias_z_n = -0.3f;
    p.sensor.gain = 1.1f;
    p.sensor.rotation_rad = 0.2f;
    p.sensor.crosstalk_xz = 0.05f;
    p.sensor.crosstalk_zx = -0.03f;
    bench_start(&p);
    const double fx = 2.0, fz = 7.0, mx = fx + 0.05 * fz, mz = -0.03 * fx + fz;
    fake.force_x_n = (float)(0.4 + 1.1 * (cos(0.2) * mx - sin(0.2) * mz));
    fake.force_z_n = (float)(-0.3 + 1.1 * (sin(0.2) * mx + cos(0.2) * mz));
    ticks(3);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
    ASSERT_CLOSE(2.0, now()->force_x_n, 1e-5);
    ASSERT_CLOSE(7.0, now()->force_z_n, 1e-5);
}

static void test_a_saturated_or_silent_sensor_is_not_used(void)
{
    brace_parameters_t p = bench_parameters();
    p.sensor.saturation_n = 20.0f;
    bench_start(&p);
    fake.force_z_n = 20.0f;
    ticks(3);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    fake.force_z_n = 19.0f;
    ticks(1);
    TEST_ASSERT_TRUE(now()->force_is_sensed);
    fake.force_x_n = (float)NAN;
    ticks(1);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
    fake.force_x_n = 0.0f;
    brace_fake_fail_next(&fake, BRACE_FAKE_TIP_FORCE_READ, 5, BRACE_HAL_E_DEVICE);
    ticks(1);
    TEST_ASSERT_FALSE(now()->force_is_sensed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_a_sensor_the_joints_measure_the_force_less_gravity);
    RUN_TEST(test_the_sensed_force_says_what_the_joints_should_carry);
    RUN_TEST(test_the_sensor_s_noise_is_in_what_the_expected_load_may_be_off_by);
    RUN_TEST(test_dry_friction_is_in_it_the_constant_and_the_load_s_share);
    RUN_TEST(test_the_sensor_model_is_undone);
    RUN_TEST(test_a_saturated_or_silent_sensor_is_not_used);
    return UNITY_END();
}
