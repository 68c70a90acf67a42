// The sensor's zero moves with time.
// Reads sensor.drift_*; depends on time.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::sensor_drift {

inline Eigen::Vector2d offset_n(const Model &model, double t_s)
{
    return t_s * Eigen::Vector2d(model.sensor.drift_x_n_per_s, model.sensor.drift_z_n_per_s);
}

} // namespace brace::effects::sensor_drift
