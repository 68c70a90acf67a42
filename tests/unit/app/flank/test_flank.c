/* Tests of the watch over the flanks (flank/flank.h): the bounds that it gives the backlash machine, the load that it
 * lets the machine expect, what it says of a joint without play or without a watch, and how far the load lags. */
#include <math.h>
#include <string.h>

#include "flank/flank.h"
#include "unity.h"

static flank_t flank;
static joints_t joints;
static posture_t posture;
static tip_force_t force;
static brace_parameters_t parameters;
static const brace_vec3_t down = {0.0f, 0.0f, -1.0f};

void setUp(void)
{
    memset(&flank, 0, sizeof flank);
    memset(&joints, 0, sizeof joints);
    memset(&posture, 0, sizeof posture);
    memset(&force, 0, sizeof force);
    memset(&parameters, 0, sizeof parameters);
    parameters.controller.tick_us = 1000;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        parameters.drive[i] = (brace_drive_t){.torque_range_n_mm = 10000.0f,
                                              .torque_noise_n_mm = 10.0f,
                                              .torque_bias_n_mm = 10.0f,
                                              .motor_friction_n_mm = 20.0f,
                                              .motor_friction_tolerance_ratio = 0.2f,
                                              .angle_step_rad = 1e-5f,
                                              .takeup_torque_n_mm = 4000.0f};
        parameters.limb.joint[i] = (brace_joint_t){.compliance_rad_per_n_mm = 1e-5f, .gap_rad = 0.02f};
        joints.joint[i] = (joint_t){.fitted = true,
                                    .sound = true,
                                    .is_new_enough_to_prove_a_flank = true,
                                    .torque_n_mm = 50.0f * (float)(i + 1)};
    }
}

void tearDown(void) {}

static void configure(void)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        flank_configure(&flank, i, &joints, &parameters);
    }
}

static void tick(void)
{
    static uint32_t now_us;
    now_us += 1000u;
    flank_tick(&flank, &joints, &force, &posture, down, &parameters, false, now_us);
}

/* The gap and three tenths of it, what the spring gives way by, and 4 mrad; 1 rad at most; 0.2 rad more for a servo
 * that gives way. */
static void test_a_takeup_goes_as_far_as_gap_and_spring(void)
{
    static const float gap_rad[] = {0.02f, 0.3f, 0.4f}, travel_rad[] = {0.026f + 0.044f, 0.39f + 0.044f, 1.0f};
    for (int i = 0; i < 3; i++) {
        for (int joint = 0; joint < BRACE_LINK_COUNT; joint++) {
            parameters.limb.joint[joint].gap_rad = gap_rad[i];
            parameters.limb.joint[joint].compliance_rad_per_n_mm = i < 2 ? 1e-5f : 2e-4f;
            flank_configure(&flank, joint, &joints, &parameters);
            const brace_takeup_bounds_t *bounds = &flank.joint[joint].machine.params.takeup;
            TEST_ASSERT_TRUE(flank.joint[joint].watched);
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, travel_rad[i], bounds->travel_max_rad);
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, travel_rad[i] + 0.2f, bounds->reach_max_rad);
            TEST_ASSERT_EQUAL_FLOAT(4000.0f, bounds->torque_max_n_mm);
            TEST_ASSERT_EQUAL_FLOAT(0.1f, bounds->rate_rad_per_s);
            TEST_ASSERT_EQUAL_UINT32(8000000u, bounds->time_max_us);
            TEST_ASSERT_EQUAL_UINT32(100000u, bounds->verify_us);
            TEST_ASSERT_EQUAL_FLOAT(gap_rad[i], flank.joint[joint].machine.params.gap_rad);
        }
    }
}

/* Whatever it was before: nothing is known of a joint that is not there. */
static void test_a_joint_that_is_not_fitted_has_no_flank(void)
{
    configure();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        joints.joint[i].fitted = false;
        flank.joint[i].out.valid = true;
    }
    tick();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        TEST_ASSERT_FALSE(flank.joint[i].out.valid);
    }
}

/* Every joint's machine has its own joint's and drive's numbers. */
static void test_a_machine_has_its_joint_s_numbers(void)
{
    parameters.controller.tick_us = 2000;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const float n = (float)(i + 1);
        parameters.drive[i] = (brace_drive_t){.torque_range_n_mm = 9000.0f + n,
                                              .torque_noise_n_mm = 10.0f + n,
                                              .torque_bias_n_mm = 20.0f + n,
                                              .motor_friction_n_mm = 30.0f + n,
                                              .motor_friction_tolerance_ratio = 0.1f * n,
                                              .angle_step_rad = 1e-5f * n,
                                              .motor_inertia_n_mm_s2_per_rad = 5.0f + n,
                                              .takeup_torque_n_mm = 4000.0f + n};
        parameters.limb.joint[i].gap_rad = 0.02f + 0.001f * n;
    }
    configure();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const brace_backlash_params_t *p = &flank.joint[i].machine.params;
        const brace_drive_t *drive = &parameters.drive[i];
        TEST_ASSERT_TRUE(flank.joint[i].watched);
        TEST_ASSERT_EQUAL_UINT32(2000, p->tick_us);
        TEST_ASSERT_EQUAL_FLOAT(parameters.limb.joint[i].gap_rad, p->gap_rad);
        TEST_ASSERT_EQUAL_FLOAT(drive->motor_friction_n_mm, p->friction_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(drive->motor_friction_tolerance_ratio, p->friction_tolerance_ratio);
        TEST_ASSERT_EQUAL_FLOAT(drive->motor_inertia_n_mm_s2_per_rad, p->inertia_n_mm_s2_per_rad);
        TEST_ASSERT_EQUAL_FLOAT(drive->torque_range_n_mm, p->torque_range_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(drive->torque_noise_n_mm, p->torque_noise_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(drive->torque_bias_n_mm, p->torque_bias_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(drive->angle_step_rad, p->angle_step_rad);
        TEST_ASSERT_EQUAL_FLOAT(drive->takeup_torque_n_mm, p->takeup.torque_max_n_mm);
    }
}

static void test_what_has_play_and_is_watched(void)
{
    parameters.limb.joint[BRACE_COXA].gap_rad = 0.99e-5f;
    parameters.limb.joint[BRACE_FEMUR].gap_rad = 1.01e-5f;
    parameters.drive[BRACE_FEMUR].torque_range_n_mm = 0.0f; /* the watch needs the drive's torque */
    configure();
    TEST_ASSERT_FALSE(flank.joint[BRACE_COXA].has_play || flank.joint[BRACE_COXA].watched);
    TEST_ASSERT_TRUE(flank.joint[BRACE_FEMUR].has_play && !flank.joint[BRACE_FEMUR].watched);
    TEST_ASSERT_TRUE(flank.joint[BRACE_TIBIA].has_play && flank.joint[BRACE_TIBIA].watched);
    joints.joint[BRACE_TIBIA].fitted = false;
    configure();
    TEST_ASSERT_FALSE(flank.joint[BRACE_TIBIA].has_play || flank.joint[BRACE_TIBIA].watched);
}

static void test_joints_that_are_not_watched(void)
{
    parameters.limb.joint[BRACE_COXA].gap_rad = 0.0f;
    parameters.drive[BRACE_FEMUR].torque_range_n_mm = 0.0f;
    joints.joint[BRACE_TIBIA].fitted = false;
    configure();
    for (int sound = 0; sound < 2; sound++) {
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            joints.joint[i].sound = sound != 0;
        }
        tick();
        /* the coxa joint has no play, so its place is known */
        TEST_ASSERT_EQUAL(sound != 0, flank.joint[BRACE_COXA].out.valid);
        TEST_ASSERT_EQUAL_FLOAT(50.0f, flank.joint[BRACE_COXA].out.load_n_mm);
        TEST_ASSERT_FALSE(flank.joint[BRACE_FEMUR].out.valid); /* the joint may stand anywhere in its gap */
        TEST_ASSERT_EQUAL_FLOAT(0.01f, flank.joint[BRACE_FEMUR].out.offset_off_rad);
        TEST_ASSERT_EQUAL_FLOAT(100.0f, flank.joint[BRACE_FEMUR].out.load_n_mm);
        TEST_ASSERT_FALSE(flank.joint[BRACE_TIBIA].out.valid);
        TEST_ASSERT_EQUAL_HEX32(1u << BRACE_FEMUR, flank_open_gaps(&flank));
    }
}

/* What the tip's force and the weight make, and how far that may be off: six sigmas of the sensor on both levers, a
 * fiftieth and six sigmas of its gain, and what friction may hide. */
static void test_the_load_that_is_expected(void)
{
    parameters.gravity = (brace_gravity_t){.femur_n = 2.0f, .knee_n = 1.0f, .tibia_n = 1.5f};
    parameters.sensor.noise_n = 0.2f;
    parameters.limb.uncertainty.gain_rel = 0.005f;
    posture.pose.knee = (brace_point_t){100.0f, 50.0f}, posture.pose.tip = (brace_point_t){250.0f, -80.0f};
    posture.pose.lever_femur = (brace_point_t){80.0f, 250.0f};
    posture.pose.lever_tibia = (brace_point_t){130.0f, 150.0f};
    force.x_n = 3.0f, force.z_n = -8.0f;
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        parameters.drive[joint].coulomb_n_mm = 30.0f;
        parameters.drive[joint].coulomb_per_load_ratio = 0.1f;
        brace_backlash_sample_t sample = {.load_is_expected = false};
        const int held = flank_expect_load(&sample, joint, &force, &posture, down, &parameters);
        TEST_ASSERT_EQUAL((sample.expected_n_mm > sample.expected_off_n_mm) -
                              (sample.expected_n_mm < -sample.expected_off_n_mm),
                          held);
        const double weighs = joint == BRACE_FEMUR ? 1.0 * 100.0 + 1.0 * 100.0 + 1.5 * 175.0 : -1.5 * 75.0;
        const double turns = joint == BRACE_FEMUR ? -(80.0 * 3.0 - 250.0 * 8.0) : 130.0 * 3.0 - 150.0 * 8.0;
        const double wanted = weighs + turns, levers = joint == BRACE_FEMUR ? 330.0 : 280.0;
        const double off = 6.0 * 0.2 * levers + (0.02 + 6.0 * 0.005) * fabs(wanted) + (30.0 + 0.1 * fabs(wanted)) / 0.9;
        TEST_ASSERT_TRUE(sample.load_is_expected);
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, wanted, (double)sample.expected_n_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, off, (double)sample.expected_off_n_mm);
    }
}

/* The tip's sensor shows a load of 21 N mm. The motor's torque alone cannot show it, because friction hides it. With
 * the sensor the machine names the flank; without the sensor it names none. */
static void test_an_expected_load_names_a_flank(void)
{
    posture.has_levers = true;
    posture.pose.lever_tibia = (brace_point_t){130.0f, 150.0f};
    force.z_n = 0.14f;
    joints.joint[BRACE_TIBIA].sample.torque_n_mm = 5.0f;
    for (int known = 0; known < 2; known++) {
        force.known = known != 0;
        configure();
        for (int i = 0; i < 1000; i++) {
            tick();
        }
        TEST_ASSERT_EQUAL(known, flank.joint[BRACE_TIBIA].out.flank);
    }
}

/* The root of the mean square of what three samples are away from the mean, on the newest one's side. */
static void test_how_far_a_load_lags(void)
{
    configure();
    for (int watched = 0; watched < 2; watched++) {
        flank.joint[BRACE_FEMUR].watched = watched != 0;
        flank.joint[BRACE_FEMUR].machine.torque_n_mm = 200.0f;
        joints.joint[BRACE_FEMUR].torque_n_mm = 100.0f;
        const float mean = watched != 0 ? 200.0f : 100.0f;
        const float carries[] = {mean + 10.0f, mean - 20.0f, mean + 5.0f};
        memcpy(joints.joint[BRACE_FEMUR].carries_n_mm, carries, sizeof carries);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, sqrtf(525.0f / 3.0f), flank_lag_n_mm(&flank, &joints, BRACE_FEMUR));
        joints.joint[BRACE_FEMUR].carries_n_mm[0] = mean - 10.0f;
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, -sqrtf(525.0f / 3.0f), flank_lag_n_mm(&flank, &joints, BRACE_FEMUR));
    }
}

/* A sample that is too old puts the machine into FAULT, from which it comes back by itself. */
static void test_an_old_sample_proves_nothing(void)
{
    configure();
    for (int i = 0; i < 200; i++) {
        tick();
    }
    TEST_ASSERT_NOT_EQUAL(BRACE_BACKLASH_FAULT, flank.joint[BRACE_TIBIA].out.state);
    joints.joint[BRACE_TIBIA].is_new_enough_to_prove_a_flank = false;
    for (int i = 0; i < 20; i++) {
        tick();
    }
    TEST_ASSERT_EQUAL(BRACE_BACKLASH_FAULT, flank.joint[BRACE_TIBIA].out.state);
    TEST_ASSERT_FALSE(flank.joint[BRACE_TIBIA].out.valid);
    TEST_ASSERT_NOT_EQUAL(BRACE_BACKLASH_FAULT, flank.joint[BRACE_FEMUR].out.state);
    joints.joint[BRACE_TIBIA].is_new_enough_to_prove_a_flank = true;
    for (int i = 0; i < 200; i++) {
        tick();
    }
    TEST_ASSERT_NOT_EQUAL(BRACE_BACKLASH_FAULT, flank.joint[BRACE_TIBIA].out.state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_joint_that_is_not_fitted_has_no_flank);
    RUN_TEST(test_a_takeup_goes_as_far_as_gap_and_spring);
    RUN_TEST(test_a_machine_has_its_joint_s_numbers);
    RUN_TEST(test_what_has_play_and_is_watched);
    RUN_TEST(test_joints_that_are_not_watched);
    RUN_TEST(test_the_load_that_is_expected);
    RUN_TEST(test_an_expected_load_names_a_flank);
    RUN_TEST(test_how_far_a_load_lags);
    RUN_TEST(test_an_old_sample_proves_nothing);
    return UNITY_END();
}
