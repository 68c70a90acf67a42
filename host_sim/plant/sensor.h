// The force sensor's reading of a force: bias + drift * t + gain * R * crosstalk * force, clipped.
#pragma once

#include "effects/sensor_bias.h"
#include "effects/sensor_crosstalk.h"
#include "effects/sensor_drift.h"
#include "effects/sensor_gain.h"
#include "effects/sensor_rotation.h"
#include "effects/sensor_saturation.h"

namespace brace::plant {

inline Eigen::Vector2d sensor_reading_n(const effects::Model &model, const Eigen::Vector2d &force_n,
                                        double t_s)
{
    using namespace effects;
    Eigen::Vector2d reading = sensor_crosstalk::mixed_n(model, force_n);
    reading = sensor_rotation::turned_n(model, reading);
    reading = sensor_gain::scaled_n(model, reading);
    reading += sensor_bias::offset_n(model) + sensor_drift::offset_n(model, t_s);
    return sensor_saturation::clipped_n(model, reading);
}

} // namespace brace::plant
