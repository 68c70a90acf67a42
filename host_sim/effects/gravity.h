// The weights of femur, tibia and knee pull along direction_rad in the limb's plane, less where the plane leans out of
// it. While displacements count as small they are torques on the joints by posture, both links' at mid-length; else
// they pull at the bodies of plant/structure.h.
// Reads gravity.*; depends on nothing else.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstring>

#include "effects/effect.h"

namespace brace::effects::gravity {

// Where weights pull to: x outwards in the limb's plane, y to the left of it, z up.
inline Eigen::Vector3d down_in_space(const Model &model)
{
    const auto &weight = model.gravity;
    const double in_plane = std::cos(weight.lean_rad);
    return {in_plane * std::cos(weight.direction_rad), std::sin(weight.lean_rad),
            in_plane * std::sin(weight.direction_rad)};
}

inline bool is_same(const Model &a, const Model &b)
{
    return std::memcmp(&a.gravity, &b.gravity, sizeof a.gravity) == 0;
}

// The same in the limb's plane; shorter than 1 where the plane leans.
inline Eigen::Vector2d down(const Model &model)
{
    const Eigen::Vector3d in_space = down_in_space(model);
    return {in_space.x(), in_space.z()};
}

// Torques of the weights about the femur joint and the knee [N mm], counter-clockwise positive.
inline Eigen::Vector2d torques_n_mm(const Model &model, const Eigen::Vector2d &femur_mm,
                                    const Eigen::Vector2d &tibia_mm)
{
    const auto &weight = model.gravity;
    const Eigen::Vector2d pull = down(model);
    const auto turned_by = [&](const Eigen::Vector2d &arm_mm) { return arm_mm.x() * pull.y() - arm_mm.y() * pull.x(); };
    const double beyond_knee = weight.tibia_n * 0.5 * turned_by(tibia_mm);
    const double at_knee = (0.5 * weight.femur_n + weight.knee_n + weight.tibia_n) * turned_by(femur_mm);
    return {at_knee + beyond_knee, beyond_knee};
}

} // namespace brace::effects::gravity
