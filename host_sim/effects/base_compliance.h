// The base moves and turns: displacement = compliance * force, rotation = compliance * moment
// about the femur axis.
#pragma once

#include <Eigen/Core>

#include "effects/effect.h"

namespace brace::effects::base_compliance {

// Tip displacement per tip force; `femur_lever_mm` is the tip's displacement per turn about the femur axis.
inline Eigen::Matrix2d compliance_mm_per_n(const Model &model, const Eigen::Vector2d &femur_lever_mm)
{
    Eigen::Matrix2d compliance = Eigen::Matrix2d::Zero();
    compliance.diagonal() << model.base.x_mm_per_n, model.base.z_mm_per_n;
    compliance += model.base.rotation_rad_per_n_mm * femur_lever_mm * femur_lever_mm.transpose();
    return compliance;
}

// The reading of a dial gauge against the base.
inline Eigen::Vector2d shift_mm(const Model &model, const Eigen::Vector2d &force_n)
{
    return {model.base.x_mm_per_n * force_n.x(), model.base.z_mm_per_n * force_n.y()};
}

} // namespace brace::effects::base_compliance
