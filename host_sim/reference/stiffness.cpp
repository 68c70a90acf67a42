#include "reference/stiffness.h"

#include <Eigen/LU>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace brace::reference {
namespace {

constexpr Real kHalfTurn = 3.14159265358979323846264338327950288L;
constexpr Real kRigid = 1e-15L; // smallest eigenvalue of C over the largest that counts as yielding

template <int N> using Matrix = Eigen::Matrix<Real, N, N>;

template <int N> struct Spectrum {
    Matrix<N> k;
    Eigen::Matrix<Real, N, 1> lambda; // of K, ascending
    Eigen::Matrix<Real, N, 1> stiff_axis;
};

// Jacobi's rotations, because this method keeps the small eigenvalues of a positive definite matrix.
template <int N> void diagonalise(Matrix<N> &a, Matrix<N> &vectors)
{
    vectors.setIdentity();
    for (int sweep = 0; sweep < 30; ++sweep) {
        bool turned = false;
        for (int p = 0; p < N; ++p) {
            for (int q = p + 1; q < N; ++q) {
                if (std::fabs(a(p, q)) <= 1e-19L * std::sqrt(std::fabs(a(p, p) * a(q, q)))) {
                    continue;
                }
                turned = true;
                const Real angle = 0.5L * std::atan2(2.0L * a(p, q), a(q, q) - a(p, p));
                Matrix<N> turn = Matrix<N>::Identity();
                turn(p, p) = turn(q, q) = std::cos(angle);
                turn(p, q) = std::sin(angle);
                turn(q, p) = -turn(p, q);
                a = (turn.transpose() * a * turn).eval();
                vectors = (vectors * turn).eval();
            }
        }
        if (!turned) {
            return;
        }
    }
}

template <int N> bool invert(const Matrix<N> &c, Spectrum<N> &spectrum)
{
    Matrix<N> values = c;
    Matrix<N> vectors;
    diagonalise<N>(values, vectors);
    std::array<int, N> order;
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&values](int i, int j) { return values(i, i) > values(j, j); });
    const int stiffest = order[N - 1];
    if (!(values(stiffest, stiffest) > kRigid * values(order[0], order[0]))) {
        return false;
    }
    spectrum.k = c.inverse();
    for (int i = 0; i < N; ++i) {
        spectrum.lambda[i] = 1.0L / values(order[i], order[i]);
    }
    spectrum.stiff_axis = vectors.col(stiffest);
    return true;
}

Real principal(Real angle)
{
    while (angle > kHalfTurn / 2.0L) {
        angle -= kHalfTurn;
    }
    while (angle <= -kHalfTurn / 2.0L) {
        angle += kHalfTurn;
    }
    return angle;
}

} // namespace

bool planar(const Limb &limb, const Posture &posture, std::array<double, 9> &row)
{
    const Matrix3 c3 = compliance(elements_of(limb, posture, false));
    Matrix<2> c;
    c << c3(0, 0), c3(0, 2), c3(2, 0), c3(2, 2);
    Spectrum<2> spectrum;
    if (!invert<2>(c, spectrum)) {
        return false;
    }
    const Real axis = principal(std::atan2(spectrum.stiff_axis[1], spectrum.stiff_axis[0]));
    const Real values[] = {spectrum.k(0, 0), spectrum.k(0, 1),   spectrum.k(1, 1),   c(0, 0), c(0, 1),
                           c(1, 1),          spectrum.lambda[0], spectrum.lambda[1], axis};
    std::copy(std::begin(values), std::end(values), row.begin());
    return true;
}

bool spatial(const Limb &limb, Real theta0_rad, const Posture &posture, std::array<double, 18> &row)
{
    const Real cosine = std::cos(theta0_rad);
    const Real sine = std::sin(theta0_rad);
    Matrix3 turn;
    turn << cosine, -sine, 0.0L, sine, cosine, 0.0L, 0.0L, 0.0L, 1.0L;
    const Matrix3 c = turn * compliance(elements_of(limb, posture, true)) * turn.transpose();
    Spectrum<3> spectrum;
    if (!invert<3>(c, spectrum)) {
        return false;
    }
    std::size_t next = 0;
    const Matrix3 both[] = {spectrum.k, c};
    for (const Matrix3 &matrix : both) {
        for (int i = 0; i < 3; ++i) {
            for (int j = i; j < 3; ++j) {
                row[next++] = static_cast<double>(matrix(i, j));
            }
        }
    }
    for (int i = 0; i < 3; ++i) {
        row[next++] = static_cast<double>(spectrum.lambda[i]);
    }
    for (int i = 0; i < 3; ++i) {
        row[next++] = static_cast<double>(spectrum.stiff_axis[i]);
    }
    return true;
}

} // namespace brace::reference
