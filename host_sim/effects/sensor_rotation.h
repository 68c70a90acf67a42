// The sensor is mounted turned: it reads R(angle) * force.
// Reads sensor.rotation_rad; depends on nothing else.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::sensor_rotation {

// A reading of a force is this matrix times the force.
inline Eigen::Matrix2d turn(const Model &model)
{
    const double c = std::cos(model.sensor.rotation_rad);
    const double s = std::sin(model.sensor.rotation_rad);
    return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

} // namespace brace::effects::sensor_rotation
