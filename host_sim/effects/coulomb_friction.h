// A joint's deflection changes only when the torque out of balance exceeds the friction torque. As an energy:
// each change costs friction times its size.
#pragma once

#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::coulomb_friction {

inline double dissipated_n_mm(double coulomb_n_mm, double change_rad)
{
    return coulomb_n_mm * std::fabs(change_rad);
}

// Friction torque under an imposed deflection: full against the motion, turning round over `reversal_rad`
// (at once when that is 0), kept where nothing moves.
inline double turned_n_mm(double torque_n_mm, double coulomb_n_mm, double change_rad, double reversal_rad)
{
    if (change_rad == 0.0 || coulomb_n_mm == 0.0) {
        return torque_n_mm;
    }
    if (!(reversal_rad > 0.0)) {
        return std::copysign(coulomb_n_mm, change_rad);
    }
    const double next = torque_n_mm + coulomb_n_mm * (change_rad / reversal_rad);
    return std::clamp(next, -coulomb_n_mm, coulomb_n_mm);
}

inline void none(Model &model)
{
    for (auto &joint : model.joint) {
        joint.coulomb_n_mm = 0.0;
    }
}

inline constexpr const char *kLaw = "deflection changes only where the torque out of balance exceeds coulomb";
inline constexpr Entry kEntries[] = {
    {"coulomb_friction", "joint.femur", "joint.femur.coulomb_n_mm", kLaw},
    {"coulomb_friction", "joint.tibia", "joint.tibia.coulomb_n_mm", kLaw},
};

} // namespace brace::effects::coulomb_friction
