// One joint's spring with play and hardening: torque, stiffness, and the deflection at a torque. What each law does,
// its file in effects/ says.
#pragma once

#include <cmath>

#include "effects/backlash.h"
#include "effects/coulomb_friction.h"
#include "effects/joint_compliance.h"
#include "effects/joint_hardening.h"

namespace brace::plant {

// A joint's numbers of limb.toml, at one time and temperature. The zero offset is not used here: it acts on the
// commanded angle.
using JointLaw = effects::Joint;

inline bool rubs(const JointLaw &law)
{
    return effects::coulomb_friction::acts(law);
}

// True for a spring alone: its deflection is compliance * torque whatever came before.
inline bool is_linear(const JointLaw &law)
{
    return !effects::backlash::acts(law) && !rubs(law) && !effects::joint_hardening::acts(law);
}

// False for a rigid joint without play.
inline bool can_turn(const JointLaw &law)
{
    return law.compliance_rad_per_n_mm != 0.0 || effects::backlash::acts(law);
}

// The part of the deflection that the spring feels.
inline double elastic_rad(const JointLaw &law, double deflection_rad)
{
    return effects::backlash::beyond_rad(law, deflection_rad);
}

// The spring's torque, without friction. Needs compliance > 0.
inline double spring_torque_n_mm(const JointLaw &law, double deflection_rad)
{
    const double elastic = elastic_rad(law, deflection_rad);
    return effects::joint_compliance::torque_n_mm(law, elastic) + effects::joint_hardening::torque_n_mm(law, elastic);
}

inline double spring_stiffness_n_mm_per_rad(const JointLaw &law, double deflection_rad)
{
    if (effects::backlash::is_open(law, deflection_rad)) {
        return 0.0;
    }
    return effects::joint_compliance::stiffness_n_mm_per_rad(law)
           + effects::joint_hardening::stiffness_n_mm_per_rad(law, elastic_rad(law, deflection_rad));
}

// The largest torque that friction holds at this deflection, and how fast it grows with the deflection.
inline double friction_n_mm(const JointLaw &law, double deflection_rad)
{
    return rubs(law) ? effects::coulomb_friction::most_n_mm(law, spring_torque_n_mm(law, deflection_rad)) : 0.0;
}

inline double friction_slope_n_mm_per_rad(const JointLaw &law, double deflection_rad)
{
    const double by_torque = effects::coulomb_friction::slope(law, spring_torque_n_mm(law, deflection_rad));
    return std::copysign(by_torque * spring_stiffness_n_mm_per_rad(law, deflection_rad), deflection_rad);
}

// Elastic deflection under a torque, without friction.
inline double elastic_under_torque_rad(const JointLaw &law, double torque_n_mm)
{
    return effects::joint_hardening::deflection_rad(law, torque_n_mm);
}

} // namespace brace::plant
