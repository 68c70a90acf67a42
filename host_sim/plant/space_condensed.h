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

using SpaceShape = ShapeOf<3, kMostSpaceBodies>;

class SpaceCondensed {
public:
    // Linearises about a shape.
    void about(const SpaceStructure &structure, const std::array<JointHinge, 3> &joint, const SpaceShape &shape);

    // As Condensed tells them.
    const Eigen::Vector3d &tip_mm() const { return tip_mm_; }
    double torque_n_mm(int joint) const { return torque_n_mm_[joint]; }
    const Eigen::Matrix3d &compliance_mm_per_n() const { return compliance_mm_per_n_; }
    Eigen::Vector3d lever_mm(int joint) const { return lever_mm_.col(joint); }
    const Eigen::Matrix3d &torque_n_mm_per_rad() const { return torque_n_mm_per_rad_; }
    int negative_pivots() const { return negative_pivots_; }

    double follow(const Change<3> &change, SpaceShape &shape, std::array<double, 3> &torque_n_mm) const;

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
    int negative_pivots_ = 0;
    std::array<Hinge, kMostSpaceBodies> hinge_;
    std::array<int, kMostSpaceBodies> body_of_; // of each hinge
    Eigen::Vector3d tip_mm_, torque_n_mm_;
    Eigen::Matrix3d lever_mm_, compliance_mm_per_n_, torque_n_mm_per_rad_;
};

} // namespace brace::plant
