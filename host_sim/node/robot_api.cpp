// The C interface of a robot: brace_robot.h.
#include <Eigen/Core>
#include <cmath>

#include "node/node.h"

using brace::node::in_range;
using brace::node::Robot;

namespace {

constexpr double kFar_mm = 1e4, kMost_n = 1e6;
constexpr double kOffTheRotation = 1e-6; // of a turn's columns, from unit vectors at right angles

bool is_within(const double numbers[3], double most)
{
    return in_range(numbers[0], -most, most) && in_range(numbers[1], -most, most) && in_range(numbers[2], -most, most);
}

bool has_direction(const double numbers[3])
{
    return is_within(numbers, 1e6) && std::hypot(numbers[0], numbers[1], numbers[2]) > 1e-9;
}

bool is_rotation(const double turn[9])
{
    const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix3d>(turn);
    return matrix.allFinite() && (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).norm() < kOffTheRotation
           && matrix.determinant() > 0.0;
}

bool is_sound(const brace_robot_t &robot, std::int32_t count)
{
    bool sound = count > 0 && count <= BRACE_ROBOT_LIMBS && in_range(robot.weight_n, 0.0, kMost_n)
                 && is_within(robot.com_mm, kFar_mm) && has_direction(robot.down) && is_within(robot.payload_n, kMost_n)
                 && is_within(robot.payload_at_mm, kFar_mm);
    for (std::int32_t i = 0; sound && i < count; ++i) {
        const brace_robot_foot_t &foot = robot.foot[i];
        sound = is_within(foot.mount_mm, kFar_mm) && is_rotation(foot.mount_turn)
                && is_within(foot.foothold_mm, kFar_mm) && has_direction(foot.normal)
                && in_range(foot.friction_ratio, 0.0, 10.0) && in_range(foot.grip_n, 0.0, kMost_n);
    }
    return sound;
}

bool is_robot(const brace_node_t *node)
{
    return node != nullptr && node->robot;
}

} // namespace

extern "C" brace_node_t *brace_robot_create(const brace_node_limb_t *limbs, int32_t count, const brace_robot_t *robot,
                                            const char *can, uint64_t seed, brace_node_failure_t *failure)
{
    if (robot == nullptr || !is_sound(*robot, count)) {
        if (failure != nullptr) {
            *failure = {BRACE_NODE_PART_LIMB, BRACE_HOST_E_RANGE, 0, 0};
        }
        return nullptr;
    }
    return brace::node::make_node(limbs, count, robot, can, seed, failure);
}

extern "C" int32_t brace_robot_payload(brace_node_t *node, double at_s, double factor, double ramp_s)
{
    if (!is_robot(node) || !std::isfinite(at_s) || !in_range(factor, -1e3, 1e3) || !in_range(ramp_s, 0.0, 1e6)) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    node->robot->add_payload(at_s, factor, ramp_s);
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_robot_set_points(brace_node_t *node, int32_t limb, double at_s, const double theta_rad[3])
{
    if (!is_robot(node) || node->limb(limb) == nullptr || !std::isfinite(at_s) || !is_within(theta_rad, 7.9)) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    node->limb(limb)->setpoints.add(at_s, {theta_rad[0], theta_rad[1], theta_rad[2]});
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_robot_release(brace_node_t *node, int32_t limb, double at_s, double for_s)
{
    if (!is_robot(node) || node->limb(limb) == nullptr || !(at_s >= 0.0) || !(for_s >= 0.0)) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    node->robot->add_release(limb, at_s, for_s);
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_robot_truth(brace_node_t *node, brace_robot_truth_t *truth)
{
    if (!is_robot(node) || truth == nullptr) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    *truth = node->robot->truth();
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_robot_log(brace_node_t *node, brace_robot_truth_t *rows, int32_t most)
{
    if (!is_robot(node) || rows == nullptr || most < 0) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    return node->robot->read_log(rows, most);
}
