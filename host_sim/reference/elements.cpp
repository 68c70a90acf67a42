#include "reference/elements.h"

#include <Eigen/Geometry>
#include <cmath>

namespace brace::reference {
namespace {

constexpr int kAlong = 0, kAcross = 1, kSideways = 2, kTwist = 3, kTurnInPlane = 4, kTurnSideways = 5;

// Unit vectors of a frame in the limb's plane: e along the angle, n a quarter turn on, y sideways.
struct Frame {
    Vector3 along, across;
};

Frame frame_at(Real angle)
{
    return {{std::cos(angle), 0.0L, std::sin(angle)}, {-std::sin(angle), 0.0L, std::cos(angle)}};
}

const Vector3 kY = {0.0L, 1.0L, 0.0L};

// A row of T: the part of the tip force along `direction`.
Eigen::Matrix<Real, 1, 3> force_row(const Vector3 &direction)
{
    return direction.transpose();
}

// A row of T: the moment of the tip force about `axis` through a point, the tip at `arm` from it:
// axis . (arm x f) = (axis x arm) . f.
Eigen::Matrix<Real, 1, 3> moment_row(const Vector3 &axis, const Vector3 &arm)
{
    return axis.cross(arm).transpose();
}

// The direction in which a turn about an axis moves the points further along e: towards n, or towards y.
Vector3 axis_turning(const Vector3 &from, const Vector3 &towards)
{
    return from.cross(towards);
}

// A link along `axis`, which is frame_at(angle), whose far end lies at `arm` before the tip.
Element link_element(const LinkCompliance &link, const Frame &axis, Real angle, Real length_mm, const Vector3 &arm)
{
    const Frame ellipsoid = link.tilt_rad == 0.0L ? axis : frame_at(angle + link.tilt_rad);
    Element element;
    element.t.row(kAlong) = force_row(ellipsoid.along);
    element.t.row(kAcross) = force_row(ellipsoid.across);
    element.t.row(kSideways) = force_row(kY);
    element.t.row(kTwist) = moment_row(axis.along, arm);
    element.t.row(kTurnInPlane) = moment_row(axis_turning(axis.along, axis.across), arm);
    element.t.row(kTurnSideways) = moment_row(axis_turning(axis.along, kY), arm);

    element.s.setZero();
    element.s(kAlong, kAlong) = link.axial_mm_per_n;
    element.s(kAcross, kAcross) = link.bending_mm_per_n;
    element.s(kSideways, kSideways) = link.lateral_mm_per_n;
    element.s(kTwist, kTwist) = link.torsion_rad_per_n_mm;
    if (length_mm > 0.0L && link.moment_transfer != 0.0L) {
        const Real per_length = link.moment_transfer / length_mm;
        const auto couple = [&](int shift, int turn, Real bending) {
            element.s(shift, turn) = element.s(turn, shift) = 1.5L * bending * per_length;
            element.s(turn, turn) = 3.0L * bending * per_length / length_mm;
        };
        couple(kAcross, kTurnInPlane, link.bending_mm_per_n);
        couple(kSideways, kTurnSideways, link.lateral_mm_per_n);
    }
    return element;
}

// A spring about one axis through a point; the tip lies at `arm` from that point.
Element hinge_element(Real compliance, const Vector3 &axis, const Vector3 &arm)
{
    Element element;
    element.s.setZero();
    element.t.setZero();
    element.s(kTwist, kTwist) = compliance;
    element.t.row(kTwist) = moment_row(axis, arm);
    return element;
}

Element base_translation(Real x, Real z)
{
    Element element;
    element.s.setZero();
    element.t.setZero();
    element.s(kAlong, kAlong) = x;
    element.s(kAcross, kAcross) = z;
    element.t.row(kAlong) = force_row({1.0L, 0.0L, 0.0L});
    element.t.row(kAcross) = force_row({0.0L, 0.0L, 1.0L});
    return element;
}

} // namespace

std::vector<Element> elements_of(const Limb &limb, const Posture &posture, bool with_coxa)
{
    const Real tibia_angle = posture.theta1_rad - posture.theta2_rad;
    const Frame femur = frame_at(posture.theta1_rad);
    const Frame tibia = frame_at(tibia_angle);
    const Vector3 from_knee = limb.lengths.tibia_mm * tibia.along;
    const Vector3 from_femur_axis = limb.lengths.femur_mm * femur.along + from_knee;
    const Vector3 nothing = Vector3::Zero();
    std::vector<Element> elements{
        base_translation(limb.base_x_mm_per_n, limb.base_z_mm_per_n),
        hinge_element(limb.base_rotation_rad_per_n_mm, kY, from_femur_axis),
        hinge_element(limb.femur_joint_rad_per_n_mm, kY, from_femur_axis),
        hinge_element(limb.tibia_joint_rad_per_n_mm, kY, from_knee),
        link_element(limb.femur, femur, posture.theta1_rad, limb.lengths.femur_mm, from_knee),
        link_element(limb.tibia, tibia, tibia_angle, limb.lengths.tibia_mm, nothing),
    };
    if (with_coxa) {
        const Vector3 from_yaw_axis = from_femur_axis + Vector3(limb.lengths.coxa_mm, 0.0L, 0.0L);
        elements.push_back(hinge_element(limb.coxa_joint_rad_per_n_mm, {0.0L, 0.0L, 1.0L}, from_yaw_axis));
        elements.push_back(link_element(limb.coxa, frame_at(0.0L), 0.0L, limb.lengths.coxa_mm, from_femur_axis));
    }
    return elements;
}

Matrix3 compliance(const std::vector<Element> &elements)
{
    Matrix3 sum = Matrix3::Zero();
    for (const Element &element : elements) {
        Matrix3 part = Matrix3::Zero();
        for (int j = 0; j < 6; ++j) {
            Vector3 column = Vector3::Zero(); // of T' S, which is mostly empty
            for (int i = 0; i < 6; ++i) {
                if (element.s(i, j) != 0.0L) {
                    column += element.t.row(i).transpose() * element.s(i, j);
                }
            }
            if (!column.isZero(0.0L)) {
                part += column * element.t.row(j);
            }
        }
        sum += part;
    }
    return sum;
}

} // namespace brace::reference
