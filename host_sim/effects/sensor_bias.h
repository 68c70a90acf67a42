// The sensor reads this much at no force.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_bias {

inline Eigen::Vector2d offset_n(const Model &model)
{
    return {model.sensor.bias_x_n, model.sensor.bias_z_n};
}

inline void none(Model &model)
{
    model.sensor.bias_x_n = 0.0;
    model.sensor.bias_z_n = 0.0;
}

inline constexpr Entry kEntries[] = {
    {"sensor_bias", "sensor", "sensor.bias_x_n sensor.bias_z_n", "reading = force + bias"},
};

} // namespace brace::effects::sensor_bias
