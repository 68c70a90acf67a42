// The two servos of the limb's plane: P and D on the motor's angle, inertia, dry friction, bounded torque.
// Implicit Euler: stable whatever stands behind the motors, and friction holds exactly.
#pragma once

#include <Eigen/Core>
#include <array>

extern "C" {
#include "api/brace_node.h"
}

namespace brace::node
{

struct Motor {
    double angle_rad = 0.0;
    double speed_rad_per_s = 0.0;
    double torque_n_mm = 0.0;
    double limit_n_mm = 0.0; // of the torque, now
};

// One step. load_n_mm: torque that each motor has to bring to what hangs on it, at the angles now;
// stiffness_n_mm_per_rad: how it grows with the angles, at most.
void step_motors(const std::array<const brace_node_drive_t *, 2> &drive, double dt_s,
                 const Eigen::Vector2d &set_rad, const Eigen::Vector2d &load_n_mm,
                 const Eigen::Matrix2d &stiffness_n_mm_per_rad, std::array<Motor, 2> &motor);

} // namespace brace::node
