#include "plant/space_condensed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace brace::plant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// v -> a x v
Matrix3d crossed(const Vector3d &a)
{
    Matrix3d result;
    result << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return result;
}

// A turn less the identity, from half its angle: what a small turn moves keeps all its digits.
Matrix3d turned_by(const Vector3d &axis, double angle_rad)
{
    const double half_sin = std::sin(0.5 * angle_rad);
    const double sin = 2.0 * half_sin * std::cos(0.5 * angle_rad), versine = 2.0 * half_sin * half_sin;
    Matrix3d result = versine * (axis * axis.transpose());
    result.diagonal().array() -= versine;
    return result + sin * crossed(axis);
}

// Where each body has turned to, less the identity, and where its hinge's axis then points.
struct Placed {
    std::array<Matrix3d, kMostSpaceBodies> turned;
    std::array<Vector3d, kMostSpaceBodies> axis;
};

void place(const SpaceStructure &structure, const SpaceShape &shape, Placed &placed)
{
    Matrix3d turned = Matrix3d::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(structure.body_count); ++i) {
        const SpaceBody &body = structure.body[i];
        placed.axis[i] = body.axis + turned * body.axis;
        if (shape.turn_rad[i] != 0.0) {
            const Matrix3d more = turned_by(body.axis, shape.turn_rad[i]);
            turned += more + turned * more;
        }
        placed.turned[i] = turned;
    }
}

// W of all loads beyond a place, without what is eliminated.
struct Work {
    Vector3d force_n; // that acts beyond
    Vector3d tip_mm = Vector3d::Zero(), moment_n_mm = Vector3d::Zero();    // by the force, by phi
    Matrix3d compliance_mm_per_n = Matrix3d::Zero();                        // by the force twice
    Matrix3d lever_mm = Matrix3d::Zero();                                   // the tip's way by phi
    Matrix3d curvature_n_mm = Matrix3d::Zero();                             // by phi twice

    void add_arm(const Vector3d &arm_mm, const Vector3d &load_n)
    {
        const Matrix3d product = 0.5 * arm_mm * load_n.transpose();
        curvature_n_mm += product + product.transpose();
        curvature_n_mm.diagonal().array() -= arm_mm.dot(load_n);
        moment_n_mm += arm_mm.cross(load_n);
    }

    // A body that yields turns with its springs: the stretch is an arm, and the springs see a turned force.
    void let_yield(const SpaceBody &body, const Matrix3d &turned)
    {
        const Matrix3d turn = Matrix3d::Identity() + turned;
        const Matrix3d mm_per_n = turn * body.mm_per_n * turn.transpose();
        const Vector3d stretch_mm = mm_per_n * force_n;
        const Matrix3d force_crossed = crossed(force_n);
        const Matrix3d by_turned_force = mm_per_n * force_crossed;
        add_arm(stretch_mm, force_n);
        curvature_n_mm -= force_crossed * by_turned_force; // its transpose is its negative
        lever_mm += by_turned_force - crossed(stretch_mm);
        compliance_mm_per_n += mm_per_n;
        tip_mm += stretch_mm;
    }
};

} // namespace

void SpaceCondensed::about(const SpaceStructure &structure, const std::array<JointHinge, 3> &joint,
                           const SpaceShape &shape)
{
    Placed placed;
    place(structure, shape, placed);
    Work work;
    work.force_n = shape.force_n;
    Matrix3d by_turn = Matrix3d::Zero(); // moment by the kept turn of each joint
    Vector3d torque_n_mm = Vector3d::Zero();
    Matrix3d lever_mm = Matrix3d::Zero(), torque_n_mm_per_rad = Matrix3d::Zero();
    double negative_pivots = 0.0;
    count_ = 0;
    for (std::size_t i = static_cast<std::size_t>(structure.body_count); i-- > 0;) {
        const SpaceBody &body = structure.body[i];
        const Matrix3d &turned = placed.turned[i];
        if (body.weight_n != 0.0) {
            const Vector3d arm_mm = body.weight_arm_mm + turned * body.weight_arm_mm;
            work.add_arm(arm_mm, body.weight_n * structure.down);
        }
        const Vector3d moved_mm = turned * body.extent_mm, extent_mm = body.extent_mm + moved_mm;
        work.add_arm(extent_mm, work.force_n);
        work.lever_mm -= crossed(extent_mm);
        work.tip_mm += moved_mm;
        work.force_n += body.weight_n * structure.down;
        if (body.yields) {
            work.let_yield(body, turned);
        }
        const bool is_joint = body.joint != kElastic;
        const auto k = static_cast<Eigen::Index>(is_joint ? body.joint : 0);
        const double compliance =
            is_joint ? joint[static_cast<std::size_t>(k)].compliance_rad_per_n_mm : body.hinge_rad_per_n_mm;
        if (!is_joint && compliance == 0.0) {
            continue;
        }
        const double strained_rad =
            shape.turn_rad[i] - (is_joint ? joint[static_cast<std::size_t>(k)].unstrained_rad : 0.0);
        const Vector3d &axis = placed.axis[i];
        Hinge &hinge = hinge_[static_cast<std::size_t>(count_)];
        body_of_[static_cast<std::size_t>(count_++)] = static_cast<int>(i);
        hinge.joint = body.joint;
        hinge.axis = axis;
        hinge.lever_mm = work.lever_mm * axis;
        hinge.by_turn_n_mm_per_rad = by_turn.transpose() * axis;
        hinge.torque_n_mm = axis.dot(work.moment_n_mm);
        const Vector3d by_axis = work.curvature_n_mm * axis;
        hinge.curvature_n_mm_per_rad = axis.dot(by_axis);
        hinge.by_phi_n_mm_per_rad = by_axis + 0.5 * axis.cross(work.moment_n_mm);
        const double pivot = 1.0 - compliance * hinge.curvature_n_mm_per_rad;
        hinge.turn_per_torque = compliance / pivot;
        hinge.lacks_rad = (compliance * hinge.torque_n_mm - strained_rad) / pivot;
        negative_pivots += pivot < 0.0 ? 1.0 : 0.0;

        const Vector3d turn_by_force = hinge.turn_per_torque * hinge.lever_mm;
        const Vector3d turn_by_turn = hinge.turn_per_torque * hinge.by_turn_n_mm_per_rad;
        const Vector3d turn_by_phi = hinge.turn_per_torque * hinge.by_phi_n_mm_per_rad;
        work.compliance_mm_per_n += hinge.lever_mm * turn_by_force.transpose();
        work.lever_mm += hinge.lever_mm * turn_by_phi.transpose();
        work.curvature_n_mm += hinge.by_phi_n_mm_per_rad * turn_by_phi.transpose();
        lever_mm += hinge.lever_mm * turn_by_turn.transpose();
        torque_n_mm_per_rad += hinge.by_turn_n_mm_per_rad * turn_by_turn.transpose();
        by_turn += turn_by_phi * hinge.by_turn_n_mm_per_rad.transpose();
        work.tip_mm += hinge.lacks_rad * hinge.lever_mm;
        torque_n_mm += hinge.lacks_rad * hinge.by_turn_n_mm_per_rad;
        work.moment_n_mm += hinge.lacks_rad * hinge.by_phi_n_mm_per_rad;
        if (is_joint) { // its kept turn, before its spring
            const Vector3d kept_by_axis = work.curvature_n_mm * axis;
            const Vector3d others = by_turn.transpose() * axis;
            lever_mm.col(k) += work.lever_mm * axis;
            torque_n_mm[k] += axis.dot(work.moment_n_mm);
            torque_n_mm_per_rad.col(k) += others;
            torque_n_mm_per_rad.row(k) += others.transpose();
            torque_n_mm_per_rad(k, k) += axis.dot(kept_by_axis);
            by_turn.col(k) += kept_by_axis + 0.5 * axis.cross(work.moment_n_mm);
        }
    }
    moment_n_mm_ = work.moment_n_mm;
    work.compliance_mm_per_n.diagonal() += structure.base_mm_per_n;
    work.tip_mm += structure.base_mm_per_n.cwiseProduct(work.force_n);
    tangent_ = {work.tip_mm,
                {torque_n_mm[0], torque_n_mm[1], torque_n_mm[2]},
                work.compliance_mm_per_n,
                {lever_mm.col(0), lever_mm.col(1), lever_mm.col(2)},
                torque_n_mm_per_rad,
                negative_pivots};
}

void SpaceCondensed::follow(const Change<3> &change, const SpaceShape &shape, Followed &followed) const
{
    followed.shape = shape;
    const Vector3d kept(change.turn_rad[0], change.turn_rad[1], change.turn_rad[2]);
    Vector3d turned_rad = Vector3d::Zero(); // the present body
    double most_rad = 0.0;
    for (std::size_t i = static_cast<std::size_t>(count_); i-- > 0;) { // from the base to the tip
        const Hinge &hinge = hinge_[i];
        const auto k = static_cast<std::size_t>(hinge.joint);
        const bool is_joint = hinge.joint != kElastic;
        const double kept_rad = is_joint ? change.turn_rad[k] : 0.0;
        const double more_n_mm = hinge.lever_mm.dot(change.force_n) + hinge.by_turn_n_mm_per_rad.dot(kept)
                                 + hinge.by_phi_n_mm_per_rad.dot(turned_rad) + hinge.curvature_n_mm_per_rad * kept_rad;
        const double sprung_rad = hinge.lacks_rad + hinge.turn_per_torque * more_n_mm;
        turned_rad += (kept_rad + sprung_rad) * hinge.axis;
        followed.shape.turn_rad[static_cast<std::size_t>(body_of_[i])] += kept_rad + sprung_rad;
        if (is_joint) {
            followed.torque_n_mm[k] = hinge.torque_n_mm + more_n_mm + hinge.curvature_n_mm_per_rad * sprung_rad;
        }
        most_rad = std::max(most_rad, turned_rad.norm());
    }
    followed.shape.force_n += change.force_n;
    followed.most_rad = most_rad;
}

} // namespace brace::plant
