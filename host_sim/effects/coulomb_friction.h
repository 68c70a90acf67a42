// A joint's deflection changes only when the torque out of balance exceeds the friction torque. That torque is a
// constant, and a share of what the spring carries, because gears rub harder under load. Seen as energy, each change
// costs friction times its size.
#pragma once

#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::coulomb_friction {

// The largest torque that friction holds while the spring carries this torque.
inline double most_n_mm(double coulomb_n_mm, double per_load_ratio, double spring_n_mm)
{
    return coulomb_n_mm + per_load_ratio * std::fabs(spring_n_mm);
}

// Under an imposed deflection friction holds this share [-1, 1] of its largest torque. It works fully against the
// motion, changes its sign over `reversal_rad` (at once when that is 0), and stays as it is while nothing moves.
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

// The spring's torque while the joint moves towards `sense` under a given torque, which friction lessens or adds to.
// Friction grows with the very torque that this function seeks, so the torque is divided. Needs per_load_ratio < 1.
inline double spring_while_moving_n_mm(double coulomb_n_mm, double per_load_ratio, double torque_n_mm,
                                       double sense)
{
    const double constant = torque_n_mm - sense * coulomb_n_mm;
    return constant / (1.0 + (constant > 0.0 ? sense : -sense) * per_load_ratio);
}

} // namespace brace::effects::coulomb_friction
