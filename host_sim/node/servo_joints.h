// A limb's joints by servos on a serial line, through the driver that boards use: simulated servos in this process, or
// real ones at a device.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

extern "C" {
#include "api/brace_node.h"
#include "api/brace_servos.h"
#include "brace_dynamixel.h"
#include "brace_hal_posix.h"
}

namespace brace::node {

class ServoJoints {
public:
    ServoJoints() = default;
    ~ServoJoints();
    ServoJoints(const ServoJoints &) = delete;
    ServoJoints &operator=(const ServoJoints &) = delete;

    // Opens the line. limb.servos: "sim", or a device with its baud rate. A BRACE_POSIX_E_... or 0.
    std::int32_t open(const brace_node_limb_t &limb, bool has_coxa_joint);
    bool is_open() const { return is_open_; }
    bool is_simulated() const { return simulated_ != nullptr; }

    // Between two ticks: exchanges bytes.
    void serve(std::uint64_t now_us);

    std::int32_t read(std::int32_t joint, brace_hal_joint_t *sample);
    std::int32_t command(std::int32_t joint, const brace_hal_joint_command_t *command);
    void move(std::size_t joint, double angle_rad);
    const brace_dynamixel_t &driver() const { return driver_; }

    // Of simulated servos: what the limb does to a shaft, and where the servo's firmware wants it. limit_n_mm is 0
    // while the torque is off.
    void shaft(std::size_t joint, double link_rad, double speed_rad_per_s, double torque_n_mm, double temp_degc);
    void goal(std::size_t joint, double &set_rad, double &limit_n_mm) const;

private:
    static std::int32_t send(void *context, const std::uint8_t *bytes, std::uint32_t count);
    static std::int32_t receive(void *context, std::uint8_t *bytes, std::uint32_t room);

    bool is_open_ = false;
    std::uint64_t now_us_ = 0;
    std::array<std::int32_t, 3> index_{-1, -1, -1}; // of the simulated servo
    std::array<double, 3> zero_rad_{};
    std::unique_ptr<brace_servos_t, void (*)(brace_servos_t *)> simulated_{nullptr, brace_servos_destroy};
    brace_posix_stream_t stream_{};
    brace_dynamixel_t driver_{};
};

} // namespace brace::node
