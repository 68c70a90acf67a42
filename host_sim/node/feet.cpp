#include "node/feet.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace brace::node {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSweeps = 60;
constexpr int kRootSteps = 60;
constexpr double kSettled_n = 1e-10; // a change of force that is less ends the rounds

// A foot that slides from where it presses on the ground with force f and would bear f + m w after a way w: it goes
// against its friction, w_t = -s f_t, so that f_t(s) = (1 + s m_tt)^-1 f_t. s is where f_t is what friction holds.
struct Slide {
    Vector2d side_n;
    double pressing_n; // with grip
    Matrix2d along;
    Vector2d across; // of the normal force by a way along the ground
    double friction_ratio;

    Vector2d side_after_n(double share) const
    {
        // share = s k / (1 + s k) goes from 0 to 1 as s goes to infinity; k is any stiffness
        const double k = 0.5 * along.trace();
        const Matrix2d matrix = (1.0 - share) * k * Matrix2d::Identity() + share * along;
        return (1.0 - share) * k * (matrix.inverse() * side_n);
    }
    Vector2d way_mm(double share) const
    {
        const double k = 0.5 * along.trace();
        const Matrix2d matrix = (1.0 - share) * k * Matrix2d::Identity() + share * along;
        return -share * (matrix.inverse() * side_n);
    }
    // How far the force is outside its cone.
    double outside_n(double share) const
    {
        const double pressing = pressing_n + across.dot(way_mm(share));
        return side_after_n(share).norm() - friction_ratio * pressing;
    }

    // Outside at 0 and inside at 1: regula falsi with halved ends (Illinois).
    double share_on_cone() const
    {
        double low = 0.0, high = 1.0, at_low = outside_n(low), at_high = outside_n(high), share = 1.0;
        int side = 0;
        for (int i = 0; i < kRootSteps && std::fabs(at_low - at_high) > 0.0; ++i) {
            share = std::clamp((low * at_high - high * at_low) / (at_high - at_low), low, high);
            const double at = outside_n(share);
            if (std::fabs(at) < 0.01 * kSettled_n || high - low < 1e-15) {
                break;
            }
            if (at > 0.0) {
                low = share;
                at_low = at;
                at_high *= side > 0 ? 0.5 : 1.0;
                side = 1;
            } else {
                high = share;
                at_high = at;
                at_low *= side < 0 ? 0.5 : 1.0;
                side = -1;
            }
        }
        return share;
    }
};

// The way of a foot that bears force_n while it does not move, and where it then is.
Vector3d way_of(const Foot &foot, const Vector3d &force_n, const Matrix3d &by_way, Contact &contact)
{
    const Vector3d free_mm = -(by_way.inverse() * force_n);
    if (foot.is_gone) {
        contact = Contact::gone;
        return free_mm;
    }
    const Vector3d down_mm(-foot.gap_mm, 0.0, 0.0);
    const Vector3d pressed_n = force_n + by_way * down_mm;
    const double grip_n = foot.gap_mm > 0.0 ? 0.0 : foot.grip_n; // it grips where it stands
    const double pressing_n = pressed_n.x() + grip_n;
    const Vector2d side_n = pressed_n.tail<2>();
    if (pressing_n > 0.0 && side_n.norm() <= foot.friction_ratio * pressing_n) {
        contact = Contact::sticks;
        return down_mm;
    }
    const Slide slide{side_n, pressing_n, by_way.bottomRightCorner<2, 2>(), by_way.row(0).tail<2>().transpose(),
                      foot.friction_ratio};
    const double pressing_without_side_n = pressing_n - slide.across.dot(slide.along.inverse() * side_n);
    if (!(pressing_without_side_n > 0.0)) {
        contact = Contact::open;
        return free_mm;
    }
    contact = Contact::slides;
    const Vector2d along_mm = slide.way_mm(slide.share_on_cone());
    return {down_mm.x(), along_mm.x(), along_mm.y()};
}

} // namespace

bool find_ways(std::array<Foot, kMostFeet> &foot, int count, const ByWays &by_ways_n_per_mm)
{
    for (int i = 0; i < count; ++i) {
        foot[static_cast<std::size_t>(i)].way_mm.setZero();
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        double changed_n = 0.0;
        for (int i = 0; i < count; ++i) {
            Foot &one = foot[static_cast<std::size_t>(i)];
            const Matrix3d own = by_ways_n_per_mm.block<3, 3>(3 * i, 3 * i);
            const Vector3d standing_n = one.force_n - own * one.way_mm;
            const Vector3d way_mm = way_of(one, standing_n, own + one.drag_n_per_mm, one.contact);
            const Vector3d more_mm = way_mm - one.way_mm;
            if (more_mm.isZero(0.0)) {
                continue;
            }
            one.way_mm = way_mm;
            changed_n = std::max(changed_n, (own * more_mm).norm());
            for (int j = 0; j < count; ++j) {
                foot[static_cast<std::size_t>(j)].force_n += by_ways_n_per_mm.block<3, 3>(3 * j, 3 * i) * more_mm;
            }
        }
        if (changed_n <= kSettled_n) {
            return true;
        }
    }
    return false;
}

} // namespace brace::node
