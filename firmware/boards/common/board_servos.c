#include "board_servos.h"

static brace_dynamixel_t driver;
static bool is_started;

bool servo_joints_start(const brace_servo_setup_t *setup, const brace_servo_line_t *line)
{
    is_started = brace_dynamixel_start(&driver, setup, line) == BRACE_HAL_OK;
    return is_started;
}

void servo_joints_serve(uint32_t now_us)
{
    if (is_started) {
        brace_dynamixel_serve(&driver, now_us);
    }
}

int32_t servo_joints_read(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    (void)context;
    return is_started ? brace_dynamixel_read(&driver, joint_index, joint) : BRACE_HAL_E_UNSUPPORTED;
}

int32_t servo_joints_command(void *context, int32_t joint_index, const brace_hal_joint_command_t *command)
{
    (void)context;
    return is_started ? brace_dynamixel_command(&driver, joint_index, command) : BRACE_HAL_E_UNSUPPORTED;
}

const brace_dynamixel_t *servo_joints_driver(void)
{
    return &driver;
}
