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

#include "plant/lanes.h"
#include "plant/shape.h"
#include "plant/structure.h"

namespace brace::plant {

// Number: double for one limb, Lanes for four that have the same bodies.
template <class Number> class CondensedOf {
public:
    using Shape = ShapeOf<Number, 2, kMostBodies>;
    using Followed = FollowedOf<Number, 2, kMostBodies>;

    // Linearises about a shape.
    void about(const StructureOf<Number> &structure, const std::array<JointHingeOf<Number>, 2> &joint,
               const Shape &shape);

    const TangentOf<Number, 2> &tangent() const { return tangent_; }

    // Where the limb comes to rest under a change. shape: the one that it was linearised about.
    void follow(const ChangeOf<Number, 2> &change, const Shape &shape, Followed &followed) const;

private:
    struct Hinge {
        int joint;
        Number curvature_n_mm_per_rad; // W_phiphi before the elimination
        Eigen::Matrix<Number, 2, 1> lever_mm; // W_phiy
        std::array<Number, 2> by_turn_n_mm_per_rad;
        Number torque_n_mm;
        Number turn_per_torque; // c / p
        Number lacks_rad; // turn to rest while nothing else changes
    };

    void linearise(const StructureOf<Number> &structure, const std::array<JointHingeOf<Number>, 2> &joint,
                   const Shape &shape);
    void go(const ChangeOf<Number, 2> &change, const Shape &shape, Followed &followed) const;

    std::size_t count_ = 0;
    std::array<Hinge, kMostBodies> hinge_;
    TangentOf<Number, 2> tangent_;
};

template <>
void CondensedOf<double>::about(const StructureOf<double> &structure, const std::array<JointHingeOf<double>, 2> &joint,
                                const Shape &shape);
template <>
void CondensedOf<double>::follow(const ChangeOf<double, 2> &change, const Shape &shape, Followed &followed) const;
template <>
void CondensedOf<Lanes>::about(const StructureOf<Lanes> &structure, const std::array<JointHingeOf<Lanes>, 2> &joint,
                               const Shape &shape);
template <>
void CondensedOf<Lanes>::follow(const ChangeOf<Lanes, 2> &change, const Shape &shape, Followed &followed) const;

using Condensed = CondensedOf<double>;

} // namespace brace::plant
