#include "reference/chain.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace brace::reference {
namespace {

constexpr double kAtRest = 1e-10;       // largest last Newton step [mm at the tip, rad or mm at a spring]
constexpr double kRounding = 1e-13;     // of all terms of an energy: smaller differences are rounding
constexpr int kMostSteps = 200;         // of Newton's method, from the undeflected chain
constexpr double kMostTurned_rad = 0.5; // by one of these steps, so that the nearest rest state is found
constexpr int kMostHeldSteps = 12;      // of Newton's method, from the last point of the path
constexpr double kShortestPart = 1e-4;  // of a path to a displacement
constexpr double kFactorRounding = 1e-10; // relative, of the buckling factor
constexpr double kEnclosed = 1.02;        // ratio of the bounds between which inverse iteration seeks the factor
constexpr int kInverseSteps = 4;

Scalars stiffnesses(const Chain &chain)
{
    Scalars k(chain.springs.size());
    std::transform(chain.springs.begin(), chain.springs.end(), k.begin(),
                   [](const Spring &each) { return each.stiffness; });
    return k;
}

double dot(const Scalars &a, const Scalars &b)
{
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Scalars product(Scalars a, const Scalars &b) // of each pair
{
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::multiplies<>());
    return a;
}

Scalars added(Scalars a, double scale, const Scalars &b) // a + scale b
{
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), [scale](double x, double y) { return x + scale * y; });
    return a;
}

double largest(const Scalars &a) // magnitude; not a number where one of them is none
{
    double found = 0.0;
    for (const double each : a) {
        if (std::fabs(each) > found || std::isnan(each)) {
            found = std::fabs(each);
        }
    }
    return found;
}

Scalars along(const Vectors &vectors, const Vector3d &direction) // vectors' direction
{
    Scalars products(vectors.size());
    std::transform(vectors.begin(), vectors.end(), products.begin(),
                   [&direction](const Vector3d &each) { return each.dot(direction); });
    return products;
}

Vector3d combined(const Vectors &vectors, const Scalars &by) // vectors by
{
    Vector3d total = Vector3d::Zero();
    for (std::size_t i = 0; i < by.size(); ++i) {
        total += vectors[i] * by[i];
    }
    return total;
}

// H = scale diag(k) - G as L diag(delta) L' with L_ij = c_i . w_j below its diagonal of ones.
class Factor {
public:
    Factor(const Scalars &k, double scale, const Loaded &loaded) : c_(&loaded.c), w_(k.size()), delta_(k.size())
    {
        Matrix3d sum = Matrix3d::Zero(); // of delta_j w_j w_j'
        for (std::size_t j = 0; j < k.size(); ++j) {
            const Vector3d &c = (*c_)[j];
            const Vector3d carried = sum * c;
            delta_[j] = scale * k[j] - loaded.z[j].dot(c) - c.dot(carried);
            w_[j] = -(loaded.z[j] + carried) / delta_[j];
            sum += delta_[j] * w_[j] * w_[j].transpose();
        }
    }

    // How many eigenvalues of H are negative (Sylvester).
    int negatives() const
    {
        return static_cast<int>(std::count_if(delta_.begin(), delta_.end(), [](double each) { return each <= 0.0; }));
    }

    bool sound() const
    {
        return std::all_of(delta_.begin(), delta_.end(), [](double each) { return std::isfinite(each); })
               && std::all_of(w_.begin(), w_.end(), [](const Vector3d &each) { return each.allFinite(); });
    }

    Scalars forward(Scalars b) const // L^-1 b
    {
        Vector3d sum = Vector3d::Zero();
        for (std::size_t i = 0; i < b.size(); ++i) {
            b[i] -= (*c_)[i].dot(sum);
            sum += w_[i] * b[i];
        }
        return b;
    }

    Scalars solve(const Scalars &b) const
    {
        Scalars x = forward(b);
        Vector3d sum = Vector3d::Zero();
        for (std::size_t i = x.size(); i-- > 0;) {
            x[i] = x[i] / delta_[i] - w_[i].dot(sum);
            sum += (*c_)[i] * x[i];
        }
        return x;
    }

    // D' J H^-1 J' D
    Matrix3d compliance(const Vectors &tip_by_q, const Directions &directions) const
    {
        Scalars rows[3];
        for (int a = 0; a < directions.count; ++a) {
            rows[a] = forward(along(tip_by_q, directions.axes.col(a)));
        }
        Matrix3d c = Matrix3d::Zero();
        for (std::size_t i = 0; i < delta_.size(); ++i) {
            for (int a = 0; a < directions.count; ++a) {
                for (int b = 0; b < directions.count; ++b) {
                    c(a, b) += rows[a][i] * rows[b][i] / delta_[i];
                }
            }
        }
        return c;
    }

private:
    const Vectors *c_;
    Vectors w_;
    Scalars delta_;
};

// The smallest positive s for which diag(k) - s G is singular: 1/s is the largest eigenvalue mu of G x = mu diag(k) x.
// mu diag(k) - G has negative eigenvalues exactly for mu below it; that encloses it, and inverse iteration finds it.
double buckling_factor(const Scalars &k, const Loaded &loaded)
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
    Scalars x(k.size());
    for (std::size_t i = 0; i < x.size(); ++i) { // no mode is likely to be across this
        x[i] = 1.0 + static_cast<double>(i) / static_cast<double>(x.size());
    }
    double mu = above;
    for (int step = 0; step < kInverseSteps; ++step) {
        const Scalars weighed = product(k, x);
        const Scalars next = Factor(k, mu, loaded).solve(weighed);
        mu -= dot(next, weighed) / dot(next, product(k, next)); // Rayleigh's quotient
        const double scale = largest(next);
        std::transform(next.begin(), next.end(), x.begin(), [scale](double each) { return each / scale; });
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

void finish(const Directions &directions, const Scalars &k, RestState &rest)
{
    rest.compliance = Factor(k, 1.0, rest.loaded).compliance(rest.loaded.tip_by_q, directions);
    rest.buckling_factor = buckling_factor(k, rest.loaded);
}

int positives(const Matrix3d &matrix, const Directions &directions)
{
    return static_cast<int>((spectrum(matrix, directions.count).values.head(directions.count).array() > 0.0).count());
}

// A descent from the undeflected chain to the next minimum of the energy.
bool descend(const Chain &chain, const Scalars &k, const Vector3d &force_n, RestState &rest)
{
    rest.q.assign(k.size(), 0.0);
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
        const Scalars downhill = added(rest.loaded.load, -1.0, product(k, rest.q));
        const Scalars change = factor.solve(downhill);
        const double slope = -dot(downhill, change);
        const double size = std::max(largest(change), combined(rest.loaded.tip_by_q, change).norm());
        // Places are known to their last bit only, however little they move.
        const double rounding_n_mm = kRounding * (forces_n_mm + dot(k, product(rest.q, rest.q)));
        double turned = 0.0; // by all hinges together
        for (std::size_t i = 0; i < k.size(); ++i) {
            turned += chain.springs[i].hinge ? std::fabs(change[i]) : 0.0;
        }
        double part = turned > kMostTurned_rad ? kMostTurned_rad / turned : 1.0;
        for (;; part *= 0.5) {
            Scalars q = added(rest.q, part, change);
            Placed placed = place(chain, q);
            const double tried = energy_n_mm(chain, placed, q, force_n);
            if (tried <= energy + 1e-4 * part * slope + rounding_n_mm) {
                rest.q = std::move(q);
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
bool settle_held(const Chain &chain, const Directions &directions, const Scalars &k, const Vector3d &wanted_mm,
                 RestState &rest)
{
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostHeldSteps; ++step) {
        const Factor factor(k, 1.0, rest.loaded);
        if (!factor.sound()) {
            return false;
        }
        const Matrix3d compliance = factor.compliance(rest.loaded.tip_by_q, directions);
        const Scalars alone = factor.solve(added(rest.loaded.load, -1.0, product(k, rest.q)));
        const Vector3d missing_mm = wanted_mm - rest.placed.tip - combined(rest.loaded.tip_by_q, alone);
        const Vector3d more_force_n =
            directions.axes * (inverse(compliance, directions.count) * (directions.axes.transpose() * missing_mm));
        const Scalars change = added(alone, 1.0, factor.solve(along(rest.loaded.tip_by_q, more_force_n)));
        const double size = std::max(largest(change), combined(rest.loaded.tip_by_q, change).norm());
        if (!(size < std::numeric_limits<double>::max()) || (step > 3 && size > last)) {
            // What is left is rounding, or it runs away.
            return last <= 100.0 * kAtRest
                   && factor.negatives() + positives(compliance, directions) == directions.count;
        }
        rest.q = added(rest.q, 1.0, change);
        rest.force_n += more_force_n;
        rest.placed = place(chain, rest.q);
        rest.loaded = load(chain, rest.placed, rest.force_n);
        last = size;
        if (size <= kAtRest) {
            // Minimum with the tip held: the bordered matrix has as many negative eigenvalues as held directions.
            return factor.negatives() + positives(compliance, directions) == directions.count;
        }
    }
    return false;
}

} // namespace

Spectrum spectrum(const Matrix3d &matrix, int count)
{
    // What is added is larger than any eigenvalue, so that it comes last.
    Matrix3d padded = 2.0 * matrix.norm() * Matrix3d::Identity();
    padded.topLeftCorner(count, count) = matrix.topLeftCorner(count, count);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(padded);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Matrix3d inverse(const Matrix3d &matrix, int count)
{
    const Spectrum found = spectrum(matrix, count);
    Matrix3d inverse = Matrix3d::Zero();
    for (int i = 0; i < count; ++i) {
        inverse += found.vectors.col(i) * found.vectors.col(i).transpose() / found.values[i];
    }
    return inverse;
}

Placed place(const Chain &chain, const Scalars &q)
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
        const double moved = q[i];
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

Matrix3d unloaded_compliance(const Chain &chain, const Directions &directions)
{
    const Placed placed = place(chain, Scalars(chain.springs.size(), 0.0));
    const Vectors tip_by_q = load(chain, placed, Vector3d::Zero()).tip_by_q;
    Matrix3d c = Matrix3d::Zero();
    for (std::size_t i = 0; i < tip_by_q.size(); ++i) {
        c += tip_by_q[i] * tip_by_q[i].transpose() / chain.springs[i].stiffness;
    }
    return directions.axes.transpose() * c * directions.axes;
}

double energy_n_mm(const Chain &chain, const Placed &placed, const Scalars &q, const Vector3d &force_n)
{
    double energy = 0.5 * dot(stiffnesses(chain), product(q, q)) - force_n.dot(placed.tip - chain.tip);
    for (std::size_t m = 0; m < chain.weights.size(); ++m) {
        energy -= chain.weights[m].force_n.dot(placed.weight[m] - chain.weights[m].point);
    }
    return energy;
}

Loaded load(const Chain &chain, const Placed &placed, const Vector3d &force_n)
{
    const std::size_t n = chain.springs.size();
    Loaded loaded{Scalars(n), Vectors(n), Vectors(n), Vectors(n)};
    // Sums over the loads beyond a spring, places taken from the tip so that nothing large cancels.
    Vector3d force = force_n;
    Matrix3d place_force = Matrix3d::Zero(); // sum (x_m - tip) f_m'
    auto weight = chain.weights.size();
    for (std::size_t j = n; j-- > 0;) {
        for (; weight > 0 && chain.weights[weight - 1].after > j; --weight) {
            const Vector3d &more = chain.weights[weight - 1].force_n;
            force += more;
            place_force += (placed.weight[weight - 1] - placed.tip) * more.transpose();
        }
        const Vector3d &axis = placed.axis[j];
        if (!chain.springs[j].hinge) {
            loaded.load[j] = axis.dot(force);
            loaded.tip_by_q[j] = axis;
            loaded.z[j].setZero();
            loaded.c[j] = axis.cross(force);
            continue;
        }
        const Vector3d arm = placed.tip - placed.point[j];
        const Matrix3d lever_force = place_force + arm * force.transpose(); // sum r f'
        const Vector3d moment(lever_force(1, 2) - lever_force(2, 1), lever_force(2, 0) - lever_force(0, 2),
                              lever_force(0, 1) - lever_force(1, 0)); // sum r x f
        loaded.load[j] = axis.dot(moment);
        loaded.tip_by_q[j] = axis.cross(arm);
        loaded.z[j] = axis;
        loaded.c[j] = lever_force * axis - lever_force.trace() * axis; // sum (z x r) x f
    }
    return loaded;
}

bool rest_under_force(const Chain &chain, const Directions &directions, const Vector3d &force_n, RestState &rest)
{
    const Scalars k = stiffnesses(chain);
    if (!descend(chain, k, force_n, rest)) {
        return false;
    }
    finish(directions, k, rest);
    return true;
}

bool rest_under_displacement(const Chain &chain, const Directions &directions, const Vector3d &displacement_mm,
                             RestState &rest)
{
    const Scalars k = stiffnesses(chain);
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
