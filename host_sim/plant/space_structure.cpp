#include "plant/space_structure.h"

#include <Eigen/Geometry>
#include <cmath>

#include "effects/base_compliance.h"
#include "effects/gravity.h"
#include "effects/joint_zero_offset.h"
#include "effects/moment_transfer.h"

namespace brace::plant {
namespace {

using effects::kCoxa;
using effects::kFemur;
using effects::kTibia;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const double kFromMiddle = 0.5 / std::sqrt(3.0); // of a part's Gauss points, in lengths of the part
const Vector3d kLeft = Vector3d::UnitY();
const Vector3d kCounterClockwise = -Vector3d::UnitY(); // turns x towards z

Vector3d in_plane(double angle_rad)
{
    return {std::cos(angle_rad), 0.0, std::sin(angle_rad)};
}

// Adds bodies from the base to the tip.
class Builder {
public:
    Builder(SpaceStructure &structure, const Vector3d &start_mm) : structure_(structure), at_mm_(start_mm)
    {
        structure_.body_count = 0;
    }

    void joint(int index, const Vector3d &axis, const Vector3d &at_mm)
    {
        structure_.joint_body[static_cast<std::size_t>(index)] = structure_.body_count;
        add(at_mm).joint = index;
        last().axis = axis;
    }

    void hinge(const Vector3d &axis, const Vector3d &at_mm, double rad_per_n_mm)
    {
        if (rad_per_n_mm > 0.0) {
            add(at_mm).hinge_rad_per_n_mm = rad_per_n_mm;
            last().axis = axis;
        }
    }

    void slides(const Vector3d &at_mm, const Matrix3d &mm_per_n)
    {
        if (!mm_per_n.isZero(0.0)) {
            if (at_mm != at_mm_ || last().weight_n != 0.0 || last().yields) {
                add(at_mm);
            }
            last().yields = true;
            last().mm_per_n = mm_per_n;
        }
    }

    void weight(const Vector3d &at_mm, double weight_n)
    {
        if (weight_n != 0.0) { // several on one body pull at their middle
            SpaceBody &body = last();
            const Vector3d moment = body.weight_n * body.weight_arm_mm + weight_n * (at_mm - at_mm_);
            body.weight_n += weight_n;
            body.weight_arm_mm = moment / body.weight_n;
        }
    }

    void end(const Vector3d &tip_mm) { last().extent_mm = tip_mm - at_mm_; }

private:
    SpaceBody &last() { return structure_.body[static_cast<std::size_t>(structure_.body_count - 1)]; }

    SpaceBody &add(const Vector3d &at_mm)
    {
        if (structure_.body_count > 0) {
            end(at_mm);
        } else {
            structure_.root_mm = at_mm;
        }
        at_mm_ = at_mm;
        ++structure_.body_count;
        last() = {kElastic, kLeft, 0.0, false, Matrix3d::Zero(), Vector3d::Zero(), 0.0, Vector3d::Zero()};
        return last();
    }

    SpaceStructure &structure_;
    Vector3d at_mm_; // where the last body begins
};

struct Line {
    Vector3d root_mm;
    double angle_rad;
    double length_mm;
};

// The link behind a joint. Weights, sideways bending and twist keep to its line; a tilt turns the line of its bending
// in the plane about the link's end.
void add_link(const Model &model, int index, const Line &line, double weight_n, Builder &builder)
{
    const auto &link = model.link[index];
    const double bending = link.bending_mm_per_n;
    const Vector3d along = in_plane(line.angle_rad), up = along.cross(kLeft);
    const Vector3d elastic_along = in_plane(line.angle_rad + link.tilt_rad), elastic_up = elastic_along.cross(kLeft);
    const Vector3d end_mm = line.root_mm + line.length_mm * along;
    const double beam = line.length_mm > 0.0 ? link.moment_transfer : 0.0, ellipsoid = 1.0 - beam;
    const auto square = [](const Vector3d &v) -> Matrix3d { return v * v.transpose(); };
    const auto on_line_mm = [&](double share) -> Vector3d { return line.root_mm + share * line.length_mm * along; };

    builder.slides(line.root_mm, beam * link.axial_mm_per_n * square(elastic_along));
    if (beam == 0.0) {
        builder.weight(on_line_mm(0.5), weight_n);
    } else {
        const auto per_hinge = [&](double end_mm_per_n) {
            return effects::moment_transfer::hinge_rad_per_n_mm(end_mm_per_n, line.length_mm, beam, 2 * kBeamParts);
        };
        double weighed = 0.0; // share of the length
        const auto weigh_to = [&](double share) {
            builder.weight(on_line_mm(0.5 * (weighed + share)), beam * (share - weighed) * weight_n);
            weighed = share;
        };
        for (int part = 0; part < kBeamParts; ++part) {
            for (const double side : {-1.0, 1.0}) {
                const double share = (part + 0.5 + side * kFromMiddle) / kBeamParts;
                const auto bend = [&] {
                    const Vector3d at_mm = end_mm - (1.0 - share) * line.length_mm * elastic_along;
                    builder.hinge(kCounterClockwise, at_mm, per_hinge(bending));
                };
                weigh_to(share);
                if (side < 0.0) {
                    bend();
                }
                builder.hinge(up, on_line_mm(share), per_hinge(link.lateral_mm_per_n));
                if (side > 0.0) {
                    bend();
                } else {
                    builder.hinge(along, on_line_mm(share), beam * link.torsion_rad_per_n_mm / kBeamParts);
                    if (2 * part + 1 == kBeamParts) {
                        builder.weight(on_line_mm(0.5), ellipsoid * weight_n);
                    }
                }
            }
            if (2 * part + 2 == kBeamParts) {
                builder.weight(on_line_mm(0.5), ellipsoid * weight_n);
            }
        }
        weigh_to(1.0);
    }
    builder.slides(end_mm, ellipsoid
                               * (link.axial_mm_per_n * square(elastic_along) + bending * square(elastic_up)
                                  + link.lateral_mm_per_n * square(kLeft)));
    builder.hinge(along, end_mm, ellipsoid * link.torsion_rad_per_n_mm);
}

} // namespace

double total_weight_n(const SpaceStructure &structure)
{
    double sum = 0.0;
    for (int i = 0; i < structure.body_count; ++i) {
        sum += structure.body[static_cast<std::size_t>(i)].weight_n;
    }
    return sum;
}

void find_structure(const Model &model, double theta1_rad, double theta2_rad, SpaceStructure &structure)
{
    const double theta1 = effects::joint_zero_offset::true_angle_rad(model, kFemur, theta1_rad);
    const double theta2 = effects::joint_zero_offset::true_angle_rad(model, kTibia, theta2_rad);
    const auto &length = model.geometry;
    const auto &weight = model.gravity;
    const Vector3d origin = Vector3d::Zero(), yaw_axis_mm(-length.coxa_mm, 0.0, 0.0);
    const Vector3d knee_mm = length.femur_mm * in_plane(theta1);
    const Vector3d tip_mm = knee_mm + length.tibia_mm * in_plane(theta1 - theta2);
    const Eigen::Vector2d base = effects::base_compliance::along_mm_per_n(model);

    structure.base_mm_per_n = {base.x(), 0.0, base.y()};
    structure.down = effects::gravity::down_in_space(model);
    structure.reach_mm = length.coxa_mm + length.femur_mm + length.tibia_mm;
    Builder builder(structure, origin);
    builder.hinge(kCounterClockwise, origin, effects::base_compliance::turning_rad_per_n_mm(model));
    builder.joint(kCoxa, Vector3d::UnitZ(), yaw_axis_mm);
    add_link(model, kCoxa, {yaw_axis_mm, 0.0, length.coxa_mm}, 0.0, builder);
    builder.joint(kFemur, kCounterClockwise, origin);
    add_link(model, kFemur, {origin, theta1, length.femur_mm}, weight.femur_n, builder);
    builder.weight(knee_mm, weight.knee_n);
    builder.joint(kTibia, kCounterClockwise, knee_mm);
    add_link(model, kTibia, {knee_mm, theta1 - theta2, length.tibia_mm}, weight.tibia_n, builder);
    builder.end(tip_mm);
}

SpaceStructure without_loads(SpaceStructure structure)
{
    for (SpaceBody &body : structure.body) {
        body.weight_n = 0.0;
    }
    return structure;
}

} // namespace brace::plant
