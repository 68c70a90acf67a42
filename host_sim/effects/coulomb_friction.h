// A joint's deflection changes only when the torque out of balance exceeds the friction torque. That torque is a
// constant, and a share of what the spring carries, because gears rub harder under load. The share may fade as the load
// grows, to the two-thirds power of the load at last: the true area of an elastic contact grows so (Hertz). Seen as
// energy, each change costs friction times its size.
// Reads joint.*.coulomb_*; depends on the load and what came before.
#pragma once

#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::coulomb_friction {

inline bool acts(const Joint &joint)
{
    return joint.coulomb_n_mm > 0.0 || joint.coulomb_per_load_ratio > 0.0;
}

// The load that friction grows with, at a load of at least 0, and how fast it grows with it: between 0 and 1.
inline double felt_n_mm(const Joint &joint, double load_n_mm)
{
    const double fade = joint.coulomb_load_fade_per_n_mm;
    return fade > 0.0 ? load_n_mm / std::cbrt(1.0 + fade * load_n_mm) : load_n_mm;
}

inline double felt_slope(const Joint &joint, double load_n_mm)
{
    const double faded = joint.coulomb_load_fade_per_n_mm * load_n_mm, root = std::cbrt(1.0 + faded);
    return (1.0 + 2.0 / 3.0 * faded) / (root * (1.0 + faded));
}

// The largest torque that friction holds while the spring carries this torque, and how fast it grows with its size.
inline double most_n_mm(const Joint &joint, double spring_n_mm)
{
    return joint.coulomb_n_mm + joint.coulomb_per_load_ratio * felt_n_mm(joint, std::fabs(spring_n_mm));
}

inline double slope(const Joint &joint, double spring_n_mm)
{
    return joint.coulomb_per_load_ratio * felt_slope(joint, std::fabs(spring_n_mm));
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
// Friction grows with the very torque that this function seeks, so the torque is divided; where the share fades,
// Newton's method falls on the answer from there, always from the same side. Needs coulomb_per_load_ratio < 1.
inline double spring_while_moving_n_mm(const Joint &joint, double torque_n_mm, double sense)
{
    const double constant = torque_n_mm - sense * joint.coulomb_n_mm, size = std::fabs(constant);
    const double ratio = (constant > 0.0 ? sense : -sense) * joint.coulomb_per_load_ratio;
    double spring = size / (1.0 + ratio);
    for (int i = 0; joint.coulomb_load_fade_per_n_mm > 0.0 && i < 100; ++i) {
        const double step =
            (spring + ratio * felt_n_mm(joint, spring) - size) / (1.0 + ratio * felt_slope(joint, spring));
        spring -= step;
        if (std::fabs(step) <= 1e-15 * spring) {
            break;
        }
    }
    return std::copysign(spring, constant);
}

} // namespace brace::effects::coulomb_friction
