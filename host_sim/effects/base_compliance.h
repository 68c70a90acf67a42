// The base moves and turns: displacement = compliance * force, along the robot's x and z whatever its turn; rotation =
// compliance * moment about the femur axis.
// Reads base.*; depends on nothing else.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::base_compliance {

inline Eigen::Vector2d along_mm_per_n(const Model &model)
{
    return {model.base.x_mm_per_n, model.base.z_mm_per_n};
}

inline double turning_rad_per_n_mm(const Model &model)
{
    return model.base.rotation_rad_per_n_mm;
}

} // namespace brace::effects::base_compliance
