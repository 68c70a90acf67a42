#include "node/pressed_limb.h"

#include <Eigen/Geometry>
#include <cmath>

#include "effects/gravity.h"
#include "effects/joint_zero_offset.h"
#include "node/contact.h"

namespace brace::node {
namespace {

using effects::kCoxa;
using effects::kFemur;
using effects::kTibia;
using Eigen::Vector3d;
using plant::InPlane;
using plant::InSpace;
using plant::LimbState;

constexpr double kLeast_rad = 1e-5; // turns of a limb's weight of some newtons by less than its ten thousandth part

const Vector3d kSense = {1.0, 1.0, -1.0}; // of theta0, theta1 and theta2, counter-clockwise being positive

// A limb's place on the axes of its world, and back.
template <class World> plant::Vector<World::kAxes> on_axes_of(const Vector3d &place)
{
    if constexpr (World::kAxes == 2) {
        return {place.x(), place.z()};
    } else {
        return place;
    }
}

Vector3d in_space(const Eigen::Vector2d &place)
{
    return {place.x(), 0.0, place.y()};
}

Vector3d in_space(const Vector3d &place)
{
    return place;
}

Eigen::Matrix3d about_yaw_axis(double angle_rad)
{
    return Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()).toRotationMatrix();
}

std::variant<LimbState<InPlane>, LimbState<InSpace>> state_of(const plant::Model &model)
{
    using State = std::variant<LimbState<InPlane>, LimbState<InSpace>>;
    return has_coxa_joint(model) ? State(std::in_place_type<LimbState<InSpace>>, model, plant::Displacements::finite)
                                 : State(std::in_place_type<LimbState<InPlane>>, model, plant::Displacements::finite);
}

} // namespace

bool has_coxa_joint(const plant::Model &model)
{
    bool yields = model.joint[kCoxa].compliance_rad_per_n_mm > 0.0;
    for (const int index : {kCoxa, kFemur, kTibia}) {
        const auto &link = model.link[index];
        // The tip lies on the tibia's axis, so no force there twists the tibia.
        yields = yields || link.lateral_mm_per_n > 0.0 || (index != kTibia && link.torsion_rad_per_n_mm > 0.0);
    }
    return yields;
}

PressedLimb::PressedLimb(const plant::Model &model) : model_(model), sound_(model), state_(state_of(model_)) {}

Vector3d PressedLimb::unbent_rad(const Vector3d &motor_rad) const
{
    Vector3d unbent;
    for (const int joint : {kCoxa, kFemur, kTibia}) {
        unbent[joint] = effects::joint_zero_offset::true_angle_rad(model_, joint, motor_rad[joint]);
    }
    return unbent;
}

Vector3d PressedLimb::tip_mm(const Vector3d &motor_rad) const
{
    const Vector3d theta = unbent_rad(motor_rad);
    const auto &length = model_.geometry;
    const double shin = theta[kFemur] - theta[kTibia];
    return {length.coxa_mm + length.femur_mm * std::cos(theta[kFemur]) + length.tibia_mm * std::cos(shin), 0.0,
            length.femur_mm * std::sin(theta[kFemur]) + length.tibia_mm * std::sin(shin)};
}

void PressedLimb::take_hold(const Vector3d &motor_rad, double hold_n_per_mm, const Vector3d &press_mm, double t_s,
                            double temp_degc)
{
    std::visit(
        [&](auto &state) {
            // Creep goes on until now.
            (void)state.move_to(motor_rad[kFemur], motor_rad[kTibia], {t_s, temp_degc});
            state.start_run(false, contact_yields_mm_per_n(hold_n_per_mm));
        },
        state_);
    anchor_mm_ = about_yaw_axis(unbent_rad(motor_rad)[kCoxa]) * (tip_mm(motor_rad) + press_mm);
}

void PressedLimb::soften(int joint, double ratio)
{
    const double now = sound_.joint[joint].compliance_rad_per_n_mm / ratio;
    if (model_.joint[joint].compliance_rad_per_n_mm != now) {
        model_.joint[joint].compliance_rad_per_n_mm = now;
        std::visit([](auto &state) { state.model_changed(); }, state_);
    }
}

Vector3d PressedLimb::unloaded_tip_mm(const Vector3d &motor_rad) const
{
    return about_yaw_axis(unbent_rad(motor_rad)[kCoxa]) * tip_mm(motor_rad);
}

void PressedLimb::stand_at(const Vector3d &tip_mm, const Vector3d &down, bool follows)
{
    is_on_body_ = true;
    follows_ = follows;
    anchor_mm_ = tip_mm;
    down_ = down;
}

// Weights pull where the body has turned them to. A smaller turn waits, for it costs a new structure.
void PressedLimb::lean(double theta0_rad)
{
    const Vector3d down = about_yaw_axis(-theta0_rad) * down_;
    if ((down - effects::gravity::down_in_space(model_)).squaredNorm() > kLeast_rad * kLeast_rad) {
        model_.gravity.direction_rad = std::atan2(down.z(), down.x());
        model_.gravity.lean_rad = std::atan2(down.y(), std::sqrt(down.x() * down.x() + down.z() * down.z()));
    }
}

bool PressedLimb::settle(const Vector3d &motor_rad, double t_s, double temp_degc, Pressed &pressed)
{
    const Vector3d unbent = unbent_rad(motor_rad);
    if (is_on_body_) {
        lean(unbent[kCoxa]);
        const Vector3d unloaded_mm = unloaded_tip_mm(motor_rad);
        if (follows_) {
            anchor_mm_ += unloaded_mm - unloaded_mm_;
        }
        unloaded_mm_ = unloaded_mm;
    }
    const Vector3d held_mm = about_yaw_axis(-unbent[kCoxa]) * anchor_mm_ - tip_mm(motor_rad);
    const auto settle_in = [&](auto &state, auto world) {
        using World = decltype(world);
        constexpr int kJoints = World::kAxes;
        if (!state.move_to(motor_rad[kFemur], motor_rad[kTibia], {t_s, temp_degc})) {
            return false;
        }
        const plant::LimbRest<kJoints> rest = state.hold_tip(on_axes_of<World>(held_mm));
        pressed.force_n = in_space(rest.force_n);
        pressed.solved = rest.solved;
        pressed.link_rad = unbent;
        for (int k = 0; k < kJoints; ++k) {
            const int joint = World::kFirstJoint + k;
            const auto i = static_cast<std::size_t>(k);
            pressed.load_n_mm[joint] = -kSense[joint] * rest.joint_torque_n_mm[i];
            pressed.link_rad[joint] += kSense[joint] * rest.joint_deflection_rad[i];
            pressed.flank[static_cast<std::size_t>(joint)] = flank_that_carries(state.law(i), pressed.load_n_mm[joint]);
        }
        const plant::Vector<kJoints> sense = kSense.tail<kJoints>();
        const plant::LimbHeld<kJoints> held = state.held();
        pressed.stiffness_n_mm_per_rad.bottomRightCorner<kJoints, kJoints>() =
            -(sense.asDiagonal() * held.torque_n_mm_per_rad * sense.asDiagonal());
        if constexpr (kJoints == 3) {
            const Eigen::Matrix3d yaw = about_yaw_axis(unbent[kCoxa]);
            const Vector3d hip_mm(model_.geometry.coxa_mm, 0.0, 0.0);
            pull_ = {anchor_mm_, yaw * rest.force_n, yaw * held.stiffness_n_per_mm * yaw.transpose(),
                     yaw * held.carried_n, yaw * (held.carried_n_mm + hip_mm.cross(held.carried_n))};
        }
        return true;
    };
    if (auto *in_plane = std::get_if<LimbState<InPlane>>(&state_)) {
        return settle_in(*in_plane, InPlane{});
    }
    return settle_in(std::get<LimbState<InSpace>>(state_), InSpace{});
}

} // namespace brace::node
