#include "plant/equilibrium.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace brace::plant {
namespace {

// A number of each joint.
template <int N> using Each = std::array<double, N>;

constexpr int kMaxSteps = 200;
constexpr int kMaxSearch = 80;
constexpr double kGoodBalance_n = 1e-10;
constexpr double kPromisedBalance_n = 1e-9;
constexpr double kRounding = 1e-15; // relative, of a sum of a few products
constexpr double kLeastCurvature = 1e-12;
constexpr double kDamping = 1e-9; // of each spring: keeps a joint within its play, where nothing pushes back, solvable

// Slope of the energy without friction, and its curvature but for M.
template <int N> struct Slope {
    Each<N> torque_n_mm{};
    Matrix<N> curvature = Matrix<N>::Zero();
    Vector<N> force_n;
};

template <int N> Slope<N> slope_at(const RestProblem<N> &problem, const Each<N> &deflection)
{
    Vector<N> displacement = problem.displacement_mm;
    for (int i = 0; i < problem.joint_count; ++i) {
        displacement -= problem.joint[i].lever_mm * deflection[i];
    }
    Slope<N> slope;
    slope.force_n = problem.stiffness_n_per_mm * displacement;
    for (int i = 0; i < problem.joint_count; ++i) {
        const JointUnknown<N> &joint = problem.joint[i];
        slope.torque_n_mm[i] =
            spring_torque_n_mm(joint.law, deflection[i]) - joint.load_n_mm - joint.lever_mm.dot(slope.force_n);
        const Vector<N> pushed = problem.stiffness_n_per_mm * joint.lever_mm;
        for (int j = 0; j < problem.joint_count; ++j) {
            slope.torque_n_mm[i] += problem.by_loads_n_mm_per_rad(i, j) * deflection[j];
            slope.curvature(i, j) = problem.joint[j].lever_mm.dot(pushed);
        }
        slope.curvature(i, i) +=
            spring_stiffness_n_mm_per_rad(joint.law, deflection[i]) + kDamping / joint.law.compliance_rad_per_n_mm;
    }
    return slope;
}

// The sign of each joint's motion, and so the sign of friction's slope; 0 where friction holds the joint.
template <int N> Each<N> moving_sign(const RestProblem<N> &problem, const Each<N> &deflection, const Each<N> &torque)
{
    Each<N> sign{};
    for (int i = 0; i < problem.joint_count; ++i) {
        const JointUnknown<N> &joint = problem.joint[i];
        const double moved = deflection[i] - joint.before_rad;
        if (moved != 0.0) {
            sign[i] = std::copysign(1.0, moved);
        } else if (std::fabs(torque[i]) > friction_n_mm(joint.law, deflection[i])) {
            sign[i] = -std::copysign(1.0, torque[i]);
        }
    }
    return sign;
}

// Joints that move the tip almost alike leave a valley with almost no curvature along it; the curvature there is raised
// to the least that rounding allows to divide by.
template <int N> struct Pivots {
    Matrix<N> lower; // ones on its diagonal
    Vector<N> pivot; // of the joints that move
    bool positive = true;

    Pivots(const Matrix<N> &curvature, const Each<N> &sign) : lower(Matrix<N>::Identity()), pivot(Vector<N>::Ones())
    {
        for (int j = 0; j < N; ++j) {
            if (sign[j] == 0.0) {
                continue;
            }
            double left = curvature(j, j);
            for (int k = 0; k < j; ++k) {
                left -= sign[k] != 0.0 ? lower(j, k) * lower(j, k) * pivot[k] : 0.0;
            }
            positive = positive && left > 0.0;
            pivot[j] = std::max(left, kLeastCurvature * curvature(j, j));
            for (int i = j + 1; i < N; ++i) {
                double product = curvature(i, j);
                for (int k = 0; k < j; ++k) {
                    product -= sign[k] != 0.0 ? lower(i, k) * lower(j, k) * pivot[k] : 0.0;
                }
                lower(i, j) = sign[i] != 0.0 ? product / pivot[j] : 0.0;
            }
        }
    }
};

// Newton's direction among the joints that move. Where M takes all curvature away, as when a weight stands above a
// joint within its play, the direction is the one without M: it leads down, too.
template <int N>
Each<N> newton_direction(const Matrix<N> &without_m, const Matrix<N> &m, const Each<N> &torque, const Each<N> &sign)
{
    Pivots<N> curvature(without_m + m, sign);
    if (!curvature.positive) {
        curvature = Pivots<N>(without_m, sign);
    }
    Each<N> direction{};
    for (int i = 0; i < N; ++i) {
        direction[i] = sign[i] != 0.0 ? -torque[i] : 0.0;
        for (int k = 0; k < i; ++k) {
            direction[i] -= sign[i] != 0.0 ? curvature.lower(i, k) * direction[k] : 0.0;
        }
    }
    for (int i = N; i-- > 0;) {
        direction[i] /= curvature.pivot[i];
        for (int k = i + 1; k < N; ++k) {
            direction[i] -= curvature.lower(k, i) * direction[k];
        }
    }
    return direction;
}

// The same, where every joint that friction still holds either leaves its place in the direction of its load, or does
// not move.
template <int N>
Each<N> direction_of(const RestProblem<N> &problem, const Each<N> &deflection, const Slope<N> &slope,
                     const Each<N> &torque, const Each<N> &sign)
{
    Each<N> moving = sign;
    for (;;) { // each round holds one joint more
        const Each<N> direction = newton_direction<N>(slope.curvature, problem.by_loads_n_mm_per_rad, torque, moving);
        int held = -1;
        for (int i = 0; i < problem.joint_count && held < 0; ++i) {
            const bool rests = rubs(problem.joint[i].law) && deflection[i] == problem.joint[i].before_rad;
            held = rests && direction[i] * moving[i] < 0.0 ? i : -1;
        }
        if (held < 0) {
            return direction;
        }
        moving[held] = 0.0;
    }
}

// The energy along a direction from a point, up to the first place where a joint's friction would change its sign.
template <int N> class Line {
public:
    Line(const RestProblem<N> &problem, const Each<N> &from, const Each<N> &direction, const Each<N> &sign)
        : problem_(problem), from_(from), direction_(direction), sign_(sign)
    {
        for (int i = 0; i < problem.joint_count; ++i) {
            const double moved = from[i] - problem.joint[i].before_rad;
            if (rubs(problem.joint[i].law) && moved * direction[i] < 0.0 && -moved / direction[i] < end_) {
                end_ = -moved / direction[i];
                turning_ = i;
            }
        }
    }

    double end() const { return end_; }

    Each<N> at(double length) const
    {
        Each<N> point = from_;
        for (int i = 0; i < problem_.joint_count; ++i) {
            point[i] += length * direction_[i];
        }
        if (length == end_) {
            point[turning_] = problem_.joint[turning_].before_rad;
        }
        return point;
    }

    // `here` is the slope of the energy without friction at this place.
    double slope(double length, Slope<N> &here) const
    {
        const Each<N> point = at(length);
        here = slope_at<N>(problem_, point);
        double sum = 0.0;
        for (int i = 0; i < problem_.joint_count; ++i) {
            sum += direction_[i] * (here.torque_n_mm[i] + sign_[i] * friction_n_mm(problem_.joint[i].law, point[i]));
        }
        return sum;
    }

private:
    const RestProblem<N> &problem_;
    const Each<N> from_;
    const Each<N> direction_;
    const Each<N> sign_;
    double end_ = std::numeric_limits<double>::infinity();
    int turning_ = 0;
};

// How far to go along the line: all of Newton's step if that is good, else to the least energy on the line. `start` is
// the slope at its beginning; `here` is the slope at the place that is returned.
template <int N> double length_of(const Line<N> &line, double start, Slope<N> &here)
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
template <int N> struct Balance {
    Each<N> torque_n_mm{}; // unbalance, with friction
    double unbalance_n = 0.0; // the largest unbalance over the longest lever
    double rounding_n = 0.0;
    double rounding_at_stops_n = 0.0; // the same if each joint were at the edge of its backlash
};

template <int N>
Balance<N> balance_at(const RestProblem<N> &problem, const Each<N> &deflection, const Slope<N> &slope,
                      const Each<N> &sign)
{
    Balance<N> balance;
    double longest_mm = 1.0;
    double reach_mm = problem.displacement_mm.norm();
    double worst = 0.0;
    double here = 0.0;
    double at_stops = 0.0;
    for (int i = 0; i < problem.joint_count; ++i) {
        const JointUnknown<N> &joint = problem.joint[i];
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

template <int N> void find_rest(const RestProblem<N> &problem, RestState<N> &state)
{
    Each<N> deflection = state.deflection_rad;
    Slope<N> slope = slope_at<N>(problem, deflection);
    for (int step = 0;; ++step) {
        const Each<N> sign = moving_sign<N>(problem, deflection, slope.torque_n_mm);
        const Balance<N> balance = balance_at<N>(problem, deflection, slope, sign);
        if (balance.unbalance_n <= std::max(kGoodBalance_n, balance.rounding_n) || step == kMaxSteps) {
            state.deflection_rad = deflection;
            state.force_n = slope.force_n;
            state.unbalance_n = balance.unbalance_n;
            state.solved = balance.unbalance_n <= std::max(kPromisedBalance_n, 8.0 * balance.rounding_at_stops_n);
            return;
        }
        for (int i = 0; i < problem.joint_count; ++i) {
            slope.curvature(i, i) += sign[i] * friction_slope_n_mm_per_rad(problem.joint[i].law, deflection[i]);
        }
        const Each<N> direction = direction_of<N>(problem, deflection, slope, balance.torque_n_mm, sign);
        double falls = 0.0;
        for (int i = 0; i < problem.joint_count; ++i) {
            falls += direction[i] * balance.torque_n_mm[i];
        }
        const Line<N> line(problem, deflection, direction, sign);
        deflection = line.at(length_of<N>(line, falls, slope));
    }
}

template void find_rest<2>(const RestProblem<2> &, RestState<2> &);
template void find_rest<3>(const RestProblem<3> &, RestState<3> &);

} // namespace brace::plant
