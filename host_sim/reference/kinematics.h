// Joint angles to tip and back, in long double.
#pragma once

#include <Eigen/Core>

namespace brace::reference {

using Real = long double;
using Vector3 = Eigen::Matrix<Real, 3, 1>;

struct Lengths {
    Real coxa_mm;
    Real femur_mm;
    Real tibia_mm;
};

struct Posture {
    Real theta1_rad;
    Real theta2_rad;
};

// Tip in the robot's base frame: origin on the yaw axis at the height of the femur axis.
Vector3 tip_mm(const Lengths &lengths, Real theta0_rad, const Posture &posture);

// False: the tip is out of reach.
bool posture_at(const Lengths &lengths, Real r_mm, Real phi_rad, bool knee_up, Posture &posture);

} // namespace brace::reference
