// A joint with play carries no torque within half of it to either side.
// Reads joint.*.gap_rad; depends on the load.
#pragma once

#include <cmath>

#include "effects/effect.h"

namespace brace::effects::backlash {

inline bool acts(const Joint &joint)
{
    return joint.gap_rad != 0.0;
}

// The spring feels only the part of the deflection beyond the play.
inline double beyond_rad(const Joint &joint, double deflection_rad)
{
    const double half = 0.5 * joint.gap_rad;
    if (deflection_rad > half) {
        return deflection_rad - half;
    }
    return deflection_rad < -half ? deflection_rad + half : 0.0;
}

// Nothing pushes back within the play: there the slope of beyond_rad is 0, elsewhere 1.
inline bool is_open(const Joint &joint, double deflection_rad)
{
    return joint.gap_rad > 0.0 && beyond_rad(joint, deflection_rad) == 0.0;
}

// The smallest and the largest deflection at which the spring carries this torque with this elastic deflection.
inline double least_rad(const Joint &joint, double elastic_rad, double torque_n_mm)
{
    return elastic_rad + (torque_n_mm > 0.0 ? 0.5 : -0.5) * joint.gap_rad;
}

inline double most_rad(const Joint &joint, double elastic_rad, double torque_n_mm)
{
    return elastic_rad + (torque_n_mm < 0.0 ? -0.5 : 0.5) * joint.gap_rad;
}

} // namespace brace::effects::backlash
