#include "plant/equilibrium.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace brace::plant {
namespace {

using Pair = std::array<double, 2>;
using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kMaxSteps = 200;
constexpr int kMaxSearch = 80;
constexpr double kGoodBalance_n = 1e-10;
constexpr double kPromisedBalance_n = 1e-9;
constexpr double kRounding = 1e-15; // relative, of a sum of a few products
constexpr double kLeastCurvature = 1e-12;
constexpr double kDamping =
    1e-9; // of each spring: keeps a joint within its play, where nothing pushes back, solvable

// Slope of the energy without friction, and its curvature but for M.
struct Slope {
    Pair torque_n_mm{};
    Matrix2d curvature = Matrix2d::Zero();
    Vector2d force_n;
};

Slope slope_at(const RestProblem &problem, const Pair &deflection)
{
    Vector2d displacement = problem.displacement_mm;
    for (int i = 0; i < problem.joint_count; ++i) {
        displacement -= problem.joint[i].lever_mm * deflection[i];
    }
    Slope slope;
    slope.force_n = problem.stiffness_n_per_mm * displacement;
    for (int i = 0; i < problem.joint_count; ++i) {
        const JointUnknown &joint = problem.joint[i];
        slope.torque_n_mm[i] = spring_torque_n_mm(joint.law, deflection[i]) - joint.load_n_mm
                               - joint.lever_mm.dot(slope.force_n);
        const Vector2d pushed = problem.stiffness_n_per_mm * joint.lever_mm;
        for (int j = 0; j < problem.joint_count; ++j) {
            slope.torque_n_mm[i] += problem.by_loads_n_mm_per_rad(i, j) * deflection[j];
            slope.curvature(i, j) = problem.joint[j].lever_mm.dot(pushed);
        }
        slope.curvature(i, i) += spring_stiffness_n_mm_per_rad(joint.law, deflection[i])
                                 + kDamping / joint.law.compliance_rad_per_n_mm;
    }
    return slope;
}

// The sign of each joint's motion, and so the sign of friction's slope; 0 where friction holds the joint.
Pair moving_sign(const RestProblem &problem, const Pair &deflection, const Pair &torque)
{
    Pair sign{};
    for (int i = 0; i < problem.joint_count; ++i) {
        const JointUnknown &joint = problem.joint[i];
        const double moved = deflection[i] - joint.before_rad;
        if (moved != 0.0) {
            sign[i] = std::copysign(1.0, moved);
        } else if (std::fabs(torque[i]) > friction_n_mm(joint.law, deflection[i])) {
            sign[i] = -std::copysign(1.0, torque[i]);
        }
    }
    return sign;
}

// Newton's direction among the joints that move. Two joints that move the tip almost alike leave a valley with almost
// no curvature along it; the curvature there is raised to the least that rounding allows to divide by. Where M takes
// all curvature away, as when a weight stands above a joint within its play, the direction is the one without M: it
// leads down, too.
Pair newton_direction(const Matrix2d &without_m, const Matrix2d &m, const Pair &torque, const Pair &sign)
{
    const bool both = sign[0] != 0.0 && sign[1] != 0.0;
    Matrix2d curvature = without_m + m;
    if (!(sign[0] == 0.0 || curvature(0, 0) > 0.0) || !(sign[1] == 0.0 || curvature(1, 1) > 0.0)
        || (both && !(curvature.determinant() > 0.0))) {
        curvature = without_m;
    }
    if (both) {
        const double product = curvature(0, 0) * curvature(1, 1);
        const double determinant =
            std::max(product - curvature(0, 1) * curvature(1, 0), kLeastCurvature * product);
        return {(curvature(0, 1) * torque[1] - curvature(1, 1) * torque[0]) / determinant,
                (curvature(1, 0) * torque[0] - curvature(0, 0) * torque[1]) / determinant};
    }
    Pair direction{};
    for (const int i : {0, 1}) {
        direction[i] = sign[i] != 0.0 ? -torque[i] / curvature(i, i) : 0.0;
    }
    return direction;
}

// The same, where every joint that friction still holds either leaves its place in the direction of its load, or does
// not move.
Pair direction_of(const RestProblem &problem, const Pair &deflection, const Slope &slope, const Pair &torque,
                  const Pair &sign)
{
    const Matrix2d &m = problem.by_loads_n_mm_per_rad;
    const Pair direction = newton_direction(slope.curvature, m, torque, sign);
    for (int i = 0; i < problem.joint_count; ++i) {
        const bool held =
            problem.joint[i].law.rubs() && deflection[i] == problem.joint[i].before_rad;
        if (held && direction[i] * sign[i] < 0.0) {
            Pair others = sign;
            others[i] = 0.0;
            return newton_direction(slope.curvature, m, torque, others);
        }
    }
    return direction;
}

// The energy along a direction from a point, up to the first place where a joint's friction would change its sign.
class Line {
public:
    Line(const RestProblem &problem, const Pair &from, const Pair &direction, const Pair &sign)
        : problem_(problem), from_(from), direction_(direction), sign_(sign)
    {
        for (int i = 0; i < problem.joint_count; ++i) {
            const double moved = from[i] - problem.joint[i].before_rad;
            if (problem.joint[i].law.rubs() && moved * direction[i] < 0.0
                && -moved / direction[i] < end_) {
                end_ = -moved / direction[i];
                turning_ = i;
            }
        }
    }

    double end() const { return end_; }

    Pair at(double length) const
    {
        Pair point = from_;
        for (int i = 0; i < problem_.joint_count; ++i) {
            point[i] += length * direction_[i];
        }
        if (length == end_) {
            point[turning_] = problem_.joint[turning_].before_rad;
        }
        return point;
    }

    // `here` is the slope of the energy without friction at this place.
    double slope(double length, Slope &here) const
    {
        const Pair point = at(length);
        here = slope_at(problem_, point);
        double sum = 0.0;
        for (int i = 0; i < problem_.joint_count; ++i) {
            sum += direction_[i]
                   * (here.torque_n_mm[i] + sign_[i] * friction_n_mm(problem_.joint[i].law, point[i]));
        }
        return sum;
    }

private:
    const RestProblem &problem_;
    const Pair from_;
    const Pair direction_;
    const Pair sign_;
    double end_ = std::numeric_limits<double>::infinity();
    int turning_ = 0;
};

// How far to go along the line: all of Newton's step if that is good, else to the least energy on the line. `start` is
// the slope at its beginning; `here` is the slope at the place that is returned.
double length_of(const Line &line, double start, Slope &here)
{
    double high = std::min(1.0, line.end());
    double high_slope = line.slope(high, here);
    if (std::fabs(high_slope) <= 0.5 * std::fabs(start) || (high_slope < 0.0 && high == line.end())) {
        return high;
    }
    double low = 0.0;
    double low_slope = start;
    while (high_slope < 0.0 && high < 1e12) { // still falling: look further on
        low = high;
        low_slope = high_slope;
        if (high == line.end()) {
            return high;
        }
        high = std::min(2.0 * high, line.end());
        high_slope = line.slope(high, here);
    }
    for (int i = 0; i < kMaxSearch; ++i) {
        // Secant steps while they shorten the bracket; every other step halves it.
        const double secant = low - low_slope * (high - low) / (high_slope - low_slope);
        const double middle = i % 2 == 0 ? secant : 0.5 * (low + high);
        const double slope = line.slope(middle, here);
        if (std::fabs(slope) <= 1e-3 * std::fabs(start)) {
            return middle;
        }
        (slope < 0.0 ? low : high) = middle;
        (slope < 0.0 ? low_slope : high_slope) = slope;
    }
    const double length = low > 0.0 ? low : high;
    line.slope(length, here);
    return length;
}

// How far from rest a point is, and how far rounding puts a point that is at rest.
struct Balance {
    Pair torque_n_mm{};       // unbalance, with friction
    double unbalance_n = 0.0; // the largest unbalance over the longest lever
    double rounding_n = 0.0;
    double rounding_at_stops_n = 0.0; // the same if each joint were at the edge of its backlash
};

Balance balance_at(const RestProblem &problem, const Pair &deflection, const Slope &slope, const Pair &sign)
{
    Balance balance;
    double longest_mm = 1.0;
    double reach_mm = problem.displacement_mm.norm();
    double worst = 0.0;
    double here = 0.0;
    double at_stops = 0.0;
    for (int i = 0; i < problem.joint_count; ++i) {
        const JointUnknown &joint = problem.joint[i];
        const double lever_mm = joint.lever_mm.norm();
        const double size = std::fabs(deflection[i]);
        if (sign[i] != 0.0) {
            balance.torque_n_mm[i] = slope.torque_n_mm[i] + sign[i] * friction_n_mm(joint.law, deflection[i]);
        }
        worst = std::max(worst, std::fabs(balance.torque_n_mm[i]));
        longest_mm = std::max(longest_mm, lever_mm);
        reach_mm += size * lever_mm;
        here += size * slope.curvature(i, i);
        at_stops += size * std::max(slope.curvature(i, i), 1.0 / joint.law.compliance_rad_per_n_mm);
    }
    const double structure_n = problem.stiffness_n_per_mm.norm() * reach_mm;
    balance.unbalance_n = worst / longest_mm;
    balance.rounding_n = kRounding * (structure_n + here / longest_mm);
    balance.rounding_at_stops_n = kRounding * (structure_n + at_stops / longest_mm);
    return balance;
}

} // namespace

void find_rest(const RestProblem &problem, RestState &state)
{
    Pair deflection = state.deflection_rad;
    Slope slope = slope_at(problem, deflection);
    for (int step = 0;; ++step) {
        const Pair sign = moving_sign(problem, deflection, slope.torque_n_mm);
        const Balance balance = balance_at(problem, deflection, slope, sign);
        if (balance.unbalance_n <= std::max(kGoodBalance_n, balance.rounding_n) || step == kMaxSteps) {
            state.deflection_rad = deflection;
            state.force_n = slope.force_n;
            state.unbalance_n = balance.unbalance_n;
            state.solved =
                balance.unbalance_n <= std::max(kPromisedBalance_n, 8.0 * balance.rounding_at_stops_n);
            return;
        }
        for (int i = 0; i < problem.joint_count; ++i) {
            slope.curvature(i, i) += sign[i] * friction_slope_n_mm_per_rad(problem.joint[i].law, deflection[i]);
        }
        const Pair direction = direction_of(problem, deflection, slope, balance.torque_n_mm, sign);
        double falls = 0.0;
        for (int i = 0; i < problem.joint_count; ++i) {
            falls += direction[i] * balance.torque_n_mm[i];
        }
        const Line line(problem, deflection, direction, sign);
        deflection = line.at(length_of(line, falls, slope));
    }
}

} // namespace brace::plant
