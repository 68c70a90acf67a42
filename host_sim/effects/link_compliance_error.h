// A link's compliance ellipsoid: principal compliances of its far end, its axes turned by tilt from the
// link's. The effect of this name is the ellipsoid being another than the calibration says.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::link_compliance_error {

// Axes of the ellipsoid for a link pointing along `link_axis`: columns are the axial and bending directions.
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

inline void none(Model &model)
{
    for (auto &link : model.link) {
        link = {};
    }
}

inline constexpr const char *kLaw = "end displacement = compliance ellipsoid * force";
inline constexpr Entry kEntries[] = {
    {"link_compliance_error", "link.femur",
     "link.femur.axial_mm_per_n link.femur.bending_mm_per_n link.femur.tilt_rad", kLaw},
    {"link_compliance_error", "link.tibia",
     "link.tibia.axial_mm_per_n link.tibia.bending_mm_per_n link.tibia.tilt_rad", kLaw},
};

} // namespace brace::effects::link_compliance_error
