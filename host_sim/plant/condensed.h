// The limb near a state of its hinges and of the tip force: what it lacks to rest, and how tip and joint torques follow
// the force and the turns of joints that are kept. All else, the springs, is eliminated hinge by hinge from the tip to
// the base.
//
// W(phi, y), the work of the loads beyond a hinge, is quadratic in the turn phi of the body that the hinge moves and
// in the kept unknowns y = (force, turns of the two joints, 1); its slope by phi is the hinge's torque tau. A body adds
// its levers and loads (docs/physics.md, 'Under load'). A spring of compliance c turns by q = c tau. With the pivot
// p = 1 - c W_phiphi its elimination leaves
//   W_phiphi / p,   W_phiy / p,   W_yy + (c / p) W_yphi W_phiy
// Nothing is divided by a compliance, so a rigid hinge is no special case. Every negative pivot is a direction in which
// the limb would give way if its tip were let go (Sylvester).
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/shape.h"
#include "plant/structure.h"

namespace brace::plant {

using Shape = ShapeOf<2, kMostBodies>;

class Condensed {
public:
    // Linearises about a shape.
    void about(const Structure &structure, const std::array<JointHinge, 2> &joint, const Shape &shape);

    // With force and kept turns as they are and all springs at rest: displacement of the tip from its unloaded place,
    // and torques of the loads on the joints.
    const Eigen::Vector2d &tip_mm() const { return tip_mm_; }
    double torque_n_mm(int joint) const { return torque_n_mm_[static_cast<std::size_t>(joint)]; }
    // How these follow: the tip the force, the tip a turn and so a torque the force, a torque the turns.
    const Eigen::Matrix2d &compliance_mm_per_n() const { return compliance_mm_per_n_; }
    const Eigen::Vector2d &lever_mm(int joint) const { return lever_mm_[static_cast<std::size_t>(joint)]; }
    const Eigen::Matrix2d &torque_n_mm_per_rad() const { return torque_n_mm_per_rad_; }
    int negative_pivots() const { return negative_pivots_; }

    // Moves the shape to rest under a change. torque_n_mm: of the loads on the joints, there. Returns by how much the
    // body turns that turns most [rad].
    double follow(const Change<2> &change, Shape &shape, std::array<double, 2> &torque_n_mm) const;

private:
    struct Hinge {
        int joint;
        double curvature_n_mm_per_rad; // W_phiphi before the elimination
        Eigen::Vector2d lever_mm;      // W_phiy
        std::array<double, 2> by_turn_n_mm_per_rad;
        double torque_n_mm;
        double turn_per_torque; // c / p
        double lacks_rad;       // turn to rest while nothing else changes
    };

    int count_ = 0;
    int negative_pivots_ = 0;
    std::array<Hinge, kMostBodies> hinge_;
    Eigen::Vector2d tip_mm_;
    std::array<double, 2> torque_n_mm_;
    std::array<Eigen::Vector2d, 2> lever_mm_;
    Eigen::Matrix2d compliance_mm_per_n_, torque_n_mm_per_rad_;
};

} // namespace brace::plant
