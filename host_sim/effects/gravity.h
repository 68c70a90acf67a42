// The weights of femur, tibia (both at mid-length) and knee load the joints by posture. They pull along direction_rad
// in the limb's plane, less where it leans out of it. They do not load links and base.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "effects/effect.h"

namespace brace::effects::gravity {

// Torques of the weights about the femur joint and the knee [N mm], counter-clockwise positive.
inline Eigen::Vector2d torques_n_mm(const Model &model, const Eigen::Vector2d &femur_mm,
                                    const Eigen::Vector2d &tibia_mm)
{
    const auto &weight = model.gravity;
    const double in_plane = std::cos(weight.lean_rad);
    const double down_x = in_plane * std::cos(weight.direction_rad), down_z = in_plane * std::sin(weight.direction_rad);
    const auto turned_by = [&](const Eigen::Vector2d &arm_mm) { return arm_mm.x() * down_z - arm_mm.y() * down_x; };
    const double beyond_knee = weight.tibia_n * 0.5 * turned_by(tibia_mm);
    const double at_knee = (0.5 * weight.femur_n + weight.knee_n + weight.tibia_n) * turned_by(femur_mm);
    return {at_knee + beyond_knee, beyond_knee};
}

} // namespace brace::effects::gravity
