// Joints yield more when warm: compliance times 1 + rate * (temperature - reference).
#pragma once

#include <algorithm>

#include "effects/effect.h"

namespace brace::effects::thermal_softening {

// Kept above zero: no temperature makes a spring push the wrong way.
inline double factor(const Model &model, double temp_degc)
{
    const double linear =
        1.0 + model.thermal.joint_compliance_per_degc * (temp_degc - model.thermal.reference_degc);
    return std::max(linear, 1e-3);
}

inline void none(Model &model)
{
    model.thermal = {0.0, 22.0};
}

inline constexpr Entry kEntries[] = {
    {"thermal_softening", "thermal", "thermal.joint_compliance_per_degc",
     "joint compliance * (1 + rate * (temperature - reference))"},
};

} // namespace brace::effects::thermal_softening
