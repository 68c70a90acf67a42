/* Femur and tibia at rest in one posture, for emulated boards, which have no joints to measure. */
#ifndef BRACE_BOARDS_STAND_IN_JOINTS_H
#define BRACE_BOARDS_STAND_IN_JOINTS_H

#include "brace_hal.h"

/* As brace_hal.h's joint_read; it sets taken_us from now_us. */
int32_t stand_in_joint(int32_t joint_index, uint32_t now_us, brace_hal_joint_t *joint);

#endif
