/* The driver with a line of two buffers, for counting its instructions on an emulated Cortex-M4F. */
#include "brace_dynamixel.h"

static brace_dynamixel_t driver;
uint8_t sent[DXL_OUT_BYTES], come[256];
uint32_t sent_count, come_count;

static int32_t send(void *context, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    for (uint32_t i = 0; i < count; i++) {
        sent[i] = bytes[i];
    }
    sent_count = count;
    return BRACE_HAL_OK;
}

static int32_t receive(void *context, uint8_t *bytes, uint32_t room)
{
    (void)context;
    const uint32_t count = come_count < room ? come_count : room;
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = come[i];
    }
    for (uint32_t i = count; i < come_count; i++) {
        come[i - count] = come[i];
    }
    come_count -= count;
    return (int32_t)count;
}

int32_t start(void)
{
    const brace_servo_setup_t setup = {.joint = {{.id = 11u, .torque_ratio = 1.0f},
                                                 {.id = 12u, .torque_ratio = 1.0f},
                                                 {.id = 13u, .torque_ratio = 1.0f}},
                                       .period_us = 500u,
                                       .timeout_us = 700u,
                                       .holds = true};
    const brace_servo_line_t line = {0, send, receive};
    return brace_dynamixel_start(&driver, &setup, &line);
}

void serve(uint32_t now_us)
{
    brace_dynamixel_serve(&driver, now_us);
}

int32_t read_joint(int32_t index)
{
    brace_hal_joint_t joint;
    return brace_dynamixel_read(&driver, index, &joint);
}

int32_t command_joint(int32_t index)
{
    const brace_hal_joint_command_t command = {0.01f, 500.0f};
    return brace_dynamixel_command(&driver, index, &command);
}
