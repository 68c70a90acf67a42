// The sensor reads every force times its gain.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_gain {

inline Eigen::Vector2d scaled_n(const Model &model, const Eigen::Vector2d &force_n)
{
    return model.sensor.gain * force_n;
}

inline void none(Model &model)
{
    model.sensor.gain = 1.0;
}

inline constexpr Entry kEntries[] = {
    {"sensor_gain", "sensor", "sensor.gain", "reading = gain * force"},
};

} // namespace brace::effects::sensor_gain
