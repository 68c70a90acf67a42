#include "node/servo_joints.h"

#include <cmath>
#include <cstring>

namespace brace::node {
namespace {

constexpr double kMiddle_rad = 3.14159265358979323846; // where a servo reads 2048
constexpr std::uint32_t kBaud = 3'000'000;
constexpr std::uint16_t kModel = 321;         // MX-106, the paper's
constexpr double kTorque_n_mm_per_a = 1615.0; // of the true motor, which the manual states correctly
constexpr std::uint16_t kTorqueEnable = 64, kGoalPosition = 116;
constexpr std::uint32_t kAnswers_us = 700;   // on a line of a controller
constexpr std::uint32_t kAdapter_us = 30000; // through a USB adapter that waits 16 ms before it hands bytes over

} // namespace

ServoJoints::~ServoJoints()
{
    if (is_open_ && !simulated_) {
        brace_posix_stream_close(&stream_);
    }
}

std::int32_t ServoJoints::open(const brace_node_limb_t &limb, bool has_coxa_joint)
{
    const bool is_simulated = std::strcmp(limb.servos, "sim") == 0;
    brace_servo_setup_t setup{};
    setup.period_us = is_simulated ? 500 : 1000;
    setup.timeout_us = is_simulated ? kAnswers_us : kAdapter_us;
    setup.holds = is_simulated || limb.servos_hold != 0;
    if (is_simulated) {
        simulated_.reset(brace_servos_create(kBaud, 0));
    } else if (const std::int32_t status = brace_posix_stream_open(&stream_, limb.servos); status != BRACE_POSIX_OK) {
        return status;
    }
    is_open_ = true;
    for (std::size_t i = 0; i < index_.size(); ++i) {
        const bool is_fitted = i > 0 || has_coxa_joint;
        zero_rad_[i] = is_simulated ? limb.theta_rad[i] : 0.0; // a real servo's zero is a parameter: zero_offset_rad
        setup.joint[i] = {is_fitted ? limb.servo_id[i] : static_cast<std::uint8_t>(BRACE_SERVO_NO_ID), false,
                          static_cast<float>(zero_rad_[i]), 1.0f};
        if (is_simulated && is_fitted) { // they hold already when the controller starts
            index_[i] = brace_servos_add(simulated_.get(), limb.servo_id[i], kModel);
            brace_servos_poke(simulated_.get(), index_[i], kGoalPosition, 4, 2048);
            brace_servos_poke(simulated_.get(), index_[i], kTorqueEnable, 1, 1);
        }
    }
    const brace_servo_line_t line = {this, send, receive};
    return brace_dynamixel_start(&driver_, &setup, &line) == BRACE_HAL_OK ? BRACE_POSIX_OK : BRACE_POSIX_E_URL;
}

void ServoJoints::serve(std::uint64_t now_us)
{
    now_us_ = now_us;
    brace_dynamixel_serve(&driver_, static_cast<std::uint32_t>(now_us));
}

std::int32_t ServoJoints::send(void *context, const std::uint8_t *bytes, std::uint32_t count)
{
    ServoJoints &joints = *static_cast<ServoJoints *>(context);
    if (joints.simulated_) {
        brace_servos_hear(joints.simulated_.get(), 1000 * joints.now_us_, bytes, count);
        return BRACE_HAL_OK;
    }
    const std::int32_t sent = brace_posix_stream_write(&joints.stream_, bytes, count);
    return sent == static_cast<std::int32_t>(count) ? BRACE_HAL_OK : sent < 0 ? sent : BRACE_HAL_AGAIN;
}

std::int32_t ServoJoints::receive(void *context, std::uint8_t *bytes, std::uint32_t room)
{
    ServoJoints &joints = *static_cast<ServoJoints *>(context);
    return joints.simulated_ ? static_cast<std::int32_t>(
               brace_servos_give(joints.simulated_.get(), 1000 * joints.now_us_, bytes, room))
                             : brace_posix_stream_read(&joints.stream_, bytes, room);
}

std::int32_t ServoJoints::read(std::int32_t joint, brace_hal_joint_t *sample)
{
    return brace_dynamixel_read(&driver_, joint, sample);
}

std::int32_t ServoJoints::command(std::int32_t joint, const brace_hal_joint_command_t *command)
{
    return brace_dynamixel_command(&driver_, joint, command);
}

void ServoJoints::move(std::size_t joint, double angle_rad)
{
    (void)brace_dynamixel_move(&driver_, static_cast<std::int32_t>(joint), static_cast<float>(angle_rad));
}

void ServoJoints::shaft(std::size_t joint, double link_rad, double speed_rad_per_s, double torque_n_mm,
                        double temp_degc)
{
    brace_servos_shaft(simulated_.get(), index_[joint], link_rad - zero_rad_[joint] + kMiddle_rad, speed_rad_per_s,
                       torque_n_mm / kTorque_n_mm_per_a, temp_degc);
}

void ServoJoints::goal(std::size_t joint, double &set_rad, double &limit_n_mm) const
{
    double goal_rad = 0.0, current_a = 0.0;
    limit_n_mm = 0.0;
    if (brace_servos_goal(simulated_.get(), index_[joint], &goal_rad, &current_a) != 0) {
        set_rad = goal_rad - kMiddle_rad + zero_rad_[joint];
        limit_n_mm = current_a * kTorque_n_mm_per_a;
    }
}

} // namespace brace::node
