// The tip's compliance where it is held along all axes or along some: what pushes back, and what pushes the wrong way.
// free_axis has a bit for each axis along which nothing holds the tip: in the plane 1 x, 2 z; in space all or none.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "plant/shape.h"

namespace brace::plant {

template <int N> constexpr int kAllFree = (1 << N) - 1;

// The sum of the products of two eigenvalues each.
inline double pairs(const Eigen::Matrix3d &matrix)
{
    return matrix.topLeftCorner<2, 2>().determinant() + matrix.bottomRightCorner<2, 2>().determinant()
           + matrix(0, 0) * matrix(2, 2) - matrix(0, 2) * matrix(2, 0);
}

// The smallest eigenvalue of a compliance over the largest, but for a small factor.
inline double least_share(const Eigen::Matrix2d &compliance)
{
    const double trace = compliance.trace();
    return trace > 0.0 ? compliance.determinant() / (trace * trace) : 0.0;
}

inline double least_share(const Eigen::Matrix3d &compliance)
{
    const double scale = compliance.trace() * pairs(compliance);
    return scale > 0.0 ? compliance.determinant() / scale : 0.0;
}

// K of the held tip: no force acts along a free axis.
template <int N> Matrix<N> stiffness_held(const Matrix<N> &compliance, int free_axis)
{
    if (free_axis == 0) {
        return compliance.inverse();
    }
    Matrix<N> stiffness = Matrix<N>::Zero();
    if (free_axis != kAllFree<N>) {
        const int held = 2 - free_axis;
        stiffness(held, held) = 1.0 / compliance(held, held);
    }
    return stiffness;
}

inline int negative_eigenvalues(const Eigen::Matrix2d &compliance)
{
    if (compliance.determinant() < 0.0) {
        return 1;
    }
    return compliance.trace() < 0.0 ? 2 : 0;
}

// All eigenvalues are real, so the signs of their characteristic polynomial count the negative ones (Descartes).
inline int negative_eigenvalues(const Eigen::Matrix3d &compliance)
{
    int changes = 0;
    double last = 1.0;
    for (const double each : {compliance.trace(), pairs(compliance), compliance.determinant()}) {
        changes += last * each < 0.0 ? 1 : 0;
        last = each;
    }
    return changes;
}

// How many of a compliance's directions, among those held, push the wrong way.
template <int N> int negatives(const Matrix<N> &compliance, int free_axis)
{
    if (free_axis == kAllFree<N>) {
        return 0;
    }
    if (free_axis != 0) {
        return compliance(2 - free_axis, 2 - free_axis) < 0.0 ? 1 : 0;
    }
    return negative_eigenvalues(compliance);
}

} // namespace brace::plant
