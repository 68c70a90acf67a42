#include "plant/condensed.h"

#include <algorithm>
#include <cmath>

namespace brace::plant {
namespace {

using Eigen::Vector2d;

Vector2d quarter_turn(const Vector2d &v)
{
    return {-v.y(), v.x()};
}

// A body's turn, from half its angle: what a small turn moves keeps all its digits.
struct Turn {
    explicit Turn(double angle_rad)
    {
        const double half_sin = std::sin(0.5 * angle_rad);
        sin = 2.0 * half_sin * std::cos(0.5 * angle_rad);
        versine = 2.0 * half_sin * half_sin;
    }

    Vector2d moved(const Vector2d &v) const { return sin * quarter_turn(v) - versine * v; }

    double sin, versine; // 1 - cos
};

// What a body yields, seen from the robot.
struct Yielding {
    Yielding(const Body &body, const Turn &turn)
    {
        const double cos_2 = 1.0 - 2.0 * turn.sin * turn.sin;
        const double sin_2 = 2.0 * turn.sin * (1.0 - turn.versine);
        const Vector2d &d = body.deviation_mm_per_n;
        const double deviation = d.x() * cos_2 - d.y() * sin_2;
        xx = body.mean_mm_per_n + deviation;
        xz = d.x() * sin_2 + d.y() * cos_2;
        zz = body.mean_mm_per_n - deviation;
    }

    Vector2d stretch_mm(const Vector2d &force_n) const
    {
        return {xx * force_n.x() + xz * force_n.y(), xz * force_n.x() + zz * force_n.y()};
    }

    double xx, xz, zz;
};

void add_square(Eigen::Matrix2d &sum, double factor, double x, double z)
{
    sum(0, 0) += factor * x * x;
    sum(0, 1) += factor * x * z;
    sum(1, 1) += factor * z * z;
}

} // namespace

void Condensed::about(const Structure &structure, const std::array<JointHinge, 2> &joint, const Shape &shape)
{
    count_ = structure.body_count;
    const auto count = static_cast<std::size_t>(count_);
    double angle_rad = 0.0; // of the present body
    for (std::size_t i = 0; i < count; ++i) {
        angle_rad += shape.turn_rad[i];
    }

    Vector2d tip_mm = Vector2d::Zero();
    Eigen::Matrix2d compliance_mm_per_n = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d torque_n_mm_per_rad = Eigen::Matrix2d::Zero();
    std::array<Vector2d, 2> lever_mm{Vector2d::Zero(), Vector2d::Zero()};
    std::array<double, 2> torques_n_mm{};
    int negative_pivots = 0;
    Vector2d force_n = shape.force_n; // that acts beyond where we are
    double curvature = 0.0;           // W_phiphi
    Vector2d lever = Vector2d::Zero();
    std::array<double, 2> by_turn{};
    double torque_n_mm = 0.0;
    for (std::size_t i = count; i-- > 0;) {
        const Body &body = structure.body[i];
        const Turn turn(angle_rad);
        const auto let_yield = [&]() __attribute__((always_inline)) {
            const Yielding spring(body, turn);
            const Vector2d turned_force = quarter_turn(force_n);
            const Vector2d stretch = spring.stretch_mm(force_n);
            const Vector2d by_turned = spring.stretch_mm(turned_force);
            compliance_mm_per_n(0, 0) += spring.xx;
            compliance_mm_per_n(0, 1) += spring.xz;
            compliance_mm_per_n(1, 1) += spring.zz;
            curvature += turned_force.dot(by_turned) - stretch.dot(force_n);
            lever += quarter_turn(stretch) - by_turned;
            torque_n_mm += quarter_turn(stretch).dot(force_n);
            tip_mm += stretch;
        };
        force_n += body.end_weight_n * structure.down;
        if (body.yields == Yields::at_end) {
            let_yield();
        }
        const Vector2d moved = turn.moved(body.extent_mm);
        const Vector2d extent = body.extent_mm + moved;
        tip_mm += moved;
        lever += quarter_turn(extent);
        curvature -= extent.dot(force_n);
        torque_n_mm += quarter_turn(extent).dot(force_n);
        if (body.weight_n != 0.0) {
            const Vector2d arm = body.weight_arm_mm + turn.moved(body.weight_arm_mm);
            curvature -= body.weight_n * arm.dot(structure.down);
            torque_n_mm += body.weight_n * (arm.x() * structure.down.y() - arm.y() * structure.down.x());
            force_n += body.weight_n * structure.down;
        }
        if (body.yields == Yields::at_root) {
            let_yield();
        }

        const bool is_joint = body.joint != kElastic;
        const auto k = static_cast<std::size_t>(is_joint ? body.joint : 0);
        const double compliance = is_joint ? joint[k].compliance_rad_per_n_mm : body.hinge_rad_per_n_mm;
        const double strained_rad = shape.turn_rad[i] - (is_joint ? joint[k].unstrained_rad : 0.0);
        const double load_n_mm = is_joint ? structure.joint_load_n_mm[body.joint] : 0.0;
        const double pivot = 1.0 - compliance * curvature;
        const double per_pivot = 1.0 / pivot;
        Hinge &hinge = hinge_[i];
        hinge = {body.joint,
                 curvature,
                 lever,
                 by_turn,
                 torque_n_mm + load_n_mm,
                 compliance * per_pivot,
                 (compliance * (torque_n_mm + load_n_mm) - strained_rad) * per_pivot};
        negative_pivots += pivot < 0.0 ? 1 : 0;
        add_square(compliance_mm_per_n, hinge.turn_per_torque, lever.x(), lever.y());
        add_square(torque_n_mm_per_rad, hinge.turn_per_torque, by_turn[0], by_turn[1]);
        for (const std::size_t j : {0, 1}) {
            lever_mm[j] += hinge.turn_per_torque * by_turn[j] * lever;
            torques_n_mm[j] += hinge.lacks_rad * by_turn[j];
            by_turn[j] *= per_pivot;
        }
        tip_mm += hinge.lacks_rad * lever;
        torque_n_mm += hinge.lacks_rad * curvature;
        lever *= per_pivot;
        curvature *= per_pivot;
        if (is_joint) {
            lever_mm[k] += lever;
            torques_n_mm[k] += torque_n_mm + load_n_mm;
            torque_n_mm_per_rad(body.joint, body.joint) += curvature;
            torque_n_mm_per_rad(0, 1) += by_turn[1 - k];
            by_turn[k] += curvature;
        }
        angle_rad -= shape.turn_rad[i];
    }
    compliance_mm_per_n.diagonal() += structure.base_mm_per_n;
    compliance_mm_per_n(1, 0) = compliance_mm_per_n(0, 1);
    torque_n_mm_per_rad(1, 0) = torque_n_mm_per_rad(0, 1);
    tip_mm += structure.base_mm_per_n.cwiseProduct(force_n);
    tip_mm_ = tip_mm;
    compliance_mm_per_n_ = compliance_mm_per_n;
    torque_n_mm_per_rad_ = torque_n_mm_per_rad;
    lever_mm_ = lever_mm;
    torque_n_mm_ = torques_n_mm;
    negative_pivots_ = negative_pivots;
}

double Condensed::follow(const Change<2> &change, Shape &shape, std::array<double, 2> &torque_n_mm) const
{
    double turned_rad = 0.0; // the present body
    double most_rad = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
        const Hinge &hinge = hinge_[i];
        const auto k = static_cast<std::size_t>(hinge.joint);
        const bool is_joint = hinge.joint != kElastic;
        const double kept_rad = is_joint ? change.turn_rad[k] : 0.0;
        turned_rad += kept_rad;
        const double more_n_mm = hinge.lever_mm.dot(change.force_n) + hinge.by_turn_n_mm_per_rad[0] * change.turn_rad[0]
                                 + hinge.by_turn_n_mm_per_rad[1] * change.turn_rad[1];
        const double sprung_rad =
            hinge.lacks_rad + hinge.turn_per_torque * (more_n_mm + hinge.curvature_n_mm_per_rad * turned_rad);
        turned_rad += sprung_rad;
        shape.turn_rad[i] += kept_rad + sprung_rad;
        if (is_joint) {
            torque_n_mm[k] = hinge.torque_n_mm + more_n_mm + hinge.curvature_n_mm_per_rad * turned_rad;
        }
        most_rad = std::max(most_rad, std::fabs(turned_rad));
    }
    shape.force_n += change.force_n;
    return most_rad;
}

} // namespace brace::plant
