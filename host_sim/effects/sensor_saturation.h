// The sensor's axes end: readings are clipped to +-limit, after everything else.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "effects/effect.h"

namespace brace::effects::sensor_saturation {

inline Eigen::Vector2d clipped_n(const Model &model, const Eigen::Vector2d &reading_n)
{
    const double limit = model.sensor.saturation_n;
    return reading_n.cwiseMin(limit).cwiseMax(-limit);
}

inline void none(Model &model)
{
    model.sensor.saturation_n = std::numeric_limits<double>::infinity();
}

inline constexpr Entry kEntries[] = {
    {"sensor_saturation", "sensor", "sensor.saturation_n", "each axis of the reading within +-limit"},
};

} // namespace brace::effects::sensor_saturation
