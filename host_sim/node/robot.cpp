#include "node/robot.h"

#include <algorithm>
#include <cmath>

namespace brace::node {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

static_assert(kMostFeet == BRACE_ROBOT_LIMBS);

constexpr double kWeightComes_s = 0.8, kRests_s = 0.4; // before the controllers start
constexpr std::uint64_t kStep_us = 1000;
constexpr std::uint64_t kLog_us = 10000;
constexpr std::size_t kLogRows = 2000;

// A body that has an equilibrium comes near it once nothing moves its limbs and loads; one whose forces are not halfway
// balanced after 75 time constants goes on moving.
constexpr double kUnbalanced = 0.01, kPatience_s = 75.0 * Body::kTau_s;
constexpr double kFar_mm = 150.0, kFar_rad = 0.5; // no limb of some hundred mm holds a body that went so far
constexpr double kGivesWay_s = 0.02; // a limb without a rest for so long lets its foot go

Vector3d vector_of(const double *numbers)
{
    return {numbers[0], numbers[1], numbers[2]};
}

void write(const Vector3d &vector, double *numbers)
{
    Eigen::Map<Vector3d>{numbers} = vector;
}

BodyLoads loads_of(const brace_robot_t &robot)
{
    return {robot.weight_n, vector_of(robot.com_mm), vector_of(robot.down).normalized(), vector_of(robot.payload_n),
            vector_of(robot.payload_at_mm)};
}

std::array<Mount, kMostFeet> mounts_of(const brace_robot_t &robot, const Robot::Limbs &limbs)
{
    std::array<Mount, kMostFeet> mounts;
    for (std::size_t i = 0; i < limbs.size(); ++i) {
        const brace_robot_foot_t &foot = robot.foot[i];
        const Vector3d at_mm = vector_of(foot.mount_mm);
        const Matrix3d turn = Eigen::Map<const Matrix3d>(foot.mount_turn).transpose(); // Eigen has columns first
        mounts[i] = {at_mm,
                     turn,
                     at_mm + turn * limbs[i]->unloaded_tip_mm(),
                     vector_of(foot.foothold_mm),
                     vector_of(foot.normal),
                     foot.friction_ratio,
                     foot.grip_n};
    }
    return mounts;
}

} // namespace

Robot::Robot(const brace_robot_t &robot, const Limbs &limbs)
    : limbs_(limbs), body_(loads_of(robot), mounts_of(robot, limbs), static_cast<int>(limbs.size())), log_(kLogRows)
{
}

void Robot::put_down()
{
    for (int i = 0; i < count(); ++i) {
        limbs_[static_cast<std::size_t>(i)]->limb().stand_at(body_.tip_mm(i), body_.down(i), false);
        limbs_[static_cast<std::size_t>(i)]->move(0.0, LimbNode::kStep_s);
    }
    const int comes = static_cast<int>(kWeightComes_s / LimbNode::kStep_s);
    const int steps = comes + static_cast<int>(kRests_s / LimbNode::kStep_s);
    for (int k = 1; k <= steps; ++k) {
        step(0.0, LimbNode::kStep_s, std::min(1.0, static_cast<double>(k) / comes));
    }
    calm_unbalanced_s_ = 0.0;
    log();
}

void Robot::advance_to(std::uint64_t time_us)
{
    while (now_us_ < time_us) {
        const std::uint64_t next_us = std::min(time_us, now_us_ + kStep_us);
        const double t_s = 1e-6 * static_cast<double>(next_us), dt_s = 1e-6 * static_cast<double>(next_us - now_us_);
        now_us_ = next_us;
        const bool payload_rests = follow_payload(t_s), feet_rest = follow_feet(t_s);
        const bool limbs_rest =
            std::none_of(limbs_.begin(), limbs_.end(), [](const auto &limb) { return limb->setpoints.is_moving(); });
        step(t_s, dt_s, 1.0);
        watch(dt_s, payload_rests && feet_rest && limbs_rest);
        if (now_us_ >= next_log_us_) {
            log();
        }
    }
}

// The body by what the limbs bear; then the motors and limbs, under the body where it then is.
void Robot::step(double t_s, double dt_s, double share)
{
    for (std::size_t i = 0; i < limbs_.size(); ++i) {
        pull_[i] = limbs_[i]->limb().pull();
    }
    body_.step(dt_s, share, factor_, pull_);
    for (int i = 0; i < count(); ++i) {
        LimbNode &limb = *limbs_[static_cast<std::size_t>(i)];
        limb.limb().stand_at(body_.tip_mm(i), body_.down(i), body_.is_off_ground(i));
        limb.move(t_s, dt_s);
    }
}

// ------------------------------------------------------------------------------------------------ what happens

void Robot::add_payload(double at_s, double factor, double ramp_s)
{
    const auto later = std::find_if(payload_.begin() + static_cast<std::ptrdiff_t>(next_payload_), payload_.end(),
                                    [&](const Payload &entry) { return entry.at_s > at_s; });
    payload_.insert(later, {at_s, factor, ramp_s});
}

void Robot::add_release(int limb, double at_s, double for_s)
{
    release_.push_back({limb, at_s, at_s + for_s});
}

// true: the payload stays as it is.
bool Robot::follow_payload(double t_s)
{
    for (; next_payload_ < payload_.size() && payload_[next_payload_].at_s <= t_s; ++next_payload_) {
        current_ = payload_[next_payload_];
        from_factor_ = factor_;
    }
    const double way = current_.ramp_s > 0.0 ? std::min(1.0, (t_s - current_.at_s) / current_.ramp_s) : 1.0;
    const double before = factor_;
    factor_ = from_factor_ + way * (current_.factor - from_factor_);
    return factor_ == before;
}

// Feet that are lost or released; limbs that have given way. true: none has changed.
bool Robot::follow_feet(double t_s)
{
    bool rests = true;
    for (int i = 0; i < count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const bool lost = limbs_[k]->faults.is_on(BRACE_NODE_FAULT_TIP_LOST);
        const bool released = std::any_of(release_.begin(), release_.end(), [&](const Release &entry) {
            return entry.limb == i && t_s >= entry.at_s && t_s < entry.end_s;
        });
        rests = rests && lost == is_lost_[k] && released == is_released_[k];
        if (released != is_released_[k]) {
            body_.release(i, released);
        }
        if (lost != is_lost_[k]) {
            lost ? body_.lift_off(i) : body_.set_down(i);
        }
        is_lost_[k] = lost;
        is_released_[k] = released;
    }
    return rests;
}

void Robot::watch(double dt_s, bool is_calm)
{
    bool is_on_ground = false;
    for (int i = 0; i < count(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        unsolved_s_[k] = limbs_[k]->is_solved() ? 0.0 : unsolved_s_[k] + dt_s;
        if (unsolved_s_[k] > kGivesWay_s) {
            body_.lift_off(i);
        }
        is_on_ground = is_on_ground || !body_.is_off_ground(i);
    }
    calm_unbalanced_s_ += dt_s;
    if (!is_calm || body_.unbalanced() <= kUnbalanced || body_.unbalanced() < 0.5 * last_unbalanced_) {
        calm_unbalanced_s_ = 0.0;
        last_unbalanced_ = body_.unbalanced();
    }
    const bool is_far = body_.moved_mm().norm() > kFar_mm || body_.turned_rad().norm() > kFar_rad;
    if (fallen_s_ < 0.0) {
        if (calm_unbalanced_s_ > kPatience_s || is_far || !is_on_ground) {
            fallen_s_ = 1e-6 * static_cast<double>(now_us_);
            body_.fall();
        } else {
            for (int i = 0; i < count(); ++i) {
                before_fall_[static_cast<std::size_t>(i)] = body_.contact(i);
            }
        }
    }
}

// ------------------------------------------------------------------------------------------------ what is true

brace_robot_truth_t Robot::truth() const
{
    brace_robot_truth_t truth{};
    truth.time_s = 1e-6 * static_cast<double>(now_us_);
    truth.payload_factor = factor_;
    write(body_.moved_mm(), truth.displacement_mm);
    write(body_.turned_rad(), truth.rotation_rad);
    truth.unbalanced_ratio = body_.unbalanced();
    truth.fallen_s = fallen_s_;
    truth.limb_count = count();
    for (int i = 0; i < count(); ++i) {
        brace_robot_foot_truth_t &foot = truth.foot[i];
        write(body_.force_n(i), foot.force_n);
        write(body_.foot_mm(i), foot.foot_mm);
        for (std::size_t joint = 0; joint < 3; ++joint) {
            foot.torque_n_mm[joint] = -limbs_[static_cast<std::size_t>(i)]->motor_torque_n_mm(joint);
        }
        foot.contact = static_cast<std::int32_t>(body_.contact(i));
        foot.contact_before_fall = static_cast<std::int32_t>(before_fall_[static_cast<std::size_t>(i)]);
    }
    return truth;
}

void Robot::log()
{
    next_log_us_ = now_us_ + kLog_us - now_us_ % kLog_us;
    if (log_count_ == log_.size()) {
        log_begin_ = (log_begin_ + 1) % log_.size();
        --log_count_;
    }
    log_[(log_begin_ + log_count_) % log_.size()] = truth();
    ++log_count_;
}

int Robot::read_log(brace_robot_truth_t *rows, int most)
{
    int read = 0;
    for (; read < most && log_count_ > 0; ++read, --log_count_) {
        rows[read] = log_[log_begin_];
        log_begin_ = (log_begin_ + 1) % log_.size();
    }
    return read;
}

} // namespace brace::node
