// A joint with play carries no torque within half of it to either side.
#pragma once

#include "effects/effect.h"

namespace brace::effects::backlash {

// The spring feels only the part of the deflection beyond the play.
inline double beyond_rad(double deflection_rad, double gap_rad)
{
    const double half = 0.5 * gap_rad;
    if (deflection_rad > half) {
        return deflection_rad - half;
    }
    return deflection_rad < -half ? deflection_rad + half : 0.0;
}

} // namespace brace::effects::backlash
