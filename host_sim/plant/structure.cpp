#include "plant/structure.h"

#include <cmath>

#include "effects/base_compliance.h"
#include "effects/gravity.h"
#include "effects/joint_zero_offset.h"
#include "effects/link_compliance_error.h"
#include "effects/moment_transfer.h"

namespace brace::plant {
namespace {

using effects::kFemur;
using effects::kTibia;
using Eigen::Matrix2d;
using Eigen::Vector2d;

const double kFromMiddle = 0.5 / std::sqrt(3.0); // of a part's Gauss points, in lengths of the part

Vector2d direction(double angle_rad)
{
    return {std::cos(angle_rad), std::sin(angle_rad)};
}

Body &add(Structure &structure, int joint, double hinge_rad_per_n_mm)
{
    Body &body = structure.body[static_cast<std::size_t>(structure.body_count++)];
    body.joint = joint;
    body.hinge_rad_per_n_mm = hinge_rad_per_n_mm;
    body.extent_mm = body.weight_arm_mm = body.deviation_mm_per_n = Vector2d::Zero();
    body.weight_n = body.end_weight_n = body.mean_mm_per_n = 0.0;
    body.yields = Yields::nowhere;
    return body;
}

void let_yield(Body &body, Yields where, const Matrix2d &compliance)
{
    body.mean_mm_per_n = 0.5 * compliance.trace();
    body.deviation_mm_per_n = {0.5 * (compliance(0, 0) - compliance(1, 1)), compliance(0, 1)};
    body.yields = body.mean_mm_per_n > 0.0 ? where : Yields::nowhere;
}

// A joint and the link behind it. Weights lie on the line of the link; a tilt turns the beam's elastic line about the
// link's end.
void add_link(const Model &model, int index, const Vector2d &axis, double length_mm, double weight_n, int parts,
              Structure &structure)
{
    const auto &link = model.link[index];
    const double bending = link.bending_mm_per_n;
    const Matrix2d axes = effects::link_compliance_error::axes(axis, link.tilt_rad);
    const double beam = link.moment_transfer;
    const int hinges = beam > 0.0 ? 2 * parts : 0;
    const double part_mm = length_mm / parts;
    const double per_hinge =
        hinges > 0 ? effects::moment_transfer::hinge_rad_per_n_mm(bending, length_mm, beam, hinges) : 0.0;
    // From the joint: its own hinge, those of the beam, the link's end.
    const auto along_mm = [&](int hinge) {
        if (hinge == 0 || hinge > hinges) {
            return hinge == 0 ? 0.0 : length_mm;
        }
        const double side = hinge % 2 == 1 ? -1.0 : 1.0;
        return ((hinge - 1) / 2 + 0.5 + side * kFromMiddle) * part_mm;
    };
    const auto place_mm = [&](int hinge) -> Vector2d {
        return hinge == 0 ? Vector2d(0.0, 0.0)
                          : Vector2d(length_mm * axis - (length_mm - along_mm(hinge)) * axes.col(0));
    };

    structure.joint_body[static_cast<std::size_t>(index - kFemur)] = structure.body_count;
    for (int i = 0; i <= hinges; ++i) {
        Body &body = add(structure, i == 0 ? index - kFemur : kElastic, i == 0 ? 0.0 : per_hinge);
        body.extent_mm = place_mm(i + 1) - place_mm(i);
        // The middle of the link, where an ellipsoid has its weight, is the middle of this body too.
        const double share = (along_mm(i + 1) - along_mm(i)) / length_mm;
        body.weight_n = weight_n * (beam * share + (i == hinges / 2 ? 1.0 - beam : 0.0));
        body.weight_arm_mm = 0.5 * (along_mm(i) + along_mm(i + 1)) * axis - place_mm(i);
        if (i == 0 && hinges > 0) {
            let_yield(body, Yields::at_root,
                      effects::link_compliance_error::compliance(axes, beam * link.axial_mm_per_n, 0.0));
        }
        if (i == hinges && beam < 1.0) {
            let_yield(body, Yields::at_end,
                      effects::link_compliance_error::compliance(axes, (1.0 - beam) * link.axial_mm_per_n,
                                                                 (1.0 - beam) * bending));
        }
    }
}

} // namespace

double total_weight_n(const Structure &structure)
{
    double sum = 0.0;
    for (int i = 0; i < structure.body_count; ++i) {
        const Body &each = structure.body[static_cast<std::size_t>(i)];
        sum += each.weight_n + each.end_weight_n;
    }
    return sum;
}

void find_structure(const Model &model, Displacements displacements, double theta1_rad, double theta2_rad,
                    Structure &structure)
{
    const bool small = displacements == Displacements::small;
    const double theta1 = effects::joint_zero_offset::true_angle_rad(model, kFemur, theta1_rad);
    const double theta2 = effects::joint_zero_offset::true_angle_rad(model, kTibia, theta2_rad);
    const Vector2d femur_axis = direction(theta1);
    const Vector2d tibia_axis = direction(theta1 - theta2);
    const auto &length = model.geometry;
    const auto &weight = model.gravity;
    structure.down = effects::gravity::down(model);
    const int parts = small ? 1 : kBeamParts; // one is exact there

    structure.body_count = 0;
    structure.base_mm_per_n = effects::base_compliance::along_mm_per_n(model);
    structure.reach_mm = length.femur_mm + length.tibia_mm;
    structure.joint_load_n_mm =
        small ? effects::gravity::torques_n_mm(model, length.femur_mm * femur_axis, length.tibia_mm * tibia_axis)
              : Vector2d::Zero();
    const double base_turning = effects::base_compliance::turning_rad_per_n_mm(model);
    if (base_turning > 0.0) {
        add(structure, kElastic, base_turning);
    }
    add_link(model, kFemur, femur_axis, length.femur_mm, small ? 0.0 : weight.femur_n, parts, structure);
    structure.body[static_cast<std::size_t>(structure.body_count - 1)].end_weight_n = small ? 0.0 : weight.knee_n;
    add_link(model, kTibia, tibia_axis, length.tibia_mm, small ? 0.0 : weight.tibia_n, parts, structure);
}

Structure without_loads(Structure structure)
{
    structure.joint_load_n_mm.setZero();
    for (Body &body : structure.body) {
        body.weight_n = body.end_weight_n = 0.0;
    }
    return structure;
}

} // namespace brace::plant
