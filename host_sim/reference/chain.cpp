#include "reference/chain.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace brace::reference {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kAtRest = 1e-10;       // largest last Newton step [mm at the tip, rad or mm at a spring]
constexpr double kRounding = 1e-13;     // of all terms of an energy: smaller differences are rounding
constexpr int kMostSteps = 200;         // of Newton's method, from the undeflected chain
constexpr double kMostTurned_rad = 0.5; // by one of these steps, so that the nearest rest state is found
constexpr int kMostHeldSteps = 12;      // of Newton's method, from the last point of the path
constexpr double kShortestPart = 1e-4;  // of a path to a displacement
constexpr double kFactorRounding = 1e-10; // relative, of the buckling factor
constexpr double kEnclosed = 1.02;        // ratio of the bounds between which inverse iteration seeks the factor
constexpr int kInverseSteps = 4;

Index count(const Chain &chain)
{
    return static_cast<Index>(chain.springs.size());
}

VectorXd stiffnesses(const Chain &chain)
{
    VectorXd k(count(chain));
    for (Index i = 0; i < k.size(); ++i) {
        k[i] = chain.springs[static_cast<std::size_t>(i)].stiffness;
    }
    return k;
}

// H = scale diag(k) - G as L diag(delta) L' with L_ij = c_i . w_j below its diagonal of ones.
class Factor {
public:
    Factor(const VectorXd &k, double scale, const Loaded &loaded) : c_(&loaded.c), w_(3, k.size()), delta_(k.size())
    {
        Matrix3d sum = Matrix3d::Zero(); // of delta_j w_j w_j'
        for (Index j = 0; j < k.size(); ++j) {
            const Vector3d c = c_->col(j);
            const Vector3d carried = sum * c;
            delta_[j] = scale * k[j] - loaded.z.col(j).dot(c) - c.dot(carried);
            w_.col(j) = -(loaded.z.col(j) + carried) / delta_[j];
            sum += delta_[j] * w_.col(j) * w_.col(j).transpose();
        }
    }

    // How many eigenvalues of H are negative (Sylvester).
    int negatives() const { return static_cast<int>((delta_.array() <= 0.0).count()); }

    bool sound() const { return delta_.allFinite() && w_.allFinite(); }

    VectorXd forward(VectorXd b) const // L^-1 b
    {
        Vector3d sum = Vector3d::Zero();
        for (Index i = 0; i < b.size(); ++i) {
            b[i] -= c_->col(i).dot(sum);
            sum += w_.col(i) * b[i];
        }
        return b;
    }

    VectorXd solve(const VectorXd &b) const
    {
        VectorXd x = forward(b).cwiseQuotient(delta_);
        Vector3d sum = Vector3d::Zero();
        for (Index i = x.size() - 1; i >= 0; --i) {
            x[i] -= w_.col(i).dot(sum);
            sum += c_->col(i) * x[i];
        }
        return x;
    }

    // D' J H^-1 J' D
    Small compliance(const Eigen::Matrix3Xd &tip_by_q, const Directions &directions) const
    {
        Eigen::MatrixXd rows(delta_.size(), directions.cols());
        for (Index a = 0; a < directions.cols(); ++a) {
            rows.col(a) = forward(tip_by_q.transpose() * directions.col(a));
        }
        return rows.transpose() * delta_.cwiseInverse().asDiagonal() * rows;
    }

private:
    const Eigen::Matrix3Xd *c_;
    Eigen::Matrix3Xd w_;
    VectorXd delta_;
};

// The smallest positive s for which diag(k) - s G is singular: 1/s is the largest eigenvalue mu of G x = mu diag(k) x.
// mu diag(k) - G has negative eigenvalues exactly for mu below it; that encloses it, and inverse iteration finds it.
double buckling_factor(const VectorXd &k, const Loaded &loaded)
{
    const auto buckles = [&](double mu) { return Factor(k, mu, loaded).negatives() > 0; };
    double below = 1.0 / kNoBuckling;
    if (!buckles(below)) {
        return std::numeric_limits<double>::infinity();
    }
    double above = 1.0;
    while (buckles(above)) {
        below = above;
        above *= 2.0;
    }
    const auto halve_until = [&](double ratio) {
        while (above > below * ratio) {
            const double between = above > 2.0 * below ? std::sqrt(above * below) : 0.5 * (above + below);
            if (!(between > below && between < above)) {
                break;
            }
            (buckles(between) ? below : above) = between;
        }
    };
    halve_until(kEnclosed);
    VectorXd x = VectorXd::LinSpaced(k.size(), 1.0, 2.0);
    double mu = above;
    for (int step = 0; step < kInverseSteps; ++step) {
        const VectorXd weighed = k.cwiseProduct(x);
        const VectorXd next = Factor(k, mu, loaded).solve(weighed);
        mu -= next.dot(weighed) / next.dot(k.cwiseProduct(next)); // Rayleigh's quotient
        x = next / next.lpNorm<Eigen::Infinity>();
        if (!(mu > below && mu < above)) {
            mu = step == 0 ? above : std::numeric_limits<double>::quiet_NaN();
        }
    }
    if (mu > below && mu < above && buckles(mu * (1.0 - kFactorRounding)) && !buckles(mu * (1.0 + kFactorRounding))) {
        return 1.0 / mu;
    }
    halve_until(1.0 + kFactorRounding);
    return 2.0 / (above + below);
}

void finish(const Directions &directions, const VectorXd &k, RestState &rest)
{
    rest.compliance = Factor(k, 1.0, rest.loaded).compliance(rest.loaded.tip_by_q, directions);
    rest.buckling_factor = buckling_factor(k, rest.loaded);
}

int negatives(const Small &matrix)
{
    return static_cast<int>((eigenvalues(matrix, 1.0).array() < 0.0).count());
}

// A descent from the undeflected chain to the next minimum of the energy.
bool descend(const Chain &chain, const VectorXd &k, const Vector3d &force_n, RestState &rest)
{
    rest.q = VectorXd::Zero(k.size());
    rest.force_n = force_n;
    rest.placed = place(chain, rest.q);
    rest.loaded = load(chain, rest.placed, force_n);
    double energy = 0.0;
    double forces_n_mm = force_n.norm() * rest.placed.tip.norm();
    for (std::size_t m = 0; m < chain.weights.size(); ++m) {
        forces_n_mm += chain.weights[m].force_n.norm() * rest.placed.weight[m].norm();
    }
    for (int step = 0; step < kMostSteps; ++step) {
        double scale = 1.0;
        Factor factor(k, scale, rest.loaded);
        const bool convex = factor.sound() && factor.negatives() == 0;
        while (!factor.sound() || factor.negatives() > 0) {
            scale *= 2.0;
            factor = Factor(k, scale, rest.loaded);
        }
        const VectorXd uphill = k.cwiseProduct(rest.q) - rest.loaded.load;
        const VectorXd change = factor.solve(-uphill);
        const double slope = uphill.dot(change);
        const double size = std::max(change.lpNorm<Eigen::Infinity>(), (rest.loaded.tip_by_q * change).norm());
        // Places are known to their last bit only, however little they move.
        const double rounding_n_mm = kRounding * (forces_n_mm + k.dot(rest.q.cwiseAbs2()));
        double turned = 0.0; // by all hinges together
        for (Index i = 0; i < k.size(); ++i) {
            turned += chain.springs[static_cast<std::size_t>(i)].hinge ? std::fabs(change[i]) : 0.0;
        }
        double part = turned > kMostTurned_rad ? kMostTurned_rad / turned : 1.0;
        for (;; part *= 0.5) {
            const VectorXd q = rest.q + part * change;
            Placed placed = place(chain, q);
            const double tried = energy_n_mm(chain, placed, q, force_n);
            if (tried <= energy + 1e-4 * part * slope + rounding_n_mm) {
                rest.q = q;
                rest.placed = std::move(placed);
                energy = tried;
                break;
            }
            if (part < 1e-12) {
                return false;
            }
        }
        rest.loaded = load(chain, rest.placed, force_n);
        if (convex && part == 1.0 && size <= kAtRest) {
            return true;
        }
    }
    return false;
}

// Newton's method for k q = load(q, force), tip(q) = wanted, from a state nearby. False: it does not converge there, or
// to something that is no minimum among the states with the tip there.
bool settle_held(const Chain &chain, const Directions &directions, const VectorXd &k, const Vector3d &wanted_mm,
                 RestState &rest)
{
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostHeldSteps; ++step) {
        const Factor factor(k, 1.0, rest.loaded);
        if (!factor.sound()) {
            return false;
        }
        const Eigen::MatrixXd by_force = rest.loaded.tip_by_q.transpose() * directions; // J' D
        const Small compliance = factor.compliance(rest.loaded.tip_by_q, directions);
        const VectorXd alone = factor.solve(rest.loaded.load - k.cwiseProduct(rest.q));
        const VectorXd missing = directions.transpose() * (wanted_mm - rest.placed.tip - rest.loaded.tip_by_q * alone);
        const VectorXd more_force = compliance.fullPivLu().solve(missing);
        const VectorXd change = alone + factor.solve(by_force * more_force);
        const double size = std::max(change.lpNorm<Eigen::Infinity>(), (rest.loaded.tip_by_q * change).norm());
        if (!(size < std::numeric_limits<double>::max()) || (step > 3 && size > last)) {
            // What is left is rounding, or it runs away.
            return last <= 100.0 * kAtRest && factor.negatives() + negatives(-compliance) == directions.cols();
        }
        rest.q += change;
        rest.force_n += directions * more_force;
        rest.placed = place(chain, rest.q);
        rest.loaded = load(chain, rest.placed, rest.force_n);
        last = size;
        if (size <= kAtRest) {
            // Minimum with the tip held: the bordered matrix has as many negative eigenvalues as held directions.
            return factor.negatives() + negatives(-compliance) == directions.cols();
        }
    }
    return false;
}

} // namespace

Vector3d eigenvalues(const Small &matrix, double padding)
{
    Matrix3d padded = padding * Matrix3d::Identity();
    padded.topLeftCorner(matrix.rows(), matrix.cols()) = matrix;
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(padded, Eigen::EigenvaluesOnly).eigenvalues();
}

Placed place(const Chain &chain, const VectorXd &q)
{
    Placed placed;
    placed.axis.reserve(chain.springs.size());
    placed.point.reserve(chain.springs.size());
    placed.weight.reserve(chain.weights.size());
    // A point of the body behind the springs so far lies at turn * (its undeflected place) + shift.
    Matrix3d turn = Matrix3d::Identity();
    Vector3d shift = Vector3d::Zero();
    auto weight = chain.weights.begin();
    for (std::size_t i = 0; i <= chain.springs.size(); ++i) {
        for (; weight != chain.weights.end() && weight->after == i; ++weight) {
            placed.weight.push_back(turn * weight->point + shift);
        }
        if (i == chain.springs.size()) {
            break;
        }
        const Spring &spring = chain.springs[i];
        const double moved = q[static_cast<Index>(i)];
        placed.axis.push_back(turn * spring.axis);
        placed.point.push_back(turn * spring.point + shift);
        if (spring.hinge) {
            turn = turn * Eigen::AngleAxisd(moved, spring.axis).toRotationMatrix();
            shift = placed.point[i] - turn * spring.point;
        } else {
            shift += moved * placed.axis[i];
        }
    }
    placed.tip = turn * chain.tip + shift;
    return placed;
}

Small unloaded_compliance(const Chain &chain, const Directions &directions)
{
    const Placed placed = place(chain, VectorXd::Zero(count(chain)));
    const Eigen::Matrix3Xd tip_by_q = load(chain, placed, Vector3d::Zero()).tip_by_q;
    const Eigen::Matrix3d c = tip_by_q * stiffnesses(chain).cwiseInverse().asDiagonal() * tip_by_q.transpose();
    return directions.transpose() * c * directions;
}

double energy_n_mm(const Chain &chain, const Placed &placed, const VectorXd &q, const Vector3d &force_n)
{
    double energy = 0.5 * stiffnesses(chain).dot(q.cwiseAbs2()) - force_n.dot(placed.tip - chain.tip);
    for (std::size_t m = 0; m < chain.weights.size(); ++m) {
        energy -= chain.weights[m].force_n.dot(placed.weight[m] - chain.weights[m].point);
    }
    return energy;
}

Loaded load(const Chain &chain, const Placed &placed, const Vector3d &force_n)
{
    const Index n = count(chain);
    Loaded loaded{VectorXd(n), Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n)};
    // Sums over the loads beyond a spring, places taken from the tip so that nothing large cancels.
    Vector3d force = force_n;
    Matrix3d place_force = Matrix3d::Zero(); // sum (x_m - tip) f_m'
    auto weight = chain.weights.size();
    for (Index j = n - 1; j >= 0; --j) {
        const auto at = static_cast<std::size_t>(j);
        for (; weight > 0 && chain.weights[weight - 1].after > at; --weight) {
            const Vector3d &more = chain.weights[weight - 1].force_n;
            force += more;
            place_force += (placed.weight[weight - 1] - placed.tip) * more.transpose();
        }
        const Vector3d &axis = placed.axis[at];
        if (!chain.springs[at].hinge) {
            loaded.load[j] = axis.dot(force);
            loaded.tip_by_q.col(j) = axis;
            loaded.z.col(j).setZero();
            loaded.c.col(j) = axis.cross(force);
            continue;
        }
        const Vector3d arm = placed.tip - placed.point[at];
        const Matrix3d lever_force = place_force + arm * force.transpose(); // sum r f'
        const Vector3d moment(lever_force(1, 2) - lever_force(2, 1), lever_force(2, 0) - lever_force(0, 2),
                              lever_force(0, 1) - lever_force(1, 0)); // sum r x f
        loaded.load[j] = axis.dot(moment);
        loaded.tip_by_q.col(j) = axis.cross(arm);
        loaded.z.col(j) = axis;
        loaded.c.col(j) = lever_force * axis - lever_force.trace() * axis; // sum (z x r) x f
    }
    return loaded;
}

bool rest_under_force(const Chain &chain, const Directions &directions, const Vector3d &force_n, RestState &rest)
{
    const VectorXd k = stiffnesses(chain);
    if (!descend(chain, k, force_n, rest)) {
        return false;
    }
    finish(directions, k, rest);
    return true;
}
bool rest_under_displacement(const Chain &chain, const Directions &directions, const Vector3d &displacement_mm,
                             RestState &rest)
{
    const VectorXd k = stiffnesses(chain);
    if (!descend(chain, k, Vector3d::Zero(), rest)) {
        return false;
    }
    const Vector3d start = rest.placed.tip;
    const Vector3d end = chain.tip + displacement_mm;
    double reached = 0.0, part = 1.0;
    while (reached < 1.0) {
        RestState next = rest;
        const double to = std::min(1.0, reached + part);
        if (settle_held(chain, directions, k, start + to * (end - start), next)) {
            rest = std::move(next);
            reached = to;
            part *= 2.0;
        } else if ((part *= 0.5) < kShortestPart) {
            return false;
        }
    }
    finish(directions, k, rest);
    return true;
}

} // namespace brace::reference
