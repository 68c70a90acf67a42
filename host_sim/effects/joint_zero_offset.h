// An encoder's zero is off: true angle = commanded + offset.
// Reads joint.*.zero_offset_rad; depends on nothing else.
#pragma once

#include "effects/effect.h"

namespace brace::effects::joint_zero_offset {

inline double true_angle_rad(const Model &model, int joint, double commanded_rad)
{
    return commanded_rad + model.joint[joint].zero_offset_rad;
}

} // namespace brace::effects::joint_zero_offset
