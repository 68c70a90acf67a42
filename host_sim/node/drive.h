// The servos of joints that load one another: P and D on the motor's angle, inertia, dry friction, bounded torque.
// Implicit Euler keeps it stable whatever the motors drive, and holds a motor exactly where friction holds it.
#pragma once

#include <Eigen/Core>

extern "C" {
#include "api/brace_node.h"
}

namespace brace::node {

struct Motor {
    double angle_rad = 0.0;
    double speed_rad_per_s = 0.0;
    double torque_n_mm = 0.0;
    double limit_n_mm = 0.0; // present limit of the torque
};

// One step of the motors of N joints: 2 in the limb's plane, 3 in space. drive and motor have N entries each.
//   load_n_mm: torque that each motor has to bring to its link, at the present angles
//   stiffness_n_mm_per_rad: the largest change of that torque with the angles
template <int N>
void step_motors(const brace_node_drive_t *drive, double dt_s, const Eigen::Matrix<double, N, 1> &set_rad,
                 const Eigen::Matrix<double, N, 1> &load_n_mm,
                 const Eigen::Matrix<double, N, N> &stiffness_n_mm_per_rad, Motor *motor);

} // namespace brace::node
