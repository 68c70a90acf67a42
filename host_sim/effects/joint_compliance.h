// Gearbox and servo turn under torque: deflection = compliance * torque.
#pragma once

#include "effects/effect.h"

namespace brace::effects::joint_compliance {

inline double torque_n_mm(double compliance_rad_per_n_mm, double deflection_rad)
{
    return deflection_rad / compliance_rad_per_n_mm;
}

} // namespace brace::effects::joint_compliance
