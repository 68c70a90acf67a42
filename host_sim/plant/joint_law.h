// One joint's spring with play and hardening: torque, stiffness, and the deflection at a torque.
#pragma once

#include "effects/effect.h"

namespace brace::plant {

// A joint's numbers of limb.toml. The compliance is the one at the row's temperature. The zero offset is not here: it
// acts on the commanded angle.
struct JointLaw : brace_plant_joint_t {
    JointLaw() : brace_plant_joint_t{} {}

    bool rubs() const { return coulomb_n_mm > 0.0 || coulomb_per_load_ratio > 0.0; }
};

JointLaw joint_law(const effects::Model &model, int joint, double temp_degc);

// True for a spring alone: its deflection is compliance * torque whatever came before.
bool is_linear(const JointLaw &law);

// The spring's torque, without friction. Needs compliance > 0.
double spring_torque_n_mm(const JointLaw &law, double deflection_rad);
double spring_stiffness_n_mm_per_rad(const JointLaw &law, double deflection_rad);

// The largest torque that friction holds at this deflection, and how fast it grows with the deflection.
double friction_n_mm(const JointLaw &law, double deflection_rad);
double friction_slope_n_mm_per_rad(const JointLaw &law, double deflection_rad);

// The part of the deflection that the spring feels.
double elastic_rad(const JointLaw &law, double deflection_rad);

// Elastic deflection under a torque, without friction.
double elastic_under_torque_rad(const JointLaw &law, double torque_n_mm);

} // namespace brace::plant
