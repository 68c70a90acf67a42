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

} // namespace brace::effects::joint_hardening
