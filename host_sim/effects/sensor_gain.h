// The sensor reads every force times its gain.
// Reads sensor.gain; depends on nothing else.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_gain {

inline Eigen::Vector2d scaled_n(const Model &model, const Eigen::Vector2d &force_n)
{
    return model.sensor.gain * force_n;
}

} // namespace brace::effects::sensor_gain
