// The ground under the feet of one body, in one step of time: which feet stick, slide or leave the ground, by Coulomb's
// law with grip: a foot bears f_n >= -grip and |f_t| <= friction (f_n + grip), and slides against f_t.
//
// Everything is in each foot's own ground frame: normal first, then two directions along the ground. A foot that moves
// is dragged besides, by as much as it moves: the drag is nothing at rest, so that a rest obeys the law alone. It makes
// a step bounded where a limb is stiffer than its springs, as by joints that stick.
#pragma once

#include <Eigen/Core>
#include <array>

namespace brace::node {

constexpr int kMostFeet = 8;

enum class Contact { sticks, slides, open, gone };

struct Foot {
    double friction_ratio;
    double grip_n; // 0: the foot only presses
    double gap_mm; // above the ground
    bool is_gone; // it bears nothing, wherever it is
    Eigen::Vector3d force_n; // in: of the ground on the foot if no foot moves; out: with all ways
    Eigen::Matrix3d drag_n_per_mm;
    Eigen::Vector3d way_mm; // out
    Contact contact; // out
};

// How the forces of all feet follow the way of each, 3 x 3 for a pair of them.
using ByWays = Eigen::Matrix<double, 3 * kMostFeet, 3 * kMostFeet>;

// Foot by foot, over and over, until no force changes by what matters (nonsmooth Gauss-Seidel; Jourdan, Alart and Jean
// 1998). At most kSweeps rounds: what is then left, the next step of time goes on with. false: something is left.
bool find_ways(std::array<Foot, kMostFeet> &foot, int count, const ByWays &by_ways_n_per_mm);

} // namespace brace::node
