// The joint stiffens with load: torque = k q + h q^3, q beyond the play.
// Reads joint.*.hardening_n_mm_per_rad3; depends on the load.
#pragma once

#include <cmath>

#include "effects/effect.h"

namespace brace::effects::joint_hardening {

inline bool acts(const Joint &joint)
{
    return joint.hardening_n_mm_per_rad3 != 0.0;
}

inline double torque_n_mm(const Joint &joint, double deflection_rad)
{
    return joint.hardening_n_mm_per_rad3 * deflection_rad * deflection_rad * deflection_rad;
}

inline double stiffness_n_mm_per_rad(const Joint &joint, double deflection_rad)
{
    return 3.0 * joint.hardening_n_mm_per_rad3 * deflection_rad * deflection_rad;
}

// The deflection of the joint's spring and its hardening together under a torque.
inline double deflection_rad(const Joint &joint, double torque_n_mm)
{
    const double s = joint.compliance_rad_per_n_mm;
    const double h = joint.hardening_n_mm_per_rad3;
    if (h == 0.0 || s == 0.0) {
        return s * torque_n_mm;
    }
    // q / s + h q^3 = torque has one real root; Newton from the spring's answer falls on it from above.
    double q = s * std::fabs(torque_n_mm);
    for (int i = 0; i < 200; ++i) {
        const double step = (q / s + h * q * q * q - std::fabs(torque_n_mm)) / (1.0 / s + 3.0 * h * q * q);
        q -= step;
        if (step <= 1e-16 * q) {
            break;
        }
    }
    return std::copysign(q, torque_n_mm);
}

} // namespace brace::effects::joint_hardening
