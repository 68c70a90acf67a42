// The force sensor's reading of a force: bias + drift * t + gain * R * crosstalk * force, clipped.
#pragma once

#include "effects/sensor_bias.h"
#include "effects/sensor_crosstalk.h"
#include "effects/sensor_drift.h"
#include "effects/sensor_gain.h"
#include "effects/sensor_rotation.h"
#include "effects/sensor_saturation.h"

namespace brace::plant {

class Sensor {
public:
    explicit Sensor(const effects::Model &model) : model_(model), turn_(effects::sensor_rotation::turn(model)) {}

    Eigen::Vector2d reading_n(const Eigen::Vector2d &force_n, double t_s) const
    {
        using namespace effects;
        Eigen::Vector2d reading = turn_ * sensor_crosstalk::mixed_n(model_, force_n);
        reading = sensor_gain::scaled_n(model_, reading);
        reading += sensor_bias::offset_n(model_) + sensor_drift::offset_n(model_, t_s);
        return sensor_saturation::clipped_n(model_, reading);
    }

private:
    const effects::Model &model_;
    const Eigen::Matrix2d turn_;
};

} // namespace brace::plant
