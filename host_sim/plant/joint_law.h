// One joint's spring with play and hardening: torque, stiffness, and the deflection at a torque.
#pragma once

#include "effects/effect.h"

namespace brace::plant {

struct JointLaw {
    double compliance_rad_per_n_mm = 0.0; // at the row's temperature
    double gap_rad = 0.0;
    double coulomb_n_mm = 0.0;
    double coulomb_per_load_ratio = 0.0; // [0, 1)
    double hardening_n_mm_per_rad3 = 0.0;

    bool rubs() const { return coulomb_n_mm > 0.0 || coulomb_per_load_ratio > 0.0; }
};

JointLaw joint_law(const effects::Model &model, int joint, double temp_degc);

// Nothing but a spring: its deflection is compliance * torque whatever came before.
bool is_linear(const JointLaw &law);

// Needs compliance > 0. Friction left out.
double spring_torque_n_mm(const JointLaw &law, double deflection_rad);
double spring_stiffness_n_mm_per_rad(const JointLaw &law, double deflection_rad);

// The most that friction holds at this deflection, and how fast that grows with it.
double friction_n_mm(const JointLaw &law, double deflection_rad);
double friction_slope_n_mm_per_rad(const JointLaw &law, double deflection_rad);

// The part of the deflection that the spring feels.
double elastic_rad(const JointLaw &law, double deflection_rad);

// Elastic deflection under a torque, friction left out.
double elastic_under_torque_rad(const JointLaw &law, double torque_n_mm);

} // namespace brace::plant
