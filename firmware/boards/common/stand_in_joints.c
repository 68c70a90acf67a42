#include "stand_in_joints.h"

#include <math.h>

enum { FEMUR = 1, TIBIA = 2 };

int32_t stand_in_joint(int32_t joint_index, uint32_t now_us, brace_hal_joint_t *joint)
{
    if (joint_index != FEMUR && joint_index != TIBIA) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    *joint = (brace_hal_joint_t){
        .motor_rad = joint_index == FEMUR ? 1.0f : 1.4f,
        .torque_n_mm = 0.0f,
        .link_rad = NAN,
        .temp_degc = NAN,
        .taken_us = now_us,
    };
    return BRACE_HAL_OK;
}
