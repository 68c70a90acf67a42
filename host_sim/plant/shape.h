// What one linearisation of the limb and the next share, in the plane (N = 2 axes and joints) and in space (3).
#pragma once

#include <Eigen/Core>
#include <array>

namespace brace::plant {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;
template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

template <int N, int MostBodies>
struct ShapeOf {
    std::array<double, MostBodies> turn_rad{}; // of each hinge
    Vector<N> force_n = Vector<N>::Zero();     // on the tip
};

// A joint's hinge in the elimination: its spring, and a further turn that is kept.
struct JointHinge {
    double compliance_rad_per_n_mm; // 0: only the kept turn is left
    double unstrained_rad;          // turn of the hinge at which the spring carries nothing
};

// A change of the kept unknowns.
template <int N>
struct Change {
    Vector<N> force_n = Vector<N>::Zero();
    std::array<double, N> turn_rad{};
};

} // namespace brace::plant
