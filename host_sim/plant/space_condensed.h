// The limb in space near a state of its hinges and of the tip force, as condensed.h has it in the plane: what it lacks
// to rest, and how tip and joint torques follow the force and the turns of joints that are kept.
//
// W(phi, y) is quadratic in the small rotation vector phi of the body that a hinge moves and in the kept unknowns
// y = (force, turns of the three joints, 1). A body of extent r that carries F adds r x F to the slope W_phi and
// (r F' + F r') / 2 - (r . F) 1 to W_phiphi. Two turns follow one another as phi + q z + q phi x z / 2, so a hinge
// about the axis z sees phi through g = W_phiphi z + z x W_phi / 2. With its compliance c and the pivot
// p = 1 - c z' W_phiphi z its elimination adds (c / p) times the square of (g, W_yphi z).
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/shape.h"
#include "plant/space_structure.h"

namespace brace::plant {

using SpaceShape = ShapeOf<double, 3, kMostSpaceBodies>;

class SpaceCondensed {
public:
    using Shape = SpaceShape;
    using Followed = FollowedOf<double, 3, kMostSpaceBodies>;

    // Linearises about a shape.
    void about(const SpaceStructure &structure, const std::array<JointHinge, 3> &joint, const SpaceShape &shape);

    const Tangent<3> &tangent() const { return tangent_; }

    // Of the tip force and the weights, about where the first body begins; all springs at rest.
    const Eigen::Vector3d &moment_n_mm() const { return moment_n_mm_; }

    // Where the limb comes to rest under a change. shape: the one that it was linearised about.
    void follow(const Change<3> &change, const SpaceShape &shape, Followed &followed) const;

private:
    struct Hinge {
        int joint;
        Eigen::Vector3d axis;        // as the body before it stands now
        double curvature_n_mm_per_rad; // z' W_phiphi z
        Eigen::Vector3d by_phi_n_mm_per_rad; // g
        Eigen::Vector3d lever_mm;
        Eigen::Vector3d by_turn_n_mm_per_rad; // by the kept turn of each joint
        double torque_n_mm;
        double turn_per_torque; // c / p
        double lacks_rad;
    };

    int count_ = 0; // of the hinges
    std::array<Hinge, kMostSpaceBodies> hinge_;
    std::array<int, kMostSpaceBodies> body_of_; // of each hinge
    Tangent<3> tangent_;
    Eigen::Vector3d moment_n_mm_;
};

} // namespace brace::plant
