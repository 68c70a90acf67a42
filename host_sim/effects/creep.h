// A joint deflects further with delay: the delayed deflection approaches ratio * elastic with one time constant. The
// elastic deflection stands still between readings, so the step is exact.
#pragma once

#include <cmath>

#include "effects/effect.h"

namespace brace::effects::creep {

// In dt the delayed deflection goes this share of the way to its target.
inline double approach(double time_constant_s, double dt_s)
{
    return -std::expm1(-dt_s / time_constant_s);
}

inline double delayed_rad(double before_rad, double ratio, double elastic_rad, double approach)
{
    return before_rad + approach * (ratio * elastic_rad - before_rad);
}

} // namespace brace::effects::creep
