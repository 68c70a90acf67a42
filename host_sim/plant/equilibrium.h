// Where the limb comes to rest under an imposed tip displacement: the joint deflections of least energy.
//
// Energy of deflections e: 1/2 x'Kx + 1/2 e'Me + sum spring_i(e_i) - load_i e_i + rubbed_i(before_i, e_i) with
// x = d - sum lever_i e_i. The first term is the structure's. M is what the loads add as they turn with the joints:
// nothing while displacements are small. rubbed is the friction, coulomb + ratio * |spring torque|, summed over the way
// from before to e. Without M the energy is convex while the ratio is below 1 (the springs' slopes remain positive when
// friction's share is subtracted), so its minimum is the one rest state. M bends it little as long as the loads are far
// from those that make the held limb give way.
#pragma once

#include <Eigen/Core>
#include <array>

#include "plant/joint_law.h"
#include "plant/shape.h"

namespace brace::plant {

// N: axes along which the tip moves, and at most as many joints: 2 in the plane, 3 in space.
template <int N> struct JointUnknown {
    Vector<N> lever_mm; // tip displacement per deflection
    JointLaw law; // compliance > 0
    double load_n_mm; // torque on the joint besides that of the tip force
    double before_rad; // deflection at which friction holds it
};

template <int N> struct RestProblem {
    Matrix<N> stiffness_n_per_mm; // stiffness of the structure
    Matrix<N> by_loads_n_mm_per_rad = Matrix<N>::Zero(); // M
    Vector<N> displacement_mm;
    int joint_count;
    std::array<JointUnknown<N>, N> joint;
};

template <int N> struct RestState {
    std::array<double, N> deflection_rad; // in: where to start; out: at rest
    Vector<N> force_n;
    double unbalance_n; // largest unbalanced torque over the longest lever
    bool solved; // unbalance within 1e-9 N, or within rounding where that is more
};

template <int N> void find_rest(const RestProblem<N> &problem, RestState<N> &state);

} // namespace brace::plant
