/* Each number of a drive reaches the core under its own name. */
#include <string.h>

#include "brace/play_parameters.h"
#include "unity.h"

static brace_parameters_t parameters;

void setUp(void)
{
    memset(&parameters, 0, sizeof parameters);
    parameters.limb.joint[BRACE_TIBIA] = (brace_joint_t){.compliance_rad_per_n_mm = 1e-6f, .gap_rad = 0.01f};
    parameters.limb.uncertainty.gain_rel = 0.21f;
    parameters.sensor.noise_n = 0.22f;
    parameters.controller.tick_us = 1000;
    parameters.drive[BRACE_TIBIA] = (brace_drive_t){.coulomb_n_mm = 1.0f,
                                                    .coulomb_per_load_ratio = 0.02f,
                                                    .motor_friction_n_mm = 3.0f,
                                                    .motor_friction_per_torque_ratio = 0.04f,
                                                    .motor_friction_per_load_ratio = 0.05f,
                                                    .motor_friction_tolerance_ratio = 0.06f,
                                                    .motor_friction_sliding_ratio = 0.07f,
                                                    .motor_inertia_n_mm_s2_per_rad = 8.0f,
                                                    .torque_range_n_mm = 9000.0f,
                                                    .torque_noise_n_mm = 10.0f,
                                                    .torque_bias_n_mm = 11.0f,
                                                    .angle_step_rad = 0.012f,
                                                    .takeup_torque_n_mm = 500.0f};
}

void tearDown(void) {}

static void test_the_gear_has_each_number_of_its_drive(void)
{
    const brace_gear_t gear = brace_gear(&parameters, BRACE_TIBIA);
    TEST_ASSERT_EQUAL_FLOAT(3.0f, gear.friction_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.04f, gear.per_torque_ratio);
    TEST_ASSERT_EQUAL_FLOAT(0.05f, gear.per_load_ratio);
    TEST_ASSERT_EQUAL_FLOAT(0.06f, gear.tolerance_ratio);
    TEST_ASSERT_EQUAL_FLOAT(0.07f, gear.sliding_ratio);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, gear.joint_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.02f, gear.joint_per_load_ratio);
}

static void test_the_play_under_load_has_each_number_of_its_joint(void)
{
    const brace_play_joint_t joint = brace_play_joint(&parameters, BRACE_TIBIA);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, joint.coulomb_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.02f, joint.coulomb_per_load_ratio);
    TEST_ASSERT_EQUAL_FLOAT(0.22f, joint.noise_n);
    TEST_ASSERT_EQUAL_FLOAT(0.21f, joint.gain_rel);
}

static void test_the_watched_play_has_each_number_of_its_joint(void)
{
    const brace_backlash_params_t watched = brace_play_watched(&parameters, BRACE_TIBIA);
    TEST_ASSERT_EQUAL_UINT32(1000, watched.tick_us);
    TEST_ASSERT_EQUAL_FLOAT(0.01f, watched.gap_rad);
    TEST_ASSERT_EQUAL_FLOAT(3.0f, watched.friction_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.06f, watched.friction_tolerance_ratio);
    TEST_ASSERT_EQUAL_FLOAT(8.0f, watched.inertia_n_mm_s2_per_rad);
    TEST_ASSERT_EQUAL_FLOAT(9000.0f, watched.torque_range_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(10.0f, watched.torque_noise_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(11.0f, watched.torque_bias_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.012f, watched.angle_step_rad);
    TEST_ASSERT_EQUAL_FLOAT(500.0f, watched.takeup.torque_max_n_mm);
}

static void test_the_take_up_goes_as_far_as_gap_and_spring_need(void)
{
    brace_takeup_bounds_t bounds = brace_play_watched(&parameters, BRACE_TIBIA).takeup;
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.3f * 0.01f + 500.0f * 1e-6f + 0.004f, bounds.travel_max_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, bounds.travel_max_rad + 0.2f, bounds.reach_max_rad);
    parameters.limb.joint[BRACE_TIBIA].gap_rad = 2.0f;
    bounds = brace_play_watched(&parameters, BRACE_TIBIA).takeup;
    TEST_ASSERT_EQUAL_FLOAT(1.0f, bounds.travel_max_rad);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_gear_has_each_number_of_its_drive);
    RUN_TEST(test_the_play_under_load_has_each_number_of_its_joint);
    RUN_TEST(test_the_watched_play_has_each_number_of_its_joint);
    RUN_TEST(test_the_take_up_goes_as_far_as_gap_and_spring_need);
    return UNITY_END();
}
