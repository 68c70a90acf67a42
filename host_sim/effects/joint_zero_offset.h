// An encoder's zero is off: true angle = commanded + offset.
#pragma once

#include "effects/effect.h"

namespace brace::effects::joint_zero_offset {

inline double true_angle_rad(const Model &model, int joint, double commanded_rad)
{
    return commanded_rad + model.joint[joint].zero_offset_rad;
}

inline void none(Model &model)
{
    for (auto &joint : model.joint) {
        joint.zero_offset_rad = 0.0;
    }
}

inline constexpr const char *kLaw = "true angle = commanded + offset";
inline constexpr Entry kEntries[] = {
    {"joint_zero_offset", "joint.femur", "joint.femur.zero_offset_rad", kLaw},
    {"joint_zero_offset", "joint.tibia", "joint.tibia.zero_offset_rad", kLaw},
};

} // namespace brace::effects::joint_zero_offset
