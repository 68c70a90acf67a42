// The quasi-static limb between its motors and a contact that holds its tip.
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/limb_state.h"

namespace brace::node
{

// Joint senses: theta1 counter-clockwise, theta2 the knee's flexion. [0] femur, [1] tibia.
struct Pressed {
    Eigen::Vector2d force_n = Eigen::Vector2d::Zero();   // force of the contact on the tip
    Eigen::Vector2d load_n_mm = Eigen::Vector2d::Zero(); // torque of each motor on its link
    Eigen::Vector2d link_rad = Eigen::Vector2d::Zero();  // true joint angles
    std::array<int, 2> flank{};                          // flank that carries; 0: the gap is open
    Eigen::Matrix2d stiffness_n_mm_per_rad = Eigen::Matrix2d::Zero(); // load per motor angle, every gap closed
    bool solved = true;
};

class PressedLimb
{
public:
    explicit PressedLimb(const plant::Model &model);
    PressedLimb(const PressedLimb &) = delete;
    PressedLimb &operator=(const PressedLimb &) = delete;

    // Holds the tip at press_mm from its unloaded place at these motor angles. 0 stiffness: the tip is free.
    void take_hold(const Eigen::Vector2d &motor_rad, double hold_n_per_mm, const Eigen::Vector2d &press_mm,
                   double t_s, double temp_degc);

    // Finds the rest state. False: nothing yields in some direction.
    bool settle(const Eigen::Vector2d &motor_rad, double t_s, double temp_degc, Pressed &pressed);

private:
    Eigen::Vector2d unbent_rad(const Eigen::Vector2d &motor_rad) const; // true joint angles, with nothing bent
    Eigen::Vector2d tip_mm(const Eigen::Vector2d &motor_rad) const;

    const plant::Model model_; // its base has the coxa link's compliance too
    plant::LimbState state_;
    Eigen::Vector2d anchor_mm_ = Eigen::Vector2d::Zero();
};

} // namespace brace::node
