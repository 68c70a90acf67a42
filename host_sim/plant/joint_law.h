// One joint's spring with play and hardening: torque, stiffness, and the deflection at a torque.
#pragma once

#include <cmath>

#include "effects/backlash.h"
#include "effects/coulomb_friction.h"
#include "effects/joint_compliance.h"
#include "effects/joint_hardening.h"
#include "effects/thermal_softening.h"

namespace brace::plant {

// A joint's numbers of limb.toml. The compliance is the one at the row's temperature. The zero offset is not here: it
// acts on the commanded angle.
struct JointLaw : brace_plant_joint_t {
    JointLaw() : brace_plant_joint_t{} {}

    bool rubs() const { return coulomb_n_mm > 0.0 || coulomb_per_load_ratio > 0.0; }
    effects::coulomb_friction::Friction friction() const
    {
        return {coulomb_n_mm, coulomb_per_load_ratio, coulomb_load_fade_per_n_mm};
    }
};

inline JointLaw joint_law(const effects::Model &model, int joint, double temp_degc)
{
    JointLaw law;
    static_cast<brace_plant_joint_t &>(law) = model.joint[joint];
    law.compliance_rad_per_n_mm *= effects::thermal_softening::factor(model, temp_degc);
    return law;
}

// True for a spring alone: its deflection is compliance * torque whatever came before.
inline bool is_linear(const JointLaw &law)
{
    return law.gap_rad == 0.0 && !law.rubs() && law.hardening_n_mm_per_rad3 == 0.0;
}

// The part of the deflection that the spring feels.
inline double elastic_rad(const JointLaw &law, double deflection_rad)
{
    return effects::backlash::beyond_rad(deflection_rad, law.gap_rad);
}

// The spring's torque, without friction. Needs compliance > 0.
inline double spring_torque_n_mm(const JointLaw &law, double deflection_rad)
{
    const double elastic = elastic_rad(law, deflection_rad);
    return effects::joint_compliance::torque_n_mm(law.compliance_rad_per_n_mm, elastic)
           + effects::joint_hardening::torque_n_mm(law.hardening_n_mm_per_rad3, elastic);
}

inline double spring_stiffness_n_mm_per_rad(const JointLaw &law, double deflection_rad)
{
    const double elastic = elastic_rad(law, deflection_rad);
    if (law.gap_rad > 0.0 && elastic == 0.0) {
        return 0.0;
    }
    return 1.0 / law.compliance_rad_per_n_mm
           + effects::joint_hardening::stiffness_n_mm_per_rad(law.hardening_n_mm_per_rad3, elastic);
}

// The largest torque that friction holds at this deflection, and how fast it grows with the deflection.
inline double friction_n_mm(const JointLaw &law, double deflection_rad)
{
    return law.rubs() ? effects::coulomb_friction::most_n_mm(law.friction(), spring_torque_n_mm(law, deflection_rad))
                      : 0.0;
}

inline double friction_slope_n_mm_per_rad(const JointLaw &law, double deflection_rad)
{
    const double load_n_mm = std::fabs(spring_torque_n_mm(law, deflection_rad));
    const double ratio = law.coulomb_per_load_ratio
                         * effects::coulomb_friction::felt_slope(load_n_mm, law.coulomb_load_fade_per_n_mm);
    return std::copysign(ratio * spring_stiffness_n_mm_per_rad(law, deflection_rad), deflection_rad);
}

// Elastic deflection under a torque, without friction.
inline double elastic_under_torque_rad(const JointLaw &law, double torque_n_mm)
{
    const double s = law.compliance_rad_per_n_mm;
    const double h = law.hardening_n_mm_per_rad3;
    if (h == 0.0 || s == 0.0) {
        return s * torque_n_mm;
    }
    // q / s + h q^3 = torque has one real root; Newton from the spring's answer falls on it from above.
    double q = s * std::fabs(torque_n_mm);
    for (int i = 0; i < 200; ++i) {
        const double step = (q / s + h * q * q * q - std::fabs(torque_n_mm)) / (1.0 / s + 3.0 * h * q * q);
        q -= step;
        if (step <= 1e-16 * q) {
            break;
        }
    }
    return std::copysign(q, torque_n_mm);
}

} // namespace brace::plant
