// Gearbox and servo turn under torque: deflection = compliance * torque.
#pragma once

#include "effects/effect.h"

namespace brace::effects::joint_compliance {

inline double torque_n_mm(double compliance_rad_per_n_mm, double deflection_rad)
{
    return deflection_rad / compliance_rad_per_n_mm;
}

inline void none(Model &model)
{
    for (auto &joint : model.joint) {
        joint.compliance_rad_per_n_mm = 0.0;
    }
}

inline constexpr const char *kLaw = "deflection = compliance * torque";
inline constexpr Entry kEntries[] = {
    {"joint_compliance", "joint.femur", "joint.femur.compliance_rad_per_n_mm", kLaw},
    {"joint_compliance", "joint.tibia", "joint.tibia.compliance_rad_per_n_mm", kLaw},
};

} // namespace brace::effects::joint_compliance
