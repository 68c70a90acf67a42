// A joint with play carries no torque within half of it to either side.
#pragma once

#include "effects/effect.h"

namespace brace::effects::backlash {

// The part of a deflection beyond the play: what the spring feels.
inline double beyond_rad(double deflection_rad, double gap_rad)
{
    const double half = 0.5 * gap_rad;
    if (deflection_rad > half) {
        return deflection_rad - half;
    }
    return deflection_rad < -half ? deflection_rad + half : 0.0;
}

inline void none(Model &model)
{
    for (auto &joint : model.joint) {
        joint.gap_rad = 0.0;
    }
}

inline constexpr const char *kLaw = "no torque while the deflection is within +-gap/2, a spring beyond";
inline constexpr Entry kEntries[] = {
    {"backlash", "joint.femur", "joint.femur.gap_rad", kLaw},
    {"backlash", "joint.tibia", "joint.tibia.gap_rad", kLaw},
};

} // namespace brace::effects::backlash
