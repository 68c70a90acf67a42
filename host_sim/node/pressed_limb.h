// The quasi-static limb between its motors and a contact that holds its tip: in its plane, or in space where it has a
// coxa joint.
#pragma once

#include <Eigen/Core>
#include <array>
#include <variant>

#include "node/pull.h"
#include "plant/limb_state.h"

namespace brace::node {

// A limb has a coxa joint when something yields across its plane.
bool has_coxa_joint(const plant::Model &model);

// Of the joints [0] coxa, [1] femur, [2] tibia, in their own senses: theta0 counter-clockwise seen from above, theta1
// counter-clockwise, theta2 the knee's flexion. Without a coxa joint nothing acts on it, and it stands as its motor.
// Directions are those of the limb's plane at the coxa motor's angle: x outwards, y to the left, z up.
struct Pressed {
    Eigen::Vector3d force_n = Eigen::Vector3d::Zero();   // force of the contact on the tip
    Eigen::Vector3d load_n_mm = Eigen::Vector3d::Zero(); // torque of each motor on its link
    Eigen::Vector3d link_rad = Eigen::Vector3d::Zero();  // true joint angles
    std::array<int, 3> flank{};                          // flank that carries; 0: the gap is open
    Eigen::Matrix3d stiffness_n_mm_per_rad = Eigen::Matrix3d::Zero(); // load per motor angle, every gap closed
    bool solved = true;
};

class PressedLimb {
public:
    explicit PressedLimb(const plant::Model &model);
    PressedLimb(const PressedLimb &) = delete;
    PressedLimb &operator=(const PressedLimb &) = delete;

    // Holds the tip at press_mm from its unloaded place at these motor angles. 0 stiffness: the tip is free.
    void take_hold(const Eigen::Vector3d &motor_rad, double hold_n_per_mm, const Eigen::Vector3d &press_mm, double t_s,
                   double temp_degc);

    // A joint's stiffness, as a share of its model's.
    void soften(int joint, double ratio);

    // Finds the rest state. False: nothing yields in some direction.
    bool settle(const Eigen::Vector3d &motor_rad, double t_s, double temp_degc, Pressed &pressed);

    // A limb in space under a body (body.h). All in the frame of pull.h; stand_at() after take_hold().
    // follows: the tip is off the ground, and goes where the motors move it.
    void stand_at(const Eigen::Vector3d &tip_mm, const Eigen::Vector3d &down, bool follows);
    Eigen::Vector3d unloaded_tip_mm(const Eigen::Vector3d &motor_rad) const;
    const Pull &pull() const { return pull_; } // as settle() left it

private:
    Eigen::Vector3d unbent_rad(const Eigen::Vector3d &motor_rad) const; // true joint angles, with nothing bent
    // From the yaw axis, in the limb's plane.
    Eigen::Vector3d tip_mm(const Eigen::Vector3d &motor_rad) const;

    void lean(double theta0_rad);

    plant::Model model_;
    const plant::Model sound_;
    std::variant<plant::LimbState<plant::InPlane>, plant::LimbState<plant::InSpace>> state_;
    Eigen::Vector3d anchor_mm_ = Eigen::Vector3d::Zero(); // where the contact stands, seen from the robot

    bool is_on_body_ = false, follows_ = false;
    Eigen::Vector3d down_ = Eigen::Vector3d::Zero();       // in the limb's frame
    Eigen::Vector3d unloaded_mm_ = Eigen::Vector3d::Zero(); // the unloaded tip when it settled last
    Pull pull_{};
};

} // namespace brace::node
