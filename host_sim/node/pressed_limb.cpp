#include "node/pressed_limb.h"

#include <Eigen/LU>
#include <cmath>

#include "effects/joint_zero_offset.h"
#include "node/contact.h"
#include "node/coxa_chain.h"
#include "plant/joint_law.h"
#include "plant/structure.h"

namespace brace::node
{
namespace
{

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kSense[] = {1.0, -1.0}; // of theta1 and theta2, counter-clockwise being positive
constexpr double kSmallestShare = 1e-12; // share of compliance that gives a rigid direction a stiffness

// A coxa link yields in the plane as a part of the base does, and points along x.
Vector2d coxa_link_mm_per_n(const plant::Model &model)
{
    const auto &link = model.link[effects::kCoxa];
    return has_coxa_joint(model) ? Vector2d(link.axial_mm_per_n, link.bending_mm_per_n) : Vector2d(0.0, 0.0);
}

} // namespace

PressedLimb::PressedLimb(const plant::Model &model)
    : model_(model), base_x_mm_per_n_(model.base.x_mm_per_n + coxa_link_mm_per_n(model).x()),
      base_z_mm_per_n_(model.base.z_mm_per_n + coxa_link_mm_per_n(model).y()), state_(model_)
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
    const double yields_mm_per_n = contact_yields_mm_per_n(hold_n_per_mm);
    model_.base.x_mm_per_n = base_x_mm_per_n_ + yields_mm_per_n;
    model_.base.z_mm_per_n = base_z_mm_per_n_ + yields_mm_per_n;
    anchor_mm_ = tip_mm(motor_rad) + press_mm;
    (void)state_.move_to(motor_rad[0] + 1.0, motor_rad[1], t_s,
                         temp_degc); // its stored posture is old
    sound_ = state_.move_to(motor_rad[0], motor_rad[1], t_s, temp_degc);
    state_.start_run(false);
}

bool PressedLimb::settle(const Vector2d &motor_rad, double t_s, double temp_degc, Pressed &pressed)
{
    if (!sound_ || !state_.move_to(motor_rad[0], motor_rad[1], t_s, temp_degc)) {
        return false;
    }
    const plant::LimbRest rest = state_.hold_tip(anchor_mm_ - tip_mm(motor_rad));
    const plant::Structure &structure = state_.structure();
    const Vector2d unbent = unbent_rad(motor_rad);
    Matrix2d compliance = structure.compliance_mm_per_n;
    Matrix2d lever;
    pressed.force_n = rest.force_n;
    pressed.solved = rest.solved;
    for (const int i : {0, 1}) {
        const plant::JointLaw law = plant::joint_law(model_, effects::kFemur + i, temp_degc);
        const double torque = structure.lever_mm[i].dot(rest.force_n) + structure.gravity_n_mm[i];
        pressed.load_n_mm[i] = -kSense[i] * torque;
        pressed.link_rad[i] = unbent[i] + kSense[i] * rest.joint_deflection_rad[i];
        pressed.flank[i] = flank_that_carries(law, pressed.load_n_mm[i]);
        lever.col(i) = kSense[i] * structure.lever_mm[i];
        compliance += law.compliance_rad_per_n_mm * structure.lever_mm[i] * structure.lever_mm[i].transpose();
    }
    compliance += kSmallestShare * compliance.trace() * Matrix2d::Identity();
    pressed.stiffness_n_mm_per_rad = lever.transpose() * compliance.inverse() * lever;
    return true;
}

} // namespace brace::node
