// A joint deflects further with delay: the delayed deflection approaches ratio * elastic with one time constant. The
// elastic deflection stands still between readings, so the step is exact.
// Reads creep.*; depends on time and what came before.
#pragma once

#include <cmath>

#include "effects/effect.h"

namespace brace::effects::creep {

inline bool acts(const Model &model)
{
    return model.creep.ratio != 0.0;
}

// In dt the delayed deflection goes this share of the way to its target.
inline double approach(const Model &model, double dt_s)
{
    return -std::expm1(-dt_s / model.creep.time_constant_s);
}

inline double delayed_rad(const Model &model, double before_rad, double elastic_rad, double approach)
{
    return before_rad + approach * (model.creep.ratio * elastic_rad - before_rad);
}

} // namespace brace::effects::creep
