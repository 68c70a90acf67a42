// The sensor is mounted turned: it reads R(angle) * force.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::sensor_rotation {

inline Eigen::Vector2d turned_n(const Model &model, const Eigen::Vector2d &force_n)
{
    const double c = std::cos(model.sensor.rotation_rad);
    const double s = std::sin(model.sensor.rotation_rad);
    return {c * force_n.x() - s * force_n.y(), s * force_n.x() + c * force_n.y()};
}

} // namespace brace::effects::sensor_rotation
