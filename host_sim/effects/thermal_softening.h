// Joints yield more when warm: compliance times 1 + rate * (temperature - reference).
// Reads thermal.*; depends on temperature.
#pragma once

#include <algorithm>

#include "effects/effect.h"

namespace brace::effects::thermal_softening {

// The factor stays above zero, because no temperature makes a spring push the wrong way.
inline double factor(const Model &model, double temp_degc)
{
    const double linear = 1.0 + model.thermal.joint_compliance_per_degc * (temp_degc - model.thermal.reference_degc);
    return std::max(linear, 1e-3);
}

struct Change : NoChange {
    static bool acts(const Model &model) { return model.thermal.joint_compliance_per_degc != 0.0; }

    static void of_joint(const Model &model, const Conditions &conditions, int, Joint &now)
    {
        now.compliance_rad_per_n_mm *= factor(model, conditions.temp_degc);
    }
};

} // namespace brace::effects::thermal_softening
