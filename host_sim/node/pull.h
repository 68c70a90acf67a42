// What a limb is to the body that it carries, in the limb's own frame: x outwards at theta0 = 0, y to the left, z up;
// its origin is where it is fixed, on the yaw axis at the height of the femur joint.
#pragma once

#include <Eigen/Core>

namespace brace::node {

struct Pull {
    Eigen::Vector3d tip_mm;             // where the tip is held
    Eigen::Vector3d force_n;            // of the ground on the tip
    Eigen::Matrix3d stiffness_n_per_mm; // of the tip, gaps closed
    Eigen::Vector3d carried_n;          // tip force and weights: what the limb brings to the body
    Eigen::Vector3d carried_n_mm;       // their moment about the origin
};

} // namespace brace::node
