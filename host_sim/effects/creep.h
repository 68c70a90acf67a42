// A joint's further, delayed deflection runs after ratio * elastic with one time constant; the elastic
// deflection is held between readings, so the step is exact.
#pragma once

#include <cmath>

#include "effects/effect.h"

namespace brace::effects::creep {

// Share of the way to its target that the delayed deflection goes in dt.
inline double approach(double time_constant_s, double dt_s)
{
    return -std::expm1(-dt_s / time_constant_s);
}

inline double delayed_rad(double before_rad, double ratio, double elastic_rad, double approach)
{
    return before_rad + approach * (ratio * elastic_rad - before_rad);
}

inline void none(Model &model)
{
    model.creep = {0.0, 1.0};
}

inline constexpr Entry kEntries[] = {
    {"creep", "creep", "creep.ratio creep.time_constant_s",
     "delayed' = (ratio * elastic - delayed) / time constant, for each joint"},
};

} // namespace brace::effects::creep
