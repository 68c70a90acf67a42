/* When a joint's sensor counts as frozen: each of the five proofs at its bound, just within and just beyond, from
 * samples that are made up here. tests/unit/app/test_app_frozen.c plays them through the controller. */
#include <math.h>
#include <string.h>

#include "unity.h"
#include "watch/frozen.h"

enum { LOOK_US = 50000 };

static frozen_t frozen;
static joints_t joints;
static posture_t posture;
static tip_force_t force;
static brace_parameters_t parameters;
static float commanded_offset_rad[BRACE_LINK_COUNT], limit_n_mm[BRACE_LINK_COUNT];
static uint32_t now_us;

void setUp(void)
{
    memset(&joints, 0, sizeof joints);
    memset(&posture, 0, sizeof posture);
    memset(&force, 0, sizeof force);
    memset(&parameters, 0, sizeof parameters);
    now_us = 1000000u;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        joints.joint[i] = (joint_t){.fitted = true, .sound = true, .samples_seen = 3};
        joints.joint[i].sample = (brace_hal_joint_t){
            .motor_rad = 1.0f, .link_rad = NAN, .torque_n_mm = 10.0f, .temp_degc = NAN, .taken_us = now_us};
        parameters.drive[i] = (brace_drive_t){.torque_range_n_mm = 8000.0f,
                                              .torque_noise_n_mm = 5.0f,
                                              .motor_friction_n_mm = 40.0f,
                                              .angle_step_rad = 0.001f};
        parameters.limb.joint[i] = (brace_joint_t){.compliance_rad_per_n_mm = 1e-5f, .gap_rad = 0.02f};
        commanded_offset_rad[i] = 0.0f, limit_n_mm[i] = INFINITY;
    }
    frozen_start(&frozen);
}

void tearDown(void) {}

/* A new sample of every joint, and a look at each. */
static bool look(uint32_t after_us)
{
    const frozen_inputs_t inputs = {.joints = &joints,
                                    .posture = &posture,
                                    .force = &force,
                                    .parameters = &parameters,
                                    .down = {0.0f, 0.0f, -1.0f},
                                    .commanded_offset_rad = commanded_offset_rad,
                                    .limit_n_mm = limit_n_mm};
    now_us += after_us;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        joints.joint[i].sample.taken_us = now_us;
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        frozen_watch(&frozen, &inputs);
    }
    return frozen_any(&frozen);
}

static bool looks(int count)
{
    bool is_frozen = false;
    for (int i = 0; i < count; i++) {
        is_frozen = look(LOOK_US);
    }
    return is_frozen;
}

/* All joints but one move a little in each look, so that only that one can be frozen. */
static bool others_move(int joint, int count, float each_rad)
{
    bool is_frozen = false;
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < BRACE_LINK_COUNT; j++) {
            joints.joint[j].sample.motor_rad += j == joint ? 0.0f : 0.01f;
        }
        commanded_offset_rad[joint] += each_rad;
        is_frozen = look(LOOK_US);
    }
    return is_frozen;
}

static void test_a_joint_that_rests_is_not_frozen(void)
{
    TEST_ASSERT_FALSE(looks(50));
}

/* Proof `commanded`: the controller commands the motor to move by more than 5 mrad and ten steps, and neither the angle
 * nor the torque changes by a bit. This has to last 250 ms. */
static void test_commanded_to_move(void)
{
    for (int joint = 0; joint < BRACE_LINK_COUNT; joint++) {
        setUp();
        TEST_ASSERT_FALSE(others_move(joint, 3, 0.0f));
        commanded_offset_rad[joint] = 0.0099f; /* ten steps are 10 mrad */
        TEST_ASSERT_FALSE(others_move(joint, 20, 0.0f));
        commanded_offset_rad[joint] = 0.0101f;
        TEST_ASSERT_FALSE(others_move(joint, 4, 0.0f));
        TEST_ASSERT_TRUE(others_move(joint, 1, 0.0f));
        joints.joint[joint].sample.torque_n_mm += 0.001f; /* the drive measures a change */
        TEST_ASSERT_FALSE(others_move(joint, 1, 0.0f));
        setUp();
        parameters.drive[joint].angle_step_rad = 1e-5f;
        TEST_ASSERT_FALSE(others_move(joint, 3, 0.0f));
        commanded_offset_rad[joint] = 0.0049f;
        TEST_ASSERT_FALSE(others_move(joint, 20, 0.0f));
        commanded_offset_rad[joint] = -0.0052f; /* from there to here, and from 0 */
        TEST_ASSERT_FALSE(others_move(joint, 4, 0.0f));
        TEST_ASSERT_TRUE(others_move(joint, 1, 0.0f));
        setUp();
        joints.joint[joint].torque_n_mm = 0.81f * 1000.0f; /* four fifths of the limit: the drive has no torque left */
        limit_n_mm[joint] = 1000.0f;
        TEST_ASSERT_FALSE(others_move(joint, 30, 0.01f));
        joints.joint[joint].torque_n_mm = -0.79f * 1000.0f;
        TEST_ASSERT_TRUE(others_move(joint, 30, 0.01f));
    }
}

/* Each look adds 60 ms at most, however long ago the look before was. */
static void test_a_look_counts_for_a_while(void)
{
    looks(3);
    commanded_offset_rad[BRACE_TIBIA] = 0.02f;
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(look(1000000u));
    }
    TEST_ASSERT_TRUE(look(1000000u));
}

/* What the tip's sensor says of a load on the femur joint; lever 100 mm. */
static void press(float z_n)
{
    force.known = true;
    posture.has_levers = true;
    posture.pose.lever_femur = (brace_point_t){0.0f, 100.0f};
    force.z_n = z_n;
}

/* Proof `loaded`: the load changes by more than four times friction (there and back, known to a factor of two), the
 * noise of both sensors and a fifth of the load together. */
static void test_a_load_that_is_not_felt(void)
{
    parameters.sensor.noise_n = 0.1f;
    /* 4 * 40 + 12 * (5 + 0.1 * 100) = 340 N mm, and a fifth of the load itself: the bound is 425 N mm */
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        parameters.sensor.noise_n = 0.1f;
        press(0.0f);
        TEST_ASSERT_FALSE(others_move(BRACE_FEMUR, 3, 0.0f));
        press((float)sign * 4.2f);
        TEST_ASSERT_FALSE(others_move(BRACE_FEMUR, 30, 0.0f));
        press((float)sign * 4.3f);
        TEST_ASSERT_FALSE(others_move(BRACE_FEMUR, 4, 0.0f));
        TEST_ASSERT_TRUE(others_move(BRACE_FEMUR, 1, 0.0f));
        force.known = false; /* an unknown load proves nothing */
        TEST_ASSERT_FALSE(others_move(BRACE_FEMUR, 30, 0.0f));
    }
}

/* A joint's own friction hides a load beside the motor's, and so does the part of it that grows with the load: with
 * 4 * (40 + 25 + 0.05 of the load) + 12 * (5 + 0.1 * 100) and a fifth of the load the bound is 733 N mm. */
static void test_the_joint_s_friction_hides_a_load(void)
{
    parameters.sensor.noise_n = 0.1f;
    parameters.drive[BRACE_FEMUR].coulomb_n_mm = 25.0f;
    parameters.drive[BRACE_FEMUR].coulomb_per_load_ratio = 0.05f;
    press(0.0f);
    TEST_ASSERT_FALSE(others_move(BRACE_FEMUR, 3, 0.0f));
    press(7.3f);
    TEST_ASSERT_FALSE(others_move(BRACE_FEMUR, 30, 0.0f));
    press(7.36f);
    TEST_ASSERT_TRUE(others_move(BRACE_FEMUR, 5, 0.0f));
}

/* Each joint's sensor noise comes by its own lever. */
static void test_a_load_on_the_tibia_joint_that_is_not_felt(void)
{
    parameters.sensor.noise_n = 0.1f;
    press(0.0f);
    posture.pose.lever_femur = (brace_point_t){0.0f, 1000.0f}; /* there the bound is 1,775 N mm, */
    posture.pose.lever_tibia = (brace_point_t){0.0f, 100.0f}; /* here 425 */
    TEST_ASSERT_FALSE(others_move(BRACE_TIBIA, 3, 0.0f));
    force.z_n = 4.2f;
    TEST_ASSERT_FALSE(others_move(BRACE_TIBIA, 30, 0.0f));
    force.z_n = 4.3f;
    TEST_ASSERT_TRUE(others_move(BRACE_TIBIA, 5, 0.0f));
}

/* The angle stays within half a step while the torque swings by more than a quarter of its range and four times
 * friction. */
static void test_a_torque_that_swings(void)
{
    for (int wide = 0; wide < 2; wide++) {
        for (int small = 0; small < 2; small++) {
            setUp();
            parameters.drive[BRACE_TIBIA].motor_friction_n_mm = small != 0 ? 40.0f : 600.0f;
            const float most = small != 0 ? 2000.0f : 2400.0f, swing = most + (wide != 0 ? 10.0f : -10.0f);
            bool is_frozen = false;
            for (int i = 0; i < 12; i++) {
                joints.joint[BRACE_TIBIA].torque_n_mm = i % 2 == 0 ? 0.0f : swing;
                joints.joint[BRACE_TIBIA].sample.torque_n_mm = joints.joint[BRACE_TIBIA].torque_n_mm;
                joints.joint[BRACE_TIBIA].sample.motor_rad = i % 2 == 0 ? 1.0f : 1.0004f;
                is_frozen = others_move(BRACE_TIBIA, 1, 0.0f);
                TEST_ASSERT_FALSE(is_frozen && i < 5);
            }
            TEST_ASSERT_EQUAL(wide != 0, is_frozen);
            joints.joint[BRACE_TIBIA].sample.motor_rad = 1.0006f; /* more than half a step: it turns */
            TEST_ASSERT_FALSE(others_move(BRACE_TIBIA, 1, 0.0f));
        }
    }
}

/* An angle has stood once it has been seen to stand for 250 ms, to the microsecond, since it moved last. */
static void test_an_angle_stands_after_a_quarter_of_a_second(void)
{
    joint_t *joint = &joints.joint[BRACE_FEMUR];
    for (uint32_t less_us = 0; less_us < 2u; less_us++) {
        setUp();
        looks(3);
        joint->sample.motor_rad += 0.1f;
        joint->sample.link_rad = 1.0f;
        TEST_ASSERT_FALSE(look(LOOK_US)); /* it moves, and stands from here on */
        joint->sample.link_rad = 1.1f; /* away from its motor */
        for (uint32_t i = 0; i < 4u; i++) {
            joint->sample.torque_n_mm += 1.0f;
            TEST_ASSERT_FALSE(look(LOOK_US));
        }
        TEST_ASSERT_EQUAL(less_us == 0u, look(LOOK_US - less_us));
        TEST_ASSERT_TRUE(look(1));
    }
}

/* The link's encoder moves away from a motor that stands, by more than 5 mrad, the gap and the yield of the spring. */
static void test_a_link_that_leaves_its_motor(void)
{
    for (int beyond = 0; beyond < 2; beyond++) {
        for (int pulls = 0; pulls < 2; pulls++) {
            setUp();
            const float follows_rad = 0.02f + (pulls != 0 ? 1000.0f * 1e-5f : 0.0f);
            const float away_rad = 0.005f + follows_rad + (beyond != 0 ? 0.0005f : -0.0005f);
            bool is_frozen = false;
            for (int i = 0; i < 12; i++) {
                joint_t *joint = &joints.joint[BRACE_FEMUR];
                joint->torque_n_mm = pulls != 0 && i % 2 != 0 ? 1000.0f : 0.0f;
                joint->sample.torque_n_mm = (float)i; /* the drive measures its torque */
                joint->sample.link_rad = i % 2 != 0 ? 1.0f + away_rad : 1.0f;
                is_frozen = others_move(BRACE_FEMUR, 1, 0.0f);
            }
            TEST_ASSERT_EQUAL(beyond != 0, is_frozen);
        }
    }
}

/* The torque swings by more than the known load and friction explain, so the motor must have turned. */
static void test_a_torque_that_nothing_holds(void)
{
    for (int beyond = 0; beyond < 2; beyond++) {
        setUp();
        parameters.sensor.noise_n = 0.1f;
        press(0.0f);
        bool is_frozen = false;
        for (int i = 0; i < 20; i++) { /* 4 * 40 + 12 * (5 + 10) = 340 N mm */
            joints.joint[BRACE_FEMUR].torque_n_mm = i % 2 != 0 ? 340.0f + (beyond != 0 ? 5.0f : -5.0f) : 0.0f;
            joints.joint[BRACE_FEMUR].sample.torque_n_mm = joints.joint[BRACE_FEMUR].torque_n_mm;
            is_frozen = others_move(BRACE_FEMUR, 1, 0.0f);
        }
        TEST_ASSERT_EQUAL(beyond != 0, is_frozen);
    }
}

/* The torque's mean begins with three samples: where it begins is no swing. */
static void test_a_mean_that_begins_does_not_swing(void)
{
    joint_t *joint = &joints.joint[BRACE_TIBIA];
    joint->samples_seen = 2;
    joint->torque_n_mm = 0.0f;
    TEST_ASSERT_FALSE(others_move(BRACE_TIBIA, 2, 0.0f));
    joint->samples_seen = 3;
    joint->torque_n_mm = 3000.0f; /* more than a quarter of the range away */
    joint->sample.torque_n_mm = 3000.0f;
    TEST_ASSERT_FALSE(others_move(BRACE_TIBIA, 12, 0.0f));
    joint->torque_n_mm = 0.0f; /* but this is one */
    joint->sample.torque_n_mm = 1.0f;
    TEST_ASSERT_TRUE(others_move(BRACE_TIBIA, 1, 0.0f));
}

static void test_all_is_forgotten(void)
{
    looks(3);
    commanded_offset_rad[BRACE_COXA] = 0.02f;
    TEST_ASSERT_TRUE(looks(6));
    frozen_start(&frozen);
    TEST_ASSERT_FALSE(frozen_any(&frozen));
    TEST_ASSERT_FALSE(looks(20)); /* this was commanded already */
    commanded_offset_rad[BRACE_COXA] = 0.04f;
    TEST_ASSERT_TRUE(looks(6));
    joints.joint[BRACE_COXA].sound = false; /* a joint without samples is not called frozen */
    TEST_ASSERT_FALSE(looks(1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_joint_that_rests_is_not_frozen);
    RUN_TEST(test_commanded_to_move);
    RUN_TEST(test_a_look_counts_for_a_while);
    RUN_TEST(test_a_load_that_is_not_felt);
    RUN_TEST(test_the_joint_s_friction_hides_a_load);
    RUN_TEST(test_a_load_on_the_tibia_joint_that_is_not_felt);
    RUN_TEST(test_a_torque_that_swings);
    RUN_TEST(test_an_angle_stands_after_a_quarter_of_a_second);
    RUN_TEST(test_a_link_that_leaves_its_motor);
    RUN_TEST(test_a_torque_that_nothing_holds);
    RUN_TEST(test_a_mean_that_begins_does_not_swing);
    RUN_TEST(test_all_is_forgotten);
    return UNITY_END();
}
