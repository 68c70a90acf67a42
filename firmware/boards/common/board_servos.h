/* Joints by Dynamixel servos, for boards that have a line to them. */
#ifndef BRACE_BOARDS_BOARD_SERVOS_H
#define BRACE_BOARDS_BOARD_SERVOS_H

#include "brace_dynamixel.h"

/* Starts the driver; false: the setup is refused, and there are no joints. */
bool servo_joints_start(const brace_servo_setup_t *setup, const brace_servo_line_t *line);

void servo_joints_serve(uint32_t now_us);

/* For the door: they are E_UNSUPPORTED until servo_joints_start. The context is ignored. */
int32_t servo_joints_read(void *context, int32_t joint_index, brace_hal_joint_t *joint);
int32_t servo_joints_command(void *context, int32_t joint_index, const brace_hal_joint_command_t *command);

/* For the console and the debugger. */
const brace_dynamixel_t *servo_joints_driver(void);

#endif
