#include "node/body.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace brace::node {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Levers = Eigen::Matrix<double, 3, 6>; // how a point of the body moves with it

constexpr double kDrag = 1.0;             // of a foot that moves, in its limb's stiffness
constexpr double kAlone = 0.1;            // share of D that is there in directions in which no foot holds the body
constexpr double kMostMove_mm = 2.0;      // of the body in one step
constexpr double kMostTurn_rad = 0.01;
constexpr double kRounding_mm = 1e-12; // a body that moves less rests
constexpr double kOnTheGround_mm = 1e-9;  // a gap that is less is rounding

Matrix3d crossed(const Vector3d &a)
{
    Matrix3d result;
    result << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return result;
}

Matrix3d frame_of(const Vector3d &normal)
{
    Matrix3d frame;
    frame.col(0) = normal.normalized();
    frame.col(1) = frame.col(0).unitOrthogonal();
    frame.col(2) = frame.col(0).cross(frame.col(1));
    return frame;
}

Vector6 wrench(const Vector3d &force_n, const Vector3d &arm_mm)
{
    Vector6 result;
    result << force_n, arm_mm.cross(force_n);
    return result;
}

} // namespace

Body::Body(const BodyLoads &loads, const std::array<Mount, kMostFeet> &mount, int count) : loads_(loads), count_(count)
{
    Vector3d middle = Vector3d::Zero();
    for (int i = 0; i < count; ++i) {
        const Mount &one = mount[static_cast<std::size_t>(i)];
        at(i) = {one, frame_of(one.normal), one.tip_mm, one.tip_mm, Vector3d::Zero(), false, false, Contact::sticks};
        middle += one.tip_mm / count;
    }
    for (int i = 0; i < count; ++i) {
        lever_mm_ += (at(i).place_mm - middle).squaredNorm() / count;
    }
    lever_mm_ = std::max(std::sqrt(lever_mm_), 1.0);
}

double Body::gap_mm(const Standing &foot) const
{
    const double gap = foot.ground.col(0).dot(foot.place_mm - foot.under_mm);
    return std::fabs(gap) <= kOnTheGround_mm ? 0.0 : gap;
}

bool Body::is_off_ground(int limb) const
{
    const Contact contact = at(limb).contact;
    return contact == Contact::open || contact == Contact::gone;
}

void Body::release(int limb, bool released)
{
    Standing &foot = at(limb);
    if (foot.is_released != released) {
        foot.is_released = released;
        foot.is_gone = has_fallen_;
    }
}

void Body::fall()
{
    has_fallen_ = true;
    for (int i = 0; i < count_; ++i) {
        lift_off(i);
    }
}

Vector3d Body::tip_mm(int limb) const
{
    const Standing &foot = at(limb);
    const Vector3d in_body = turned_.transpose() * (foot.place_mm - moved_mm_);
    return foot.mount.turn.transpose() * (in_body - foot.mount.at_mm);
}

Vector3d Body::down(int limb) const
{
    return at(limb).mount.turn.transpose() * (turned_.transpose() * loads_.down);
}

Vector3d Body::force_n(int limb) const
{
    return turned_.transpose() * at(limb).force_n;
}

Vector3d Body::turned_rad() const
{
    const Eigen::AngleAxisd turn(turned_);
    return turn.angle() * turn.axis();
}

// A body on fewer feet than hold it is not let go without any resistance.
void Body::set_viscosity(const Matrix6 &stiffness)
{
    Vector6 alone;
    alone << Vector3d::Constant(stiffness.diagonal().head<3>().mean()),
        Vector3d::Constant(stiffness.diagonal().tail<3>().mean());
    viscosity_ = kTau_s * stiffness;
    viscosity_.diagonal() += kTau_s * kAlone * alone;
    has_viscosity_ = true;
}

void Body::take_foot(Standing &foot, const Foot &found)
{
    const bool lets_go = found.contact == Contact::open && found.grip_n > 0.0 && found.gap_mm == 0.0;
    foot.is_gone = foot.is_gone || lets_go;
    foot.contact = lets_go ? Contact::gone : found.contact;
    foot.place_mm += foot.ground * found.way_mm;
}

void Body::step(double dt_s, double share, double payload_factor, const std::array<Pull, kMostFeet> &pull)
{
    std::array<Foot, kMostFeet> foot;
    std::array<Eigen::Matrix<double, 3, 6>, kMostFeet> by_move; // force by the body's move
    const Vector3d weight_n = share * loads_.weight_n * loads_.down, payload_n = payload_factor * loads_.payload_n;
    Vector6 unbalanced = wrench(weight_n, turned_ * loads_.com_mm) + wrench(payload_n, turned_ * loads_.payload_at_mm);
    double acting_n = weight_n.norm() + payload_n.norm();
    Matrix6 stiffness = Matrix6::Zero();
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        Standing &one = at(i);
        const Matrix3d turn = turned_ * one.mount.turn;
        const Vector3d mount_mm = turned_ * one.mount.at_mm;
        const Vector3d dragged_mm = (share - share_) * (one.mount.foothold_mm - one.mount.tip_mm);
        one.under_mm += dragged_mm;
        if (is_off_ground(i)) {
            one.place_mm = moved_mm_ + mount_mm + turn * pull[k].tip_mm;
        } else {
            one.place_mm += dragged_mm;
        }
        one.force_n = turn * pull[k].force_n;
        const Vector3d carried_n = turn * pull[k].carried_n;
        unbalanced += wrench(carried_n, mount_mm);
        unbalanced.tail<3>() += turn * pull[k].carried_n_mm;
        acting_n += (carried_n - one.force_n).norm();

        Levers levers;
        levers << Matrix3d::Identity(), -crossed(one.place_mm - moved_mm_);
        const Matrix3d k_world = turn * pull[k].stiffness_n_per_mm * turn.transpose();
        by_move[k] = one.ground.transpose() * k_world * levers;
        stiffness += levers.transpose() * k_world * levers;
        foot[k] = {one.mount.friction_ratio,
                   one.is_released ? 0.0 : one.mount.grip_n,
                   gap_mm(one),
                   one.is_gone,
                   one.ground.transpose() * one.force_n,
                   kDrag * one.ground.transpose() * k_world * one.ground,
                   Vector3d::Zero(),
                   Contact::sticks};
    }
    share_ = share;
    unbalanced_ =
        std::max(unbalanced.head<3>().norm(), unbalanced.tail<3>().norm() / lever_mm_) / std::max(acting_n, 1e-9);
    if (!has_viscosity_) {
        set_viscosity(stiffness);
    }
    if (has_fallen_) {
        unbalanced.setZero();
        stiffness *= 1e6;
    }
    const Eigen::LDLT<Matrix6> resists(Matrix6(viscosity_ / dt_s + stiffness));
    const Vector6 move_alone = resists.solve(unbalanced);
    ByWays by_ways;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        foot[k].force_n -= by_move[k] * move_alone;
        const Eigen::Matrix<double, 6, 3> moved = resists.solve(by_move[k].transpose());
        for (int j = 0; j < count_; ++j) {
            by_ways.block<3, 3>(3 * j, 3 * i) = -by_move[static_cast<std::size_t>(j)] * moved;
        }
        by_ways.block<3, 3>(3 * i, 3 * i) += foot[k].drag_n_per_mm / kDrag;
    }
    (void)find_ways(foot, count_, by_ways);
    Vector6 pushed = unbalanced;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        pushed += by_move[k].transpose() * foot[k].way_mm;
        take_foot(at(i), foot[k]);
    }
    Vector6 move = resists.solve(pushed);
    move *= std::min({1.0, kMostMove_mm / std::max(move.head<3>().norm(), 1e-300),
                      kMostTurn_rad / std::max(move.tail<3>().norm(), 1e-300)});
    if (has_fallen_ || (move.head<3>().norm() < kRounding_mm && move.tail<3>().norm() * lever_mm_ < kRounding_mm)) {
        return; // the limbs find the rest that they know
    }
    moved_mm_ += move.head<3>();
    const Vector3d turn_rad = move.tail<3>();
    if (const double angle_rad = turn_rad.norm(); angle_rad > 0.0) {
        turned_ = Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad).toRotationMatrix() * turned_;
        turned_ = Eigen::Quaterniond(turned_).normalized().toRotationMatrix(); // rounding adds up
    }
}

} // namespace brace::node
