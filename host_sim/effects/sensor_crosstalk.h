// Each of the sensor's axes reads a share of the other's force.
// Reads sensor.crosstalk_*; depends on nothing else.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_crosstalk {

inline Eigen::Vector2d mixed_n(const Model &model, const Eigen::Vector2d &force_n)
{
    return {force_n.x() + model.sensor.crosstalk_xz * force_n.y(),
            model.sensor.crosstalk_zx * force_n.x() + force_n.y()};
}

} // namespace brace::effects::sensor_crosstalk
