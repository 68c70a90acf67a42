// The sensor reads this much at no force.
// Reads sensor.bias_*; depends on nothing else.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_bias {

inline Eigen::Vector2d offset_n(const Model &model)
{
    return {model.sensor.bias_x_n, model.sensor.bias_z_n};
}

} // namespace brace::effects::sensor_bias
