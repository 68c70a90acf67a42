// The joint stiffens with load: torque = k q + h q^3, q beyond the play.
#pragma once

#include "effects/effect.h"

namespace brace::effects::joint_hardening {

inline double torque_n_mm(double hardening_n_mm_per_rad3, double deflection_rad)
{
    return hardening_n_mm_per_rad3 * deflection_rad * deflection_rad * deflection_rad;
}

inline double stiffness_n_mm_per_rad(double hardening_n_mm_per_rad3, double deflection_rad)
{
    return 3.0 * hardening_n_mm_per_rad3 * deflection_rad * deflection_rad;
}

inline void none(Model &model)
{
    for (auto &joint : model.joint) {
        joint.hardening_n_mm_per_rad3 = 0.0;
    }
}

inline constexpr const char *kLaw = "torque = deflection / compliance + hardening * deflection^3";
inline constexpr Entry kEntries[] = {
    {"joint_hardening", "joint.femur", "joint.femur.hardening_n_mm_per_rad3", kLaw},
    {"joint_hardening", "joint.tibia", "joint.tibia.hardening_n_mm_per_rad3", kLaw},
};

} // namespace brace::effects::joint_hardening
