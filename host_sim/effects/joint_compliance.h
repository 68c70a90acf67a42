// Gearbox and servo turn under torque: deflection = compliance * torque.
// Reads joint.*.compliance_rad_per_n_mm; depends on nothing else.
#pragma once

#include "effects/effect.h"

namespace brace::effects::joint_compliance {

inline double torque_n_mm(const Joint &joint, double deflection_rad)
{
    return deflection_rad / joint.compliance_rad_per_n_mm;
}

inline double stiffness_n_mm_per_rad(const Joint &joint)
{
    return 1.0 / joint.compliance_rad_per_n_mm;
}

} // namespace brace::effects::joint_compliance
