// The sensor clips what each axis reads to +-limit, after everything else.
// Reads sensor.saturation_n; depends on the load.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_saturation {

inline Eigen::Vector2d clipped_n(const Model &model, const Eigen::Vector2d &reading_n)
{
    const double limit = model.sensor.saturation_n;
    return reading_n.cwiseMin(limit).cwiseMax(-limit);
}

} // namespace brace::effects::sensor_saturation
