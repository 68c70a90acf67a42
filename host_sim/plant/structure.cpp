#include "plant/structure.h"

#include <cmath>

#include "effects/base_compliance.h"
#include "effects/gravity.h"
#include "effects/joint_zero_offset.h"
#include "effects/link_change.h"
#include "effects/link_compliance_error.h"
#include "effects/moment_transfer.h"

namespace brace::plant {
namespace {

using effects::kFemur;
using effects::kTibia;
using Eigen::Matrix2d;
using Eigen::Vector2d;

Vector2d direction(double angle_rad)
{
    return {std::cos(angle_rad), std::sin(angle_rad)};
}

// A quarter turn counter-clockwise: the lever of a rotation about the origin.
Vector2d quarter_turn(const Vector2d &v)
{
    return {-v.y(), v.x()};
}

} // namespace

Structure structure_at(const Model &model, double theta1_rad, double theta2_rad, double t_s)
{
    const double theta1 = effects::joint_zero_offset::true_angle_rad(model, kFemur, theta1_rad);
    const double theta2 = effects::joint_zero_offset::true_angle_rad(model, kTibia, theta2_rad);
    const Vector2d femur_axis = direction(theta1);
    const Vector2d tibia_axis = direction(theta1 - theta2);
    const Vector2d femur = model.geometry.femur_mm * femur_axis;
    const Vector2d tibia = model.geometry.tibia_mm * tibia_axis;

    Structure structure;
    structure.lever_mm = {quarter_turn(femur + tibia), quarter_turn(tibia)};
    structure.gravity_n_mm = effects::gravity::torques_n_mm(model, femur, tibia);

    Matrix2d compliance = effects::base_compliance::compliance_mm_per_n(model, structure.lever_mm[0]);
    const Vector2d link_axis[] = {{}, femur_axis, tibia_axis};
    for (const int index : {kFemur, kTibia}) {
        const auto &link = model.link[index];
        const double bending = effects::link_change::bending_mm_per_n(model, index, t_s);
        const Matrix2d axes = effects::link_compliance_error::axes(link_axis[index], link.tilt_rad);
        compliance += effects::link_compliance_error::compliance(axes, link.axial_mm_per_n, bending);
        if (index == kFemur && link.moment_transfer_ratio != 0.0) {
            // Only the femur has a part beyond its end, which turns the tip force into a moment at that end.
            using namespace effects::moment_transfer;
            const double length = model.geometry.femur_mm;
            const Vector2d &arm = structure.lever_mm[1];
            const Matrix2d coupled = axes.col(1) * arm.transpose();
            compliance +=
                coupling_per_n(bending, length, link.moment_transfer_ratio) * (coupled + coupled.transpose());
            compliance +=
                rotation_rad_per_n_mm(bending, length, link.moment_transfer_ratio) * arm * arm.transpose();
        }
    }
    structure.compliance_mm_per_n = compliance;
    return structure;
}

} // namespace brace::plant
