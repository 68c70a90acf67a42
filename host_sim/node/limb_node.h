// One controller and its limb: firmware/app with hal/posix, and simulated joints and sensors.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "node/drive.h"
#include "node/pressed_limb.h"
#include "node/script.h"
#include "node/servo_joints.h"
#include "rig/noise.h"

extern "C" {
#include "brace_hal_posix.h"
}

namespace brace::node {

class LimbNode {
public:
    LimbNode(const brace_node_limb_t &limb, std::uint64_t seed);
    ~LimbNode();
    LimbNode(const LimbNode &) = delete;
    LimbNode &operator=(const LimbNode &) = delete;

    // Opens ports and memory, stores the block. bus may be null.
    brace_node_failure_t open(const brace_node_limb_t &limb, brace_posix_bus_t *bus);
    // The tip is held where limb.press has it, and the motors come to rest. false: nothing yields in some direction.
    bool stand_alone(const brace_node_limb_t &limb);
    // The limb of a body: whoever calls move() says where the tip is held. false: as above.
    bool stand_on_body();
    void start(); // the controller

    std::uint64_t due_us() const { return due_us_; }
    void tick(std::uint64_t now_us); // advances limb (unless it is a body's) and controller from the last tick to now
    void poll();
    void restart(brace_reset_cause_t cause);

    void hold(double hold_n_per_mm, const brace_node_press_t &press);
    bool has_coxa_joint() const { return has_coxa_joint_; }

    // One step of a limb of a body, dt_s at most kStep_s, its tip where stand_at() has it.
    static constexpr double kStep_s = 1e-3; // longest step of the motors
    void move(double t_s, double dt_s);
    PressedLimb &limb() { return limb_; }
    Eigen::Vector3d unloaded_tip_mm() const { return limb_.unloaded_tip_mm(motors_rad()); }
    bool is_solved() const { return pressed_.solved; }
    double motor_torque_n_mm(std::size_t joint) const { return motor_[joint].torque_n_mm; }

    Setpoints setpoints;
    Faults faults;

    const brace_dynamixel_t *servos() const { return servos_.is_open() ? &servos_.driver() : nullptr; }
    brace_app_t &app() { return *app_; }
    const brace_posix_t &posix() const { return posix_; }
    brace_node_truth_t truth() const;
    std::uint64_t ticks() const { return ticks_; }
    std::uint32_t watchdog_resets() const { return watchdog_resets_; }

private:
    struct Command {
        double offset_rad = 0.0;
        double limit_n_mm = 0.0;
        std::uint64_t since_us = 0;
        bool given = false;
    };

    static std::int32_t joint_read(void *context, std::int32_t joint_index, brace_hal_joint_t *joint);
    static std::int32_t joint_command(void *context, std::int32_t joint_index,
                                      const brace_hal_joint_command_t *command);
    static std::int32_t tip_force_read(void *context, float *force_x_n, float *force_z_n);

    bool store_block(const brace_node_limb_t &limb, bool memory_is_new, brace_node_failure_t &failure);
    void follow_faults();
    void move_limb(double t_s, double dt_s);
    void take_hold(double hold_n_per_mm, const brace_node_press_t &press);
    void sample();
    void serve_servos(std::uint64_t from_us);
    void follow_command(std::size_t joint, double dt_s);
    bool is_fitted(std::int32_t joint_index) const;
    Eigen::Vector3d motors_rad() const { return {motor_[0].angle_rad, motor_[1].angle_rad, motor_[2].angle_rad}; }
    double set_rad(std::size_t joint) const;
    bool is_by_simulated_servo(std::size_t joint) const;
    double now_s() const { return 1e-6 * static_cast<double>(now_us_); }
    double temp_degc(double t_s) const;

    const brace_plant_model_t plant_;
    const std::array<brace_node_drive_t, 3> drive_;
    const double force_noise_n_, temp_start_degc_, temp_rise_degc_, temp_time_constant_s_;
    const bool has_link_encoder_, has_coxa_joint_;
    double hold_n_per_mm_;
    rig::Noise noise_;
    PressedLimb limb_;
    Pressed pressed_;
    ServoJoints servos_;
    std::array<Motor, 3> motor_; // coxa, femur, tibia, as everything per joint here
    std::array<Command, 3> command_;
    std::array<brace_hal_joint_t, 3> sample_{};
    std::array<float, 2> force_sample_n_{};
    bool tip_was_lost_ = false, has_crashed_ = false, is_on_body_ = false;

    std::uint64_t now_us_ = 0, due_us_ = 0, ticks_ = 0;
    std::uint32_t watchdog_resets_ = 0;
    brace_posix_t posix_;
    brace_hal_t hal_;
    std::unique_ptr<brace_app_t> app_;
};

} // namespace brace::node
