#include "node/pressed_limb.h"

#include <cmath>

#include "effects/joint_zero_offset.h"
#include "node/contact.h"
#include "node/coxa_chain.h"
#include "plant/joint_law.h"

namespace brace::node
{
namespace
{

using Eigen::Vector2d;

constexpr double kSense[] = {1.0, -1.0}; // of theta1 and theta2, counter-clockwise being positive

// A coxa link yields in the plane as a part of the base does, and points along x.
plant::Model with_coxa_link_in_base(plant::Model model)
{
    if (has_coxa_joint(model)) {
        model.base.x_mm_per_n += model.link[effects::kCoxa].axial_mm_per_n;
        model.base.z_mm_per_n += model.link[effects::kCoxa].bending_mm_per_n;
    }
    return model;
}

} // namespace

PressedLimb::PressedLimb(const plant::Model &model)
    : model_(with_coxa_link_in_base(model)), state_(model_, plant::Displacements::finite)
{
}

Vector2d PressedLimb::unbent_rad(const Vector2d &motor_rad) const
{
    return {effects::joint_zero_offset::true_angle_rad(model_, effects::kFemur, motor_rad[0]),
            effects::joint_zero_offset::true_angle_rad(model_, effects::kTibia, motor_rad[1])};
}

Vector2d PressedLimb::tip_mm(const Vector2d &motor_rad) const
{
    const Vector2d theta = unbent_rad(motor_rad);
    const double shin = theta[0] - theta[1];
    return model_.geometry.femur_mm * Vector2d(std::cos(theta[0]), std::sin(theta[0]))
           + model_.geometry.tibia_mm * Vector2d(std::cos(shin), std::sin(shin));
}

void PressedLimb::take_hold(const Vector2d &motor_rad, double hold_n_per_mm, const Vector2d &press_mm,
                            double t_s, double temp_degc)
{
    (void)state_.move_to(motor_rad[0], motor_rad[1], t_s, temp_degc); // creep goes on until now
    state_.start_run(false, contact_yields_mm_per_n(hold_n_per_mm));
    anchor_mm_ = tip_mm(motor_rad) + press_mm;
}

bool PressedLimb::settle(const Vector2d &motor_rad, double t_s, double temp_degc, Pressed &pressed)
{
    if (!state_.move_to(motor_rad[0], motor_rad[1], t_s, temp_degc)) {
        return false;
    }
    const plant::LimbRest rest = state_.hold_tip(anchor_mm_ - tip_mm(motor_rad));
    const Vector2d unbent = unbent_rad(motor_rad);
    const Vector2d sense(kSense[0], kSense[1]);
    pressed.force_n = rest.force_n;
    pressed.solved = rest.solved;
    for (const int i : {0, 1}) {
        const auto k = static_cast<std::size_t>(i);
        const plant::JointLaw law = plant::joint_law(model_, effects::kFemur + i, temp_degc);
        pressed.load_n_mm[i] = -kSense[i] * rest.joint_torque_n_mm[k];
        pressed.link_rad[i] = unbent[i] + kSense[i] * rest.joint_deflection_rad[k];
        pressed.flank[k] = flank_that_carries(law, pressed.load_n_mm[i]);
    }
    pressed.stiffness_n_mm_per_rad =
        -(sense.asDiagonal() * state_.torque_per_motor_turn() * sense.asDiagonal());
    return true;
}

} // namespace brace::node
