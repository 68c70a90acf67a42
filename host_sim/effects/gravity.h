// The weights of femur, tibia and knee as torques on the joints, by posture: both links' at mid-length. This is all
// that they do while displacements count as small; else they pull at the bodies of plant/structure.h.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::gravity {

// Torques of the weights about the femur joint and the knee [N mm], counter-clockwise positive.
inline Eigen::Vector2d torques_n_mm(const Model &model, const Eigen::Vector2d &femur_mm,
                                    const Eigen::Vector2d &tibia_mm)
{
    const auto &weight = model.gravity;
    const double beyond_knee = weight.tibia_n * 0.5 * tibia_mm.x();
    const double at_knee = (0.5 * weight.femur_n + weight.knee_n + weight.tibia_n) * femur_mm.x();
    return {-(at_knee + beyond_knee), -beyond_knee};
}

} // namespace brace::effects::gravity
