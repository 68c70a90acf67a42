// A link yields as an ellipsoid: it has principal compliances at the far end, and tilt turns its axes away from the
// link's. The effect is that the ellipsoid differs from the calibration's.
// Reads link.*; depends on nothing else.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::link_compliance_error {

// The ellipsoid's axes for a link that points along `link_axis`; the columns are the axial and the bending direction.
inline Eigen::Matrix2d axes(const Eigen::Vector2d &link_axis, double tilt_rad)
{
    const double c = std::cos(tilt_rad);
    const double s = std::sin(tilt_rad);
    const Eigen::Vector2d across(-link_axis.y(), link_axis.x());
    Eigen::Matrix2d result;
    result.col(0) = c * link_axis + s * across;
    result.col(1) = c * across - s * link_axis;
    return result;
}

inline Eigen::Matrix2d compliance(const Eigen::Matrix2d &axes, double axial_mm_per_n, double bending_mm_per_n)
{
    return axial_mm_per_n * axes.col(0) * axes.col(0).transpose()
           + bending_mm_per_n * axes.col(1) * axes.col(1).transpose();
}

} // namespace brace::effects::link_compliance_error
