/* The port self-test and what joints and the tip's sensor report: each lie is named, and nothing else blamed before
 * it. */
#include "selftest_door.h"

enum {
    JOINT_MISSING = 1,
    JOINT_DEVICE,
    JOINT_AGAIN_FOR_EVER,
    JOINT_NAN,
    JOINT_NO_ENCODER,
    JOINT_DEGREES,
    JOINT_STALE,
    JOINT_FUTURE,
    JOINT_SAME_SAMPLE,
    JOINT_STUCK,
    JOINT_INDEX_UNCHECKED,
    COMMAND_REFUSED,
    COMMAND_INDEX_UNCHECKED,
    FORCE_AGAIN_FOR_EVER,
    FORCE_NAN,
    CEILING_SPEED,
    CEILING_TRAVEL,
    LIES
};

static int32_t lying_joint_read(void *context, int32_t index, brace_hal_joint_t *joint)
{
    const bool is_none = index < 0 || index >= JOINTS;
    if (is_none && world.lie == JOINT_INDEX_UNCHECKED) {
        joint->motor_rad = 0.0f;
    }
    const int32_t answer = joint_read(context, index, joint);
    if (index != 1) {
        return answer;
    }
    switch (world.lie) {
    case JOINT_MISSING: return BRACE_HAL_E_UNSUPPORTED;
    case JOINT_DEVICE: return BRACE_HAL_E_DEVICE;
    case JOINT_AGAIN_FOR_EVER: return BRACE_HAL_AGAIN;
    case JOINT_NAN: joint->torque_n_mm = NAN; break;
    case JOINT_NO_ENCODER: joint->motor_rad = NAN; break;
    case JOINT_DEGREES: joint->motor_rad = 57.3f; break;
    case JOINT_STALE: joint->taken_us -= 30000u; break;
    case JOINT_FUTURE: joint->taken_us += 5000u; break;
    case JOINT_SAME_SAMPLE: joint->taken_us = 1u; break;
    case JOINT_STUCK: joint->motor_rad = 1.0f; break;
    default: break;
    }
    return answer;
}

static int32_t lying_joint_command(void *context, int32_t index, const brace_hal_joint_command_t *command)
{
    return world.lie == COMMAND_REFUSED           ? BRACE_HAL_E_DEVICE
           : world.lie == COMMAND_INDEX_UNCHECKED ? BRACE_HAL_OK
                                                  : joint_command(context, index, command);
}

static int32_t lying_tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    const int32_t answer = tip_force_read(context, force_x_n, force_z_n);
    *force_x_n = world.lie == FORCE_NAN ? NAN : *force_x_n;
    return world.lie == FORCE_AGAIN_FOR_EVER ? BRACE_HAL_AGAIN : answer;
}

static void open_lying(int lie)
{
    door.joint_read = lying_joint_read;
    door.joint_command = lying_joint_command;
    door.tip_force_read = lying_tip_force_read;
    world.moves = lie == JOINT_STUCK;
    world.limb_is_free = true;
    static brace_hal_ceiling_t ceilings[JOINTS];
    for (uint32_t i = 0u; i < JOINTS; i++) {
        ceilings[i] = (brace_hal_ceiling_t){INFINITY, -1.0f, 1.0f, 1.0f};
    }
    ceilings[2].speed_most_rad_per_s = lie == CEILING_SPEED ? NAN : 1.0f;
    ceilings[0].angle_most_rad = lie == CEILING_TRAVEL ? -1.0f : 1.0f;
    door.ceiling = ceilings;
}

static void each_lie_is_named(void)
{
    static const named_t named[] = {
        {JOINT_MISSING, "joint_read(1)", "no such joint"},
        {JOINT_DEVICE, "joint_read(1)", "device refuses"},
        {JOINT_AGAIN_FOR_EVER, "joint_read(1)", "AGAIN for ever"},
        {JOINT_NAN, "joint_read(1)", "not finite"},
        {JOINT_NO_ENCODER, "joint_read(1)", "not finite"},
        {JOINT_DEGREES, "joint_read(1)", "degrees"},
        {JOINT_STALE, "joint_read(1)", "taken_us"},
        {JOINT_FUTURE, "joint_read(1)", "taken_us"},
        {JOINT_SAME_SAMPLE, "joint_read(1)", "the same sample"},
        {JOINT_STUCK, "joint_read(1)", "stuck"},
        {JOINT_INDEX_UNCHECKED, "joint_read", "is answered or written to"},
        {COMMAND_REFUSED, "joint_command", "refuses an offset of 0"},
        {COMMAND_INDEX_UNCHECKED, "joint_command", "joint 3 is accepted"},
        {FORCE_AGAIN_FOR_EVER, "tip_force_read", "no sample in 50 ms"},
        {FORCE_NAN, "tip_force_read", "not finite"},
        {CEILING_SPEED, "ceiling", "not above 0"},
        {CEILING_TRAVEL, "ceiling", "ends before it begins"},
    };
    TEST_ASSERT_EQUAL_UINT32(LIES - 1u, sizeof named / sizeof named[0]);
    expect_each_named(named, sizeof named / sizeof named[0], open_lying);
}

static int32_t read_behind_the_gear(void *context, int32_t index, brace_hal_joint_t *joint)
{
    const int32_t answer = joint_read(context, index, joint);
    if (answer == BRACE_HAL_OK) {
        joint->link_rad = joint->motor_rad;
        joint->motor_rad = NAN;
    }
    return answer;
}

/* As a servo has it: one encoder, behind the gear. Where it stands although it is moved, it is stuck. */
static void one_encoder_behind_the_gear_is_enough(void)
{
    for (uint32_t moves = 0u; moves < 2u; moves++) {
        open_door();
        door.joint_read = read_behind_the_gear;
        brace_selftest_setup_t setup = setup_of(BRACE_SELFTEST_KEEP_NVM);
        setup.joints_are_moved = true;
        world.moves = moves == 1u;
        TEST_ASSERT_EQUAL_INT32(moves == 1u ? 0 : 2, brace_selftest_run(&door, &setup, NULL));
        TEST_ASSERT_EQUAL(moves == 0u, is_reported("joint_read(2)", "stuck"));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_lie_is_named);
    RUN_TEST(one_encoder_behind_the_gear_is_enough);
    return UNITY_END();
}
