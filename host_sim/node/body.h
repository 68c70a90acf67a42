// A body on the tips of its limbs: a rigid body with six degrees of freedom, each foot on its ground (feet.h).
//
// It is quasi-static, as its limbs are. A step of time takes it towards its equilibrium by implicit Euler, as a body in
// a viscous medium: D v = what weight, payload and limbs leave unbalanced. D is kTau_s times the body's stiffness on
// all its feet when it was put down, so every direction comes to rest as exp(-t / kTau_s), four steps of the motors,
// and without swinging. At rest D bears nothing: the rest depends on D only where loads come faster than it and
// friction remembers in which order feet slid.
//
// The world is the body's frame where the body stands without load; there the ground stands still and weights pull.
#pragma once

#include <Eigen/Core>
#include <array>

#include "node/feet.h"
#include "node/pull.h"

namespace brace::node {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Where a limb is fixed to the body, and the ground under its foot; in the body's frame without load.
struct Mount {
    Eigen::Vector3d at_mm;
    Eigen::Matrix3d turn; // the limb's frame into the body's
    Eigen::Vector3d tip_mm; // of the limb without load
    Eigen::Vector3d foothold_mm; // where the tip is held when the weight has come
    Eigen::Vector3d normal;
    double friction_ratio;
    double grip_n;
};

struct BodyLoads {
    double weight_n;
    Eigen::Vector3d com_mm, down; // down: unit vector in the world
    Eigen::Vector3d payload_n, payload_at_mm;
};

class Body {
public:
    static constexpr double kTau_s = 0.004;

    Body(const BodyLoads &loads, const std::array<Mount, kMostFeet> &mount, int count);

    // One step. share: of the weight, and of the footholds' way from the unloaded tips; it grows to 1 as the body is
    // put down. pull: as the limbs are now; tip_mm is read of feet that are off the ground.
    void step(double dt_s, double share, double payload_factor, const std::array<Pull, kMostFeet> &pull);

    // Where the ground holds a limb's tip, and where weights pull to, in the limb's frame.
    Eigen::Vector3d tip_mm(int limb) const;
    Eigen::Vector3d down(int limb) const;

    bool is_off_ground(int limb) const;
    // The foot bears nothing until it is set down again: where it then is, it grips anew.
    void lift_off(int limb) { at(limb).is_gone = true; }
    void set_down(int limb) { at(limb).is_gone = has_fallen_; }
    // A foot whose grip is released only presses, and may leave the ground and come back.
    void release(int limb, bool released);
    // Every foot bears nothing, and the body stays where it is.
    void fall();

    Contact contact(int limb) const { return at(limb).contact; }
    Eigen::Vector3d force_n(int limb) const; // of the ground on the foot, in the body's frame
    const Eigen::Vector3d &foot_mm(int limb) const { return at(limb).place_mm; } // in the world
    const Eigen::Vector3d &moved_mm() const { return moved_mm_; }
    Eigen::Vector3d turned_rad() const; // rotation vector
    // The forces that are not balanced, as a share of those that act; moments by the feet's mean distance.
    double unbalanced() const { return unbalanced_; }

private:
    struct Standing {
        Mount mount;
        Eigen::Matrix3d ground; // columns: normal, two directions along the ground
        Eigen::Vector3d place_mm; // of the foot
        Eigen::Vector3d under_mm; // a point of the ground
        Eigen::Vector3d force_n;
        bool is_gone, is_released;
        Contact contact;
    };
    const Standing &at(int limb) const { return foot_[static_cast<std::size_t>(limb)]; }
    Standing &at(int limb) { return foot_[static_cast<std::size_t>(limb)]; }
    double gap_mm(const Standing &foot) const;
    void set_viscosity(const Matrix6 &stiffness);
    void take_foot(Standing &foot, const Foot &found);

    const BodyLoads loads_;
    const int count_;
    std::array<Standing, kMostFeet> foot_{};
    double lever_mm_ = 0.0;
    Eigen::Vector3d moved_mm_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d turned_ = Eigen::Matrix3d::Identity();
    Matrix6 viscosity_ = Matrix6::Zero(); // D
    bool has_viscosity_ = false, has_fallen_ = false;
    double share_ = 0.0, unbalanced_ = 0.0;
};

} // namespace brace::node
