// What one linearisation of the limb and the next share, in the plane (N = 2 axes and joints) and in space (3).
#pragma once

#include <Eigen/Core>
#include <array>

namespace brace::plant {

template <int N> using Vector = Eigen::Matrix<double, N, 1>;
template <int N> using Matrix = Eigen::Matrix<double, N, N>;

template <class Number, int N, int MostBodies> struct ShapeOf {
    std::array<Number, MostBodies> turn_rad{}; // of each hinge
    Eigen::Matrix<Number, N, 1> force_n = Eigen::Matrix<Number, N, 1>::Zero(); // on the tip
};

// A joint's hinge in the elimination: its spring, and a further turn that is kept.
template <class Number> struct JointHingeOf {
    Number compliance_rad_per_n_mm; // 0: only the kept turn is left
    Number unstrained_rad;          // turn of the hinge at which the spring carries nothing
};
using JointHinge = JointHingeOf<double>;

// A change of the kept unknowns.
template <class Number, int N> struct ChangeOf {
    Eigen::Matrix<Number, N, 1> force_n = Eigen::Matrix<Number, N, 1>::Zero();
    std::array<Number, N> turn_rad{};
};
template <int N> using Change = ChangeOf<double, N>;

// What the elimination yields of a limb near its shape: with force and kept turns as they are and all springs at rest.
template <class Number, int N> struct TangentOf {
    Eigen::Matrix<Number, N, 1> tip_mm;                // from its unloaded place
    std::array<Number, N> torque_n_mm;            // of the loads on the joints
    Eigen::Matrix<Number, N, N> compliance_mm_per_n;   // tip by force
    std::array<Eigen::Matrix<Number, N, 1>, N> lever_mm; // tip by a kept turn, and so that joint's torque by force
    Eigen::Matrix<Number, N, N> torque_n_mm_per_rad;   // torques by kept turns
    Number negative_pivots; // how many: directions in which the limb would give way if its tip were let go
};
template <int N> using Tangent = TangentOf<double, N>;

// Where a limb comes to rest when it follows a change.
template <class Number, int N, int MostBodies> struct FollowedOf {
    ShapeOf<Number, N, MostBodies> shape;
    std::array<Number, N> torque_n_mm; // of the loads on the joints
    Number most_rad;                   // by how much the body turned that turned most
};

} // namespace brace::plant
