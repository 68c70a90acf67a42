/* The controller commands each drive what take-up and loading test ask for together. It keeps within the torque of both
 * and within the board's ceiling, and it counts a drive that refuses. */
#include "command/drives.h"

#include <math.h>
#include <string.h>

#include "unity.h"

enum { TICK_US = 1000 };

static drives_t drives;
static joints_t joints;
static flank_t flank;
static drives_test_t test;
static brace_hal_t hal;
static brace_hal_joint_command_t commanded[BRACE_LINK_COUNT];
static uint32_t calls[BRACE_LINK_COUNT], failed;
static int32_t answer;
static bool stands;

static int32_t command(void *context, int32_t joint_index, const brace_hal_joint_command_t *wanted)
{
    (void)context;
    commanded[joint_index] = *wanted;
    calls[joint_index]++;
    return joint_index == BRACE_TIBIA ? answer : BRACE_HAL_OK;
}

void setUp(void)
{
    memset(&joints, 0, sizeof joints);
    memset(&flank, 0, sizeof flank);
    memset(&test, 0, sizeof test);
    memset(calls, 0, sizeof calls);
    hal = (brace_hal_t){.joint_command = command};
    joints.joint[BRACE_FEMUR].fitted = joints.joint[BRACE_TIBIA].fitted = true;
    failed = 0;
    answer = BRACE_HAL_OK;
    stands = false;
    drives_start(&drives);
}

void tearDown(void) {}

static void tick(bool takes_up)
{
    drives_command(&drives, &hal, &joints, &flank, takes_up, &test, stands, TICK_US, &failed);
}

static void test_nothing_is_commanded_until_something_moves_and_all_is_taken_back(void)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        TEST_ASSERT_TRUE(isinf(drives.limit_n_mm[i])); /* nothing limits them yet */
    }
    tick(false);
    TEST_ASSERT_EQUAL(0, calls[BRACE_FEMUR]);
    flank.joint[BRACE_FEMUR].out.command_rad = 0.01f;
    tick(true);
    TEST_ASSERT_EQUAL(1, calls[BRACE_FEMUR]);
    TEST_ASSERT_EQUAL(1, calls[BRACE_TIBIA]);
    TEST_ASSERT_EQUAL(0, calls[BRACE_COXA]); /* not fitted */
    TEST_ASSERT_EQUAL_FLOAT(0.01f, commanded[BRACE_FEMUR].offset_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.01f, drives.commanded_offset_rad[BRACE_FEMUR]);
    TEST_ASSERT_TRUE(isinf(commanded[BRACE_FEMUR].torque_limit_n_mm) && isinf(drives.limit_n_mm[BRACE_FEMUR]));
    flank.joint[BRACE_FEMUR].out.command_rad = 0.0f;
    tick(true);
    tick(false); /* once more */
    TEST_ASSERT_EQUAL(3, calls[BRACE_FEMUR]);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, commanded[BRACE_FEMUR].offset_rad);
    TEST_ASSERT_FALSE(drives.is_going_back);
    tick(false);
    TEST_ASSERT_EQUAL(3, calls[BRACE_FEMUR]);
}

/* What a fault has left over goes back at 0.1 rad/s, as a drive's own command does that nobody repeats. */
static void test_what_is_left_over_goes_back_slowly(void)
{
    flank.joint[BRACE_FEMUR].out.command_rad = 0.01f;
    flank.joint[BRACE_TIBIA].out.command_rad = -0.01f;
    tick(true);
    flank.joint[BRACE_FEMUR].out.command_rad = flank.joint[BRACE_TIBIA].out.command_rad = 0.0f;
    for (int i = 1; i <= 100; i++) { /* 0.1 mrad a tick */
        TEST_ASSERT_EQUAL(i > 1, drives.is_going_back);
        tick(false);
        const float left_rad = 0.01f - 0.0001f * (float)i;
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, left_rad, commanded[BRACE_FEMUR].offset_rad);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, -left_rad, commanded[BRACE_TIBIA].offset_rad);
        if (i == 50) {
            stands = true;
            tick(false);
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, left_rad, commanded[BRACE_FEMUR].offset_rad);
            stands = false;
        }
    }
    tick(false);
    const uint32_t all = calls[BRACE_FEMUR];
    tick(false);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, commanded[BRACE_FEMUR].offset_rad);
    TEST_ASSERT_FALSE(drives.is_going_back);
    TEST_ASSERT_TRUE(calls[BRACE_FEMUR] <= all + 1u);
}

/* A drive that refuses a command keeps the command before it. The next command goes on from there. */
static void test_a_drive_that_refuses_was_not_commanded(void)
{
    flank.joint[BRACE_TIBIA].out.command_rad = 0.01f;
    tick(true);
    answer = BRACE_HAL_E_DEVICE;
    flank.joint[BRACE_TIBIA].out.command_rad = 0.002f;
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(0.01f, drives.commanded_offset_rad[BRACE_TIBIA]);
    answer = BRACE_HAL_OK; /* it is back, and does not jump to what has been asked for meanwhile */
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(0.0099f, commanded[BRACE_TIBIA].offset_rad);
    answer = BRACE_HAL_E_DEVICE;
    flank.joint[BRACE_TIBIA].out.command_rad = 0.0f;
    tick(false); /* nobody commands it any more: it goes back by itself */
    TEST_ASSERT_FALSE(drives.is_going_back);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, drives.commanded_offset_rad[BRACE_TIBIA]);
}

static void test_a_take_up_and_a_test_add_up_within_the_smaller_torque(void)
{
    flank_joint_t *femur = &flank.joint[BRACE_FEMUR];
    femur->out.command_rad = 0.01f;
    test.offset_rad[BRACE_FEMUR] = 0.002f;
    test.torque_limit_n_mm[BRACE_FEMUR] = 3000.0f;
    tick(true); /* the test does not run */
    TEST_ASSERT_EQUAL_FLOAT(0.01f, commanded[BRACE_FEMUR].offset_rad);
    test.runs = true;
    tick(false);
    TEST_ASSERT_EQUAL_FLOAT(0.012f, commanded[BRACE_FEMUR].offset_rad);
    TEST_ASSERT_EQUAL_FLOAT(3000.0f, commanded[BRACE_FEMUR].torque_limit_n_mm);
    TEST_ASSERT_EQUAL_FLOAT(3000.0f, drives.limit_n_mm[BRACE_FEMUR]);
    femur->machine.params.takeup.torque_max_n_mm = 2000.0f;
    femur->out.limit_torque = true; /* but nobody watches the play: the limit is none */
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(3000.0f, commanded[BRACE_FEMUR].torque_limit_n_mm);
    femur->watched = true;
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(2000.0f, commanded[BRACE_FEMUR].torque_limit_n_mm);
    femur->machine.params.takeup.torque_max_n_mm = 4000.0f;
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(3000.0f, commanded[BRACE_FEMUR].torque_limit_n_mm);
    femur->out.limit_torque = false;
    test.runs = false;
    tick(true);
    TEST_ASSERT_TRUE(isinf(commanded[BRACE_FEMUR].torque_limit_n_mm));
}

static void test_the_board_s_ceiling_bounds_speed_and_torque_both_ways(void)
{
    brace_hal_ceiling_t ceiling[BRACE_LINK_COUNT];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        ceiling[i] = (brace_hal_ceiling_t){.torque_most_n_mm = 5000.0f, .speed_most_rad_per_s = 2.0f};
    }
    hal.ceiling = ceiling;
    test.runs = true;
    test.torque_limit_n_mm[BRACE_FEMUR] = 9000.0f;
    test.torque_limit_n_mm[BRACE_TIBIA] = 1000.0f;
    for (int way = 1; way >= -1; way -= 2) {
        test.offset_rad[BRACE_FEMUR] = (float)way * 0.005f;
        test.offset_rad[BRACE_TIBIA] = (float)way * 0.001f;
        for (int i = 1; i <= 4; i++) { /* 2 rad/s: 2 mrad in a tick */
            tick(false);
            const float way_rad = 0.002f * (float)i;
            TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)way * (way_rad < 0.005f ? way_rad : 0.005f),
                                     commanded[BRACE_FEMUR].offset_rad);
            TEST_ASSERT_EQUAL_FLOAT((float)way * 0.001f, commanded[BRACE_TIBIA].offset_rad);
        }
        TEST_ASSERT_EQUAL_FLOAT(5000.0f, commanded[BRACE_FEMUR].torque_limit_n_mm);
        TEST_ASSERT_EQUAL_FLOAT(1000.0f, commanded[BRACE_TIBIA].torque_limit_n_mm);
        for (int i = 0; i < 4; i++) {
            test.offset_rad[BRACE_FEMUR] = test.offset_rad[BRACE_TIBIA] = 0.0f;
            tick(false);
        }
        TEST_ASSERT_EQUAL_FLOAT(0.0f, commanded[BRACE_FEMUR].offset_rad);
    }
    /* what is left goes back within the ceiling, too; only then the drive's own limit holds again */
    ceiling[BRACE_FEMUR].speed_most_rad_per_s = 0.05f;
    test.offset_rad[BRACE_FEMUR] = 0.002f;
    for (int i = 0; i < 50; i++) {
        tick(false);
    }
    test.runs = false;
    for (int i = 1; i < 40; i++) {
        tick(false);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.002f - 0.00005f * (float)i, commanded[BRACE_FEMUR].offset_rad);
        TEST_ASSERT_EQUAL_FLOAT(5000.0f, commanded[BRACE_FEMUR].torque_limit_n_mm);
    }
    tick(false);
    tick(false);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, commanded[BRACE_FEMUR].offset_rad);
    TEST_ASSERT_TRUE(isinf(commanded[BRACE_FEMUR].torque_limit_n_mm));
}

static void test_a_set_point_that_is_behind_stands_where_it_is(void)
{
    brace_hal_ceiling_t ceiling[BRACE_LINK_COUNT];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        ceiling[i] = (brace_hal_ceiling_t){.torque_most_n_mm = 5000.0f, .speed_most_rad_per_s = 2.0f};
    }
    hal.ceiling = ceiling;
    flank.joint[BRACE_FEMUR].out.command_rad = 0.01f;
    tick(true);
    stands = true;
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(0.002f, commanded[BRACE_FEMUR].offset_rad);
    stands = false;
    tick(true); /* no jump: 0.1 rad/s, until it is there */
    TEST_ASSERT_EQUAL_FLOAT(0.0021f, commanded[BRACE_FEMUR].offset_rad);
    for (int i = 0; i < 80; i++) {
        tick(true);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.01f, commanded[BRACE_FEMUR].offset_rad);
    flank.joint[BRACE_FEMUR].out.command_rad = 0.02f;
    tick(true);
    TEST_ASSERT_EQUAL_FLOAT(0.012f, commanded[BRACE_FEMUR].offset_rad);
}

static void test_a_drive_that_refuses_for_50_ms_is_reported(void)
{
    test.runs = true;
    answer = BRACE_HAL_E_DEVICE;
    for (int i = 0; i < 49; i++) {
        tick(false);
    }
    TEST_ASSERT_FALSE(drives_refuse(&drives));
    TEST_ASSERT_EQUAL(49, failed);
    tick(false);
    TEST_ASSERT_TRUE(drives_refuse(&drives));
    answer = BRACE_HAL_OK;
    tick(false);
    TEST_ASSERT_FALSE(drives_refuse(&drives)); /* one that takes a command has come back */
    answer = BRACE_HAL_AGAIN;
    for (int i = 0; i < 60; i++) {
        tick(false);
    }
    TEST_ASSERT_TRUE(drives_refuse(&drives));
    test.runs = false;
    tick(false); /* the last command is refused too */
    TEST_ASSERT_TRUE(drives_refuse(&drives));
    tick(false);
    TEST_ASSERT_FALSE(drives_refuse(&drives)); /* the controller commands no drive now */
    test.runs = true; /* and the time counts from nothing again */
    drives_command(&drives, &hal, &joints, &flank, false, &test, stands, 49999u, &failed);
    TEST_ASSERT_FALSE(drives_refuse(&drives));
    drives_command(&drives, &hal, &joints, &flank, false, &test, stands, 1u, &failed);
    TEST_ASSERT_TRUE(drives_refuse(&drives));
}

static void test_a_board_without_commands_gets_no_command(void)
{
    hal.joint_command = NULL;
    test.runs = true;
    for (int i = 0; i < 100; i++) {
        tick(true);
    }
    TEST_ASSERT_FALSE(drives_refuse(&drives));
    TEST_ASSERT_EQUAL(0, failed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_is_commanded_until_something_moves_and_all_is_taken_back);
    RUN_TEST(test_what_is_left_over_goes_back_slowly);
    RUN_TEST(test_a_drive_that_refuses_was_not_commanded);
    RUN_TEST(test_a_take_up_and_a_test_add_up_within_the_smaller_torque);
    RUN_TEST(test_the_board_s_ceiling_bounds_speed_and_torque_both_ways);
    RUN_TEST(test_a_set_point_that_is_behind_stands_where_it_is);
    RUN_TEST(test_a_drive_that_refuses_for_50_ms_is_reported);
    RUN_TEST(test_a_board_without_commands_gets_no_command);
    return UNITY_END();
}
