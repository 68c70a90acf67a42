// The contact at the tip, and which flank of a gap carries.
#pragma once

#include <algorithm>
#include <cmath>

#include "plant/joint_law.h"

namespace brace::node {

// A free tip is held by almost nothing: 1e-3 N a metre.
inline constexpr double kFree_n_per_mm = 1e-6;
inline constexpr double kOpen_n_mm = 1e-3; // a gap that carries a smaller load counts as open

// The compliance of a contact. Infinite stiffness: it does not yield.
inline double contact_yields_mm_per_n(double hold_n_per_mm)
{
    return std::isinf(hold_n_per_mm) ? 0.0 : 1.0 / std::max(hold_n_per_mm, kFree_n_per_mm);
}

// +1 or -1: the flank that carries the load; 0: the gap is open, or there is no load.
inline int flank_that_carries(const plant::JointLaw &law, double load_n_mm)
{
    const double held_n_mm = effects::coulomb_friction::most_n_mm(law, 0.0);
    const bool carries = !effects::backlash::acts(law) || std::fabs(load_n_mm) > held_n_mm + kOpen_n_mm;
    return carries ? (load_n_mm > 0.0) - (load_n_mm < 0.0) : 0;
}

} // namespace brace::node
