// K, its eigenvalues and stiff axis from C, in long double.
#pragma once

#include <array>

#include "reference/elements.h"

namespace brace::reference {

// Row layouts as in api/brace_host.h. False: nothing yields in some direction.
bool planar(const Limb &limb, const Posture &posture, std::array<double, 9> &row);
bool spatial(const Limb &limb, Real theta0_rad, const Posture &posture, std::array<double, 18> &row);

} // namespace brace::reference
