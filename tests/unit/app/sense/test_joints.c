/* Samples of the joints alone: which are refused, how the torque's mean begins and follows, and how old a sample is. */
#include "sense/joints.h"

#include <math.h>
#include <string.h>

#include "unity.h"

enum { TICK_US = 1000 };

static joints_t joints;
static brace_parameters_t parameters;
static brace_hal_joint_t sample;
static int32_t answer;
static uint32_t now_us, bad;

static int32_t joint_read(void *context, int32_t joint_index, brace_hal_joint_t *reported)
{
    (void)context;
    if (joint_index == BRACE_COXA) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    *reported = sample;
    return answer;
}

static const brace_hal_t hal = {.joint_read = joint_read};

void setUp(void)
{
    memset(&parameters, 0, sizeof parameters);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        parameters.drive[i] = (brace_drive_t){.torque_range_n_mm = 10000.0f, .motor_inertia_n_mm_s2_per_rad = 20.0f};
    }
    parameters.controller.tick_us = TICK_US;
    parameters.controller.age_limit_us = 20000;
    sample = (brace_hal_joint_t){.motor_rad = 1.0f, .link_rad = NAN, .torque_n_mm = 100.0f, .temp_degc = 30.0f};
    answer = BRACE_HAL_OK;
    now_us = 5000u;
    bad = 0;
    joints_start(&joints, &hal);
}

void tearDown(void) {}

static const joint_t *read_at(float motor_rad, float link_rad, float torque_n_mm)
{
    now_us += TICK_US;
    sample.motor_rad = motor_rad;
    sample.link_rad = link_rad;
    sample.torque_n_mm = torque_n_mm;
    sample.taken_us = now_us;
    joints_read(&joints, &hal, &parameters, now_us, &bad);
    return &joints.joint[BRACE_FEMUR];
}

static void test_the_mean_begins_as_the_median_of_three(void)
{
    static const float first[][3] = {{100.0f, 5000.0f, 120.0f}, {5000.0f, 100.0f, 120.0f}, {100.0f, 120.0f, 5000.0f}};
    for (int i = 0; i < 3; i++) {
        setUp();
        (void)read_at(1.0f, NAN, first[i][0]);
        (void)read_at(1.0f, NAN, first[i][1]);
        const joint_t *joint = read_at(1.0f, NAN, first[i][2]);
        TEST_ASSERT_EQUAL_FLOAT(120.0f, joint->torque_n_mm);
        TEST_ASSERT_EQUAL(3, joint->samples_seen);
    }
}

/* From then on it follows what two samples agree on, a share of 1 ms in 21 ms at a time. */
static void test_the_mean_follows_what_two_samples_agree_on(void)
{
    const joint_t *joint = &joints.joint[BRACE_FEMUR];
    (void)read_at(1.0f, NAN, 100.0f);
    (void)read_at(1.0f, NAN, 100.0f);
    TEST_ASSERT_EQUAL_FLOAT(100.0f, read_at(1.0f, NAN, 2100.0f)->torque_n_mm);
    joint = read_at(1.0f, NAN, 2200.0f); /* this is the fourth wild sample */
    TEST_ASSERT_FLOAT_WITHIN(1.0f, 100.0f + 2000.0f / 21.0f, joint->torque_n_mm);
    joints_start(&joints, &hal);
    for (int i = 0; i < 4; i++) {
        joint = read_at(1.0f, NAN, 100.0f);
    }
    joint = read_at(1.0f, NAN, 2100.0f); /* one wild sample moves nothing */
    TEST_ASSERT_EQUAL_FLOAT(100.0f, joint->torque_n_mm);
    joint = read_at(1.0f, NAN, 100.0f);
    TEST_ASSERT_EQUAL_FLOAT(100.0f, joint->torque_n_mm);
    (void)read_at(1.0f, NAN, 2100.0f);
    joint = read_at(1.0f, NAN, 2200.0f); /* two do: by the smaller change */
    TEST_ASSERT_FLOAT_WITHIN(25.0f, 100.0f + 2000.0f / 21.0f, joint->torque_n_mm);
    for (int i = 0; i < 200; i++) {
        joint = read_at(1.0f, NAN, 2100.0f);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0f, 2100.0f, joint->torque_n_mm);
}

/* Two wild samples agree only if they follow one another. */
/* Femur and tibia joint take the other's temperature where they have no sensor; the coxa joint has its own or none. */
static void test_temperatures_of_joints(void)
{
    static const float given[][3] = {{33.0f, 30.0f, 40.0f}, {NAN, 30.0f, NAN},       {33.0f, NAN, 40.0f},
                                     {NAN, NAN, NAN},       {150.0f, 40.0f, -60.0f}, {151.0f, 40.0f, -61.0f}};
    static const float reported[][3] = {{33.0f, 30.0f, 40.0f}, {NAN, 30.0f, 30.0f},     {33.0f, 40.0f, 40.0f},
                                        {NAN, NAN, NAN},       {150.0f, 40.0f, -60.0f}, {NAN, 40.0f, 40.0f}};
    for (int i = 0; i < 6; i++) {
        float temp_degc[BRACE_LINK_COUNT] = {-1.0f, -1.0f, -1.0f};
        for (int j = 0; j < BRACE_LINK_COUNT; j++) {
            joints.joint[j].sample.temp_degc = given[i][j];
        }
        joints_temperatures(&joints, temp_degc);
        for (int j = 0; j < BRACE_LINK_COUNT; j++) {
            TEST_ASSERT_TRUE(isnan(reported[i][j]) ? isnan(temp_degc[j]) : temp_degc[j] == reported[i][j]);
        }
        const float warmest = i == 1 ? 30.0f : 40.0f;
        TEST_ASSERT_TRUE(i == 3 ? isnan(joints_warmest_degc(&joints)) : joints_warmest_degc(&joints) == warmest);
    }
}

static void test_a_sound_sample_between_two_wild_ones_parts_them(void)
{
    (void)read_at(1.0f, NAN, 100.0f);
    for (int i = 0; i < 4; i++) {
        const joint_t *joint = read_at(1.5f, NAN, 100.0f);
        TEST_ASSERT_EQUAL_FLOAT(1.0f, joint->sample.motor_rad);
        TEST_ASSERT_TRUE(joint->has_wild);
        joint = read_at(1.0f, NAN, 100.0f);
        TEST_ASSERT_EQUAL_FLOAT(1.0f, joint->sample.motor_rad);
        TEST_ASSERT_FALSE(joint->has_wild);
    }
    (void)read_at(1.5f, NAN, 100.0f);
    TEST_ASSERT_EQUAL_FLOAT(1.5f, read_at(1.5f, NAN, 100.0f)->sample.motor_rad);
}

static void test_an_angle_that_no_joint_could_have_reached_is_refused_once(void)
{
    (void)read_at(1.0f, NAN, 100.0f);
    TEST_ASSERT_EQUAL_FLOAT(1.05f, read_at(1.05f, NAN, 100.0f)->sample.motor_rad); /* 50 rad/s */
    TEST_ASSERT_EQUAL(0, bad);
    const joint_t *joint = read_at(1.12f, NAN, 100.0f); /* 70 rad/s */
    TEST_ASSERT_EQUAL_FLOAT(1.05f, joint->sample.motor_rad);
    TEST_ASSERT_EQUAL(2, bad); /* both joints report the same here */
    TEST_ASSERT_TRUE(joint->has_wild);
    joint = read_at(1.3f, NAN, 100.0f); /* another one: neither is believed */
    TEST_ASSERT_EQUAL_FLOAT(1.05f, joint->sample.motor_rad);
    joint = read_at(1.31f, NAN, 100.0f); /* agrees with it: there it is */
    TEST_ASSERT_EQUAL_FLOAT(1.31f, joint->sample.motor_rad);
    TEST_ASSERT_FALSE(joint->has_wild);
    TEST_ASSERT_EQUAL(4, bad);
}

static void wait_ms(uint32_t ms)
{
    answer = BRACE_HAL_AGAIN;
    for (uint32_t i = 0; i < ms; i++) {
        (void)read_at(1.0f, NAN, 100.0f);
    }
    answer = BRACE_HAL_OK;
}

/* Two samples that agree on what no joint can have done prove a jump and not a place: it stands until somebody has
 * looked, whatever the encoder says later. */
static void test_a_jump_stands_until_somebody_has_looked(void)
{
    (void)read_at(1.0f, NAN, 100.0f);
    const joint_t *joint = read_at(1.5f, NAN, 100.0f);
    TEST_ASSERT_FALSE(joint->has_jumped);
    joint = read_at(1.5f, NAN, 100.0f);
    TEST_ASSERT_TRUE(joint->has_jumped && joint->sound);
    for (int i = 0; i < 100; i++) { /* nor does it end where the encoder comes back */
        TEST_ASSERT_TRUE(read_at(i < 50 ? 1.5f : 1.0f, NAN, 100.0f)->has_jumped);
    }
    TEST_ASSERT_TRUE(joints.joint[BRACE_TIBIA].has_jumped);
    joints_believe(&joints, BRACE_FEMUR);
    TEST_ASSERT_FALSE(joint->has_jumped);
    TEST_ASSERT_TRUE(joints.joint[BRACE_TIBIA].has_jumped); /* each joint has its own */
    joint = read_at(-0.5f, NAN, 100.0f); /* what it says next is believed, */
    TEST_ASSERT_EQUAL_FLOAT(-0.5f, joint->sample.motor_rad);
    TEST_ASSERT_FALSE(joint->has_jumped || joint->has_wild);
    (void)read_at(0.5f, NAN, 100.0f); /* and counts from there */
    TEST_ASSERT_TRUE(read_at(0.5f, NAN, 100.0f)->has_jumped);
}

/* How far a joint may have moved: 50 rad/s and 0.01 rad while samples come, 0.25 rad at most; 0.06 rad once the last
 * one is older than the age limit, however long that is, also when the clock has gone round. */
static void test_a_gap_makes_nothing_trusted(void)
{
    static const struct {
        uint32_t gap_ms;
        float reached_rad, beyond_rad;
    } row[] = {{0, 0.0599f, 0.0601f},  {1, 0.1099f, 0.1101f},  {3, 0.2099f, 0.2101f},    {4, 0.2499f, 0.2501f},
               {18, 0.2499f, 0.2501f}, {20, 0.0599f, 0.0601f}, {1000, 0.0599f, 0.0601f}, {60000, 0.0599f, 0.0601f}};
    for (uint32_t i = 0; i < sizeof row / sizeof *row; i++) {
        for (int side = -1; side <= 1; side += 2) {
            for (int goes_round = 0; goes_round < 2; goes_round++) {
                setUp();
                now_us = goes_round != 0 ? 0u - TICK_US * row[i].gap_ms / 2u : now_us;
                (void)read_at(1.0f, NAN, 100.0f);
                wait_ms(row[i].gap_ms);
                const float reached_rad = 1.0f + (float)side * row[i].reached_rad;
                TEST_ASSERT_EQUAL_FLOAT(reached_rad, read_at(reached_rad, NAN, 100.0f)->sample.motor_rad);
                setUp();
                (void)read_at(1.0f, NAN, 100.0f);
                wait_ms(row[i].gap_ms);
                const float beyond_rad = 1.0f + (float)side * row[i].beyond_rad;
                TEST_ASSERT_EQUAL_FLOAT(1.0f, read_at(beyond_rad, NAN, 100.0f)->sample.motor_rad);
                TEST_ASSERT_TRUE(read_at(beyond_rad, NAN, 100.0f)->has_jumped);
            }
        }
    }
}

/* A drive whose time stamps jump ahead gains no reach by it. */
static void test_time_stamps_give_no_reach(void)
{
    (void)read_at(1.0f, NAN, 100.0f);
    for (uint32_t i = 0; i < 2u; i++) {
        sample.motor_rad = 1.3f;
        now_us += TICK_US;
        sample.taken_us = now_us + 15000u;
        joints_read(&joints, &hal, &parameters, now_us, &bad);
        TEST_ASSERT_EQUAL(i == 1u, joints.joint[BRACE_FEMUR].has_jumped);
    }
}

/* Each encoder is held against its own last angle: one that was away meanwhile is not believed because the other one
 * was there. One that has never said anything is. */
static void test_each_encoder_has_its_own_place(void)
{
    parameters.limb.joint[BRACE_FEMUR].gap_rad = parameters.limb.joint[BRACE_TIBIA].gap_rad = 1.0f;
    (void)read_at(1.0f, NAN, 100.0f);
    TEST_ASSERT_EQUAL(0, bad);
    (void)read_at(1.0f, 0.7f, 100.0f);
    for (int i = 0; i < 30; i++) {
        (void)read_at(1.0f, NAN, 100.0f);
    }
    (void)read_at(1.0f, 0.75f, 100.0f);
    TEST_ASSERT_EQUAL(0, bad);
    for (int i = 0; i < 30; i++) {
        (void)read_at(1.0f, NAN, 100.0f);
    }
    TEST_ASSERT_FALSE(read_at(1.0f, 0.9f, 100.0f)->has_jumped);
    TEST_ASSERT_EQUAL(2, bad);
    TEST_ASSERT_TRUE(read_at(1.0f, 0.9f, 100.0f)->has_jumped);
    setUp(); /* the same of the motor, where the link's encoder goes on */
    (void)read_at(1.0f, 1.0f, 100.0f);
    for (int i = 0; i < 30; i++) {
        (void)read_at(NAN, 1.0f, 100.0f);
    }
    TEST_ASSERT_TRUE(joints.joint[BRACE_FEMUR].is_link_only && joints.joint[BRACE_FEMUR].sound);
    (void)read_at(1.1f, 1.0f, 100.0f);
    TEST_ASSERT_TRUE(read_at(1.1f, 1.0f, 100.0f)->has_jumped);
}

/* How far the link may be from the motor: half the play, one and a half times what the spring gives way by under
 * torque, bias, noise and friction, three sigmas of the zero, two steps and 0.005 rad. */
static void test_encoders_that_contradict_each_other(void)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        parameters.limb.joint[i] = (brace_joint_t){1e-5f, 0.02f, 0.1f};
        parameters.drive[i].torque_bias_n_mm = 100.0f;
        parameters.drive[i].torque_noise_n_mm = 200.0f;
        parameters.drive[i].motor_friction_n_mm = 300.0f;
        parameters.drive[i].angle_step_rad = 0.001f;
    }
    parameters.limb.uncertainty.angle_rad = 0.002f;
    parameters.limb.uncertainty.compliance_rel = 0.1f;
    parameters.slow.creep_ratio = 0.2f;
    /* the joint's true angle is 1.1; (1 + 0.5 + 0.3 + 0.2) * 1e-5 * (400 + 600) of spring */
    const float most_rad = 0.01f + 0.02f + 0.006f + 0.002f + 0.005f;
    for (int side = -1; side <= 1; side += 2) {
        for (int beyond = 0; beyond < 2; beyond++) {
            const float off_rad = (float)side * (most_rad + (beyond != 0 ? 1e-4f : -1e-4f));
            joints_start(&joints, &hal);
            for (int i = 1; i <= 60; i++) {
                const joint_t *joint = read_at(1.0f, 1.1f + off_rad, (float)side * 400.0f);
                TEST_ASSERT_EQUAL(beyond, joint->contradicts);
                TEST_ASSERT_EQUAL(beyond != 0 && i >= 50, joint->has_jumped); /* 50 ms */
            }
        }
    }
    joints_start(&joints, &hal); /* shorter than that is a load that the motor has not taken up yet */
    for (int i = 0; i < 200; i++) {
        const float off_rad = most_rad + (i % 50 == 0 ? -1e-4f : 1e-4f);
        TEST_ASSERT_FALSE(read_at(1.0f, 1.1f + off_rad, 400.0f)->has_jumped);
    }
    joints_start(&joints, &hal); /* without one of them, or with one that is old, there is nothing to compare */
    (void)read_at(1.0f, 1.5f, 400.0f);
    for (int i = 0; i < 200; i++) {
        const joint_t *joint = read_at(1.0f, NAN, 400.0f);
        TEST_ASSERT_EQUAL(i < 20, joint->contradicts);
        TEST_ASSERT_FALSE(joint->has_jumped);
    }
}

/* The controller checks a link's angle as it checks the motor's. An absurd or missing angle counts as not measured. */
static void test_link_angles_are_watched_too(void)
{
    (void)read_at(1.0f, 1.0f, 100.0f);
    (void)read_at(1.0f, 1.04f, 100.0f);
    TEST_ASSERT_EQUAL(0, bad);
    (void)read_at(1.0f, 1.2f, 100.0f);
    TEST_ASSERT_EQUAL(2, bad);
    (void)read_at(1.0f, 1.04f, 100.0f);
    (void)read_at(1.0f, 1e6f, 100.0f);
    (void)read_at(1.0f, NAN, 100.0f);
    TEST_ASSERT_EQUAL(2, bad);
    float link_rad[BRACE_LINK_COUNT];
    (void)read_at(1.0f, 1e6f, 100.0f);
    joints_link_angles(&joints, link_rad);
    TEST_ASSERT_TRUE(isnan(link_rad[BRACE_FEMUR]) && isnan(link_rad[BRACE_COXA]));
}

/* One bound for both: where the encoder behind the gear is the only one, an angle that is sound is the link's too. */
static void test_what_is_sound_is_no_absurd_link_angle(void)
{
    for (int i = 0; i < 2; i++) {
        const float bound_rad = i == 0 ? 100.0f : -100.0f;
        float link_rad[BRACE_LINK_COUNT];
        joints_start(&joints, &hal);
        TEST_ASSERT_EQUAL_FLOAT(bound_rad, read_at(NAN, bound_rad, 100.0f)->sample.motor_rad);
        TEST_ASSERT_EQUAL(0, bad);
        joints_link_angles(&joints, link_rad);
        TEST_ASSERT_EQUAL_FLOAT(bound_rad, link_rad[BRACE_FEMUR]);
    }
}

/* An answer of three numbers is written into three places. */
static void test_three_joints_have_three_numbers(void)
{
    float around[BRACE_LINK_COUNT + 2] = {7.0f, 0.0f, 0.0f, 0.0f, 7.0f};
    joints_link_angles(&joints, around + 1);
    joints_temperatures(&joints, around + 1);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, around[0]);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, around[BRACE_LINK_COUNT + 1]);
}

static void test_absurd_samples_are_counted_and_grow_old(void)
{
    static const float motor_rad[] = {101.0f, NAN, 1.0f, 1.0f, 1.0f};
    static const float torque_n_mm[] = {0.0f, 0.0f, 20001.0f, -20001.0f, NAN};
    const joint_t *joint = read_at(1.0f, NAN, 100.0f);
    TEST_ASSERT_TRUE(joint->sound && joint->is_new_enough_to_prove_a_flank);
    for (uint32_t i = 0; i < 5u; i++) {
        joint = read_at(motor_rad[i], NAN, torque_n_mm[i]);
        TEST_ASSERT_EQUAL(2u * (i + 1u), bad);
        TEST_ASSERT_EQUAL_FLOAT(1.0f, joint->sample.motor_rad);
        TEST_ASSERT_EQUAL(i < 4u, joint->is_new_enough_to_prove_a_flank); /* four ticks */
    }
    TEST_ASSERT_TRUE(joint->sound);
    for (int i = 6; i <= 20; i++) {
        TEST_ASSERT_TRUE(read_at(NAN, NAN, 0.0f)->sound);
    }
    TEST_ASSERT_FALSE(read_at(NAN, NAN, 0.0f)->sound); /* after 20 ms */
    TEST_ASSERT_FALSE(joints_plane_is_sound(&joints));
    joints.joint[BRACE_TIBIA].sound = true;
    TEST_ASSERT_FALSE(joints_plane_is_sound(&joints));
    joints.joint[BRACE_TIBIA].sound = false, joints.joint[BRACE_FEMUR].sound = true;
    TEST_ASSERT_FALSE(joints_plane_is_sound(&joints));
    TEST_ASSERT_TRUE(read_at(1.05f, NAN, 0.0f)->sound); /* what comes then is believed, near where the joint was */
}

static void test_a_drive_that_refuses_or_has_nothing_newer(void)
{
    (void)read_at(1.0f, NAN, 100.0f);
    answer = BRACE_HAL_AGAIN;
    (void)read_at(1.2f, NAN, 100.0f);
    TEST_ASSERT_EQUAL(0, bad); /* nothing newer is no fault */
    TEST_ASSERT_EQUAL_FLOAT(1.0f, joints.joint[BRACE_FEMUR].sample.motor_rad);
    answer = BRACE_HAL_E_DEVICE;
    (void)read_at(1.2f, NAN, 100.0f);
    TEST_ASSERT_EQUAL(2, bad);
    TEST_ASSERT_FALSE(joints.joint[BRACE_COXA].fitted);
    TEST_ASSERT_TRUE(joints.joint[BRACE_FEMUR].fitted && joints.joint[BRACE_TIBIA].fitted);
}

static void test_temperatures_stand_in_for_one_another(void)
{
    float temp_degc[BRACE_LINK_COUNT];
    (void)read_at(1.0f, NAN, 100.0f);
    joints.joint[BRACE_FEMUR].sample.temp_degc = 40.0f;
    joints.joint[BRACE_TIBIA].sample.temp_degc = NAN;
    joints_temperatures(&joints, temp_degc);
    TEST_ASSERT_EQUAL_FLOAT(40.0f, temp_degc[BRACE_FEMUR]);
    TEST_ASSERT_EQUAL_FLOAT(40.0f, temp_degc[BRACE_TIBIA]);
    TEST_ASSERT_EQUAL_FLOAT(40.0f, joints_warmest_degc(&joints));
    joints.joint[BRACE_FEMUR].sample.temp_degc = NAN;
    joints.joint[BRACE_TIBIA].sample.temp_degc = 35.0f;
    joints_temperatures(&joints, temp_degc);
    TEST_ASSERT_EQUAL_FLOAT(35.0f, temp_degc[BRACE_FEMUR]);
    joints.joint[BRACE_FEMUR].sample.temp_degc = 30.0f;
    TEST_ASSERT_EQUAL_FLOAT(35.0f, joints_warmest_degc(&joints));
    joints.joint[BRACE_FEMUR].sample.temp_degc = 45.0f;
    TEST_ASSERT_EQUAL_FLOAT(45.0f, joints_warmest_degc(&joints));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_mean_begins_as_the_median_of_three);
    RUN_TEST(test_the_mean_follows_what_two_samples_agree_on);
    RUN_TEST(test_temperatures_of_joints);
    RUN_TEST(test_a_sound_sample_between_two_wild_ones_parts_them);
    RUN_TEST(test_an_angle_that_no_joint_could_have_reached_is_refused_once);
    RUN_TEST(test_a_jump_stands_until_somebody_has_looked);
    RUN_TEST(test_a_gap_makes_nothing_trusted);
    RUN_TEST(test_time_stamps_give_no_reach);
    RUN_TEST(test_each_encoder_has_its_own_place);
    RUN_TEST(test_encoders_that_contradict_each_other);
    RUN_TEST(test_link_angles_are_watched_too);
    RUN_TEST(test_what_is_sound_is_no_absurd_link_angle);
    RUN_TEST(test_three_joints_have_three_numbers);
    RUN_TEST(test_absurd_samples_are_counted_and_grow_old);
    RUN_TEST(test_a_drive_that_refuses_or_has_nothing_newer);
    RUN_TEST(test_temperatures_stand_in_for_one_another);
    return UNITY_END();
}
