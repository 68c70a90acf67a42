// A joint's deflection changes only when the torque out of balance exceeds the friction torque: a constant, and a
// share of what its spring carries, as gears rub. As an energy: each change costs friction times its size.
#pragma once

#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::coulomb_friction {

// The most that friction holds while the spring carries this torque.
inline double most_n_mm(double coulomb_n_mm, double per_load_ratio, double spring_n_mm)
{
    return coulomb_n_mm + per_load_ratio * std::fabs(spring_n_mm);
}

// Under an imposed deflection, the share [-1, 1] of the most: full against the motion, turning round over
// `reversal_rad` (at once when that is 0), kept where nothing moves.
inline double turned_share(double share, double change_rad, double reversal_rad)
{
    if (change_rad == 0.0) {
        return share;
    }
    if (!(reversal_rad > 0.0)) {
        return std::copysign(1.0, change_rad);
    }
    return std::clamp(share + change_rad / reversal_rad, -1.0, 1.0);
}

// The spring's torque while it moves towards `sense` under a given torque: what friction leaves of it, or adds.
// Friction grows with the very torque that is sought, hence the quotient; needs per_load_ratio < 1.
inline double spring_while_moving_n_mm(double coulomb_n_mm, double per_load_ratio, double torque_n_mm,
                                       double sense)
{
    const double constant = torque_n_mm - sense * coulomb_n_mm;
    return constant / (1.0 + (constant > 0.0 ? sense : -sense) * per_load_ratio);
}

inline void none(Model &model)
{
    for (auto &joint : model.joint) {
        joint.coulomb_n_mm = 0.0;
        joint.coulomb_per_load_ratio = 0.0;
    }
}

inline constexpr const char *kLaw =
    "deflection changes only where the torque out of balance exceeds coulomb + ratio * |spring torque|";
inline constexpr Entry kEntries[] = {
    {"coulomb_friction", "joint.femur", "joint.femur.coulomb_n_mm joint.femur.coulomb_per_load_ratio", kLaw},
    {"coulomb_friction", "joint.tibia", "joint.tibia.coulomb_n_mm joint.tibia.coulomb_per_load_ratio", kLaw},
};

} // namespace brace::effects::coulomb_friction
