#include "node/limb_node.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "plant/sensor.h"

extern "C" {
#include "brace/app_memory.h"
#include "brace/store.h"
}

namespace brace::node {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSettleSteps = 1000;                 // before the controller starts
constexpr std::uint64_t kCommandHolds_us = 100000; // brace_hal.h, joint_command
constexpr double kCommandFades_rad_per_s = 0.1;
constexpr std::uint32_t kPatience_us = 4000000; // time that the watchdog waits
constexpr double kDefaultLate_ms = 5.0;
constexpr int kStoreSteps = 100000;

constexpr const char *kNone = "none";

constexpr std::uint64_t kServe_us = 250; // between two looks at the servos' line

bool has_real_servos(const brace_node_limb_t &limb)
{
    return limb.servos != nullptr && std::strcmp(limb.servos, "sim") != 0;
}

const char *url_or_none(const char *url)
{
    return url != nullptr ? url : kNone;
}

} // namespace

LimbNode::LimbNode(const brace_node_limb_t &limb, std::uint64_t seed)
    : plant_(limb.plant), drive_{limb.drive[0], limb.drive[1], limb.drive[2]}, force_noise_n_(limb.force_noise_n),
      temp_start_degc_(limb.temp_start_degc), temp_rise_degc_(limb.temp_rise_degc),
      temp_time_constant_s_(limb.temp_time_constant_s), has_link_encoder_(limb.has_link_encoder != 0),
      has_coxa_joint_(node::has_coxa_joint(limb.plant)), hold_n_per_mm_(limb.hold_n_per_mm), noise_(seed),
      limb_(plant_), app_(std::make_unique<brace_app_t>())
{
    setpoints.start({limb.theta_rad[0], limb.theta_rad[1], limb.theta_rad[2]});
    for (std::size_t i = 0; i < motor_.size(); ++i) {
        motor_[i].angle_rad = limb.theta_rad[i];
        motor_[i].limit_n_mm = drive_[i].torque_range_n_mm;
    }
    brace_posix_init(&posix_);
    posix_.time_is_given = true;
    posix_.limb = {this, joint_read, joint_command,
                   limb.has_force_sensor != 0 && !has_real_servos(limb) ? tip_force_read : nullptr};
}

LimbNode::~LimbNode()
{
    brace_posix_close(&posix_);
}

// -------------------------------------------------------------------------------------------- starting up

brace_node_failure_t LimbNode::open(const brace_node_limb_t &limb, brace_posix_bus_t *bus)
{
    brace_node_failure_t failure{};
    const auto refuse = [&failure](brace_node_part_t part, std::int32_t detail) {
        failure = {part, detail, 0, errno};
        return detail != 0;
    };
    bool memory_is_new = true;
    if (refuse(BRACE_NODE_PART_MEMORY, brace_posix_nvm_open(&posix_.nvm, limb.nvm_path, &memory_is_new))
        || refuse(BRACE_NODE_PART_CONSOLE,
                  brace_posix_stream_open(&posix_.stream[BRACE_SERIAL_CONSOLE], url_or_none(limb.console)))
        || refuse(BRACE_NODE_PART_MODBUS_LINE,
                  brace_posix_stream_open(&posix_.stream[BRACE_SERIAL_MODBUS], url_or_none(limb.modbus_line)))
        || refuse(BRACE_NODE_PART_SLCAN_LINE,
                  brace_posix_stream_open(&posix_.stream[BRACE_SERIAL_SLCAN], url_or_none(limb.slcan_line)))
        || refuse(BRACE_NODE_PART_MODBUS_TCP, brace_posix_modbus_open(&posix_.modbus, url_or_none(limb.modbus_tcp)))) {
        return failure;
    }
    if (limb.servos != nullptr && refuse(BRACE_NODE_PART_SERVOS, servos_.open(limb, has_coxa_joint_))) {
        return failure;
    }
    if (bus != nullptr) {
        (void)brace_posix_join(&posix_, bus);
    }
    if (limb.key != nullptr) {
        posix_.is_guarded = posix_.has_key = true;
        std::copy_n(limb.key, BRACE_HAL_KEY_BYTES, posix_.key);
    }
    brace_posix_hal(&posix_, &hal_);
    hal_.silence_us = static_cast<std::uint32_t>(limb.owner_silence_s * 1e6);
    if (!store_block(limb, memory_is_new, failure)) {
        return failure;
    }
    return {};
}

bool LimbNode::stand_alone(const brace_node_limb_t &limb)
{
    take_hold(hold_n_per_mm_, limb.press);
    if (!limb_.settle(motors_rad(), 0.0, temp_degc(0.0), pressed_)) {
        return false;
    }
    for (int i = 0; i < kSettleSteps; ++i) {
        move_limb(0.0, kStep_s);
    }
    return true;
}

bool LimbNode::stand_on_body()
{
    is_on_body_ = true;
    take_hold(INFINITY, {});
    return limb_.settle(motors_rad(), 0.0, temp_degc(0.0), pressed_);
}

void LimbNode::start()
{
    sample();
    (void)brace_app_start(app_.get(), &hal_);
}

// Stores the block through the controller's own store, so that its start finds what an update would have left.
bool LimbNode::store_block(const brace_node_limb_t &limb, bool memory_is_new, brace_node_failure_t &failure)
{
    if (limb.block == nullptr || (!memory_is_new && limb.block_replaces == 0)) {
        return true;
    }
    auto wanted = std::make_unique<brace_parameters_t>();
    auto found = std::make_unique<brace_parameters_t>();
    std::int32_t status = brace_parameters_unpack(limb.block, limb.block_bytes, wanted.get(), nullptr, nullptr);
    if (status == BRACE_OK) {
        auto store = std::make_unique<brace_store_t>();
        (void)brace_store_start(store.get(), &hal_, found.get());
        status = brace_store_begin(store.get(), wanted.get(), nullptr);
        brace_store_state_t state = BRACE_STORE_BUSY;
        for (int i = 0; status == BRACE_OK && state == BRACE_STORE_BUSY && i < kStoreSteps; ++i) {
            state = brace_store_step(store.get());
        }
        if (status == BRACE_OK && state != BRACE_STORE_DONE) {
            failure = {BRACE_NODE_PART_MEMORY, BRACE_POSIX_E_SYSTEM, 0, errno};
            return false;
        }
    }
    if (status != BRACE_OK) {
        failure = {BRACE_NODE_PART_BLOCK, status, 0, 0};
    }
    return status == BRACE_OK;
}

void LimbNode::restart(brace_reset_cause_t cause)
{
    posix_.cause = cause;
    posix_.restart_asked = false;
    posix_.fed_us = posix_.given_us;
    command_ = {};
    (void)brace_app_start(app_.get(), &hal_);
}

// ------------------------------------------------------------------------------------------------ running

void LimbNode::tick(std::uint64_t now_us)
{
    const double dt_s = 1e-6 * static_cast<double>(now_us - now_us_);
    double t_s = 1e-6 * static_cast<double>(now_us_);
    now_us_ = now_us;
    posix_.given_us = static_cast<std::uint32_t>(now_us);
    faults.step(1e-6 * static_cast<double>(now_us));
    follow_faults();
    const int steps = is_on_body_ ? 0 : std::max(1, static_cast<int>(std::ceil(dt_s / kStep_s - 1e-9)));
    for (int i = 0; i < steps; ++i) {
        t_s += dt_s / steps;
        move(t_s, dt_s / steps);
    }
    sample();
    serve_servos(now_us - static_cast<std::uint64_t>(1e6 * dt_s));
    brace_app_tick(app_.get(), posix_.given_us);
    ++ticks_;
    if (posix_.restart_asked) {
        restart(BRACE_RESET_REQUESTED);
    } else if (posix_.given_us - posix_.fed_us > kPatience_us) {
        ++watchdog_resets_;
        restart(BRACE_RESET_WATCHDOG);
    }
    const double *late_ms = faults.value(BRACE_NODE_FAULT_TICK_LATE);
    const std::uint32_t period_us = brace_app_parameters(app_.get())->controller.tick_us;
    due_us_ = now_us
              + (late_ms != nullptr ? static_cast<std::uint64_t>(1e3 * (*late_ms > 0.0 ? *late_ms : kDefaultLate_ms))
                                    : period_us);
}

void LimbNode::poll()
{
    brace_posix_poll(&posix_);
    if (servos_.is_open() && !servos_.is_simulated()) {
        servos_.serve(now_us_);
    }
}

// Simulated servos see what the limb does to them, and exchange bytes as often as a board's main loop has time for it.
void LimbNode::serve_servos(std::uint64_t from_us)
{
    if (!servos_.is_simulated()) {
        return;
    }
    for (std::size_t i = 0; i < motor_.size(); ++i) {
        if (is_by_simulated_servo(i)) {
            const double link_rad = pressed_.link_rad[static_cast<Eigen::Index>(i)];
            servos_.shaft(i, link_rad, motor_[i].speed_rad_per_s, sample_[i].torque_n_mm, temp_degc(now_s()));
            servos_.move(i, setpoints.now_rad()[i]);
        }
    }
    for (std::uint64_t at_us = from_us + kServe_us; at_us <= now_us_; at_us += kServe_us) {
        servos_.serve(at_us);
    }
}

void LimbNode::follow_faults()
{
    posix_.nvm.fails = faults.is_on(BRACE_NODE_FAULT_NVM_FAILS);
    posix_.nvm.forgets = faults.is_on(BRACE_NODE_FAULT_NVM_FORGETS);
    if (posix_.bus != nullptr) {
        posix_.bus->node[posix_.node].fault_bus_off = faults.is_on(BRACE_NODE_FAULT_BUS_OFF);
    }
    const bool tip_is_lost = faults.is_on(BRACE_NODE_FAULT_TIP_LOST);
    if (tip_is_lost != tip_was_lost_ && !is_on_body_) {
        tip_was_lost_ = tip_is_lost;
        take_hold(tip_is_lost ? 0.0 : hold_n_per_mm_, {});
    }
    for (int joint = 0; joint < 3; ++joint) {
        const double *ratio = faults.value(BRACE_NODE_FAULT_JOINT_SOFT, joint);
        limb_.soften(joint, ratio != nullptr ? *ratio : 1.0);
    }
    const bool crashes = faults.is_on(BRACE_NODE_FAULT_CRASH) && !has_crashed_;
    has_crashed_ = faults.is_on(BRACE_NODE_FAULT_CRASH);
    if (crashes) {
        restart(BRACE_RESET_FAULT);
    }
}

void LimbNode::hold(double hold_n_per_mm, const brace_node_press_t &press)
{
    hold_n_per_mm_ = hold_n_per_mm;
    take_hold(hold_n_per_mm, press);
}

void LimbNode::take_hold(double hold_n_per_mm, const brace_node_press_t &press)
{
    const double y_mm = has_coxa_joint_ ? press.y_mm : 0.0;
    limb_.take_hold(motors_rad(), hold_n_per_mm, {press.x_mm, y_mm, press.z_mm}, now_s(), temp_degc(now_s()));
}

bool LimbNode::is_by_simulated_servo(std::size_t joint) const
{
    return servos_.is_simulated() && is_fitted(static_cast<std::int32_t>(joint));
}

double LimbNode::set_rad(std::size_t joint) const
{
    if (is_by_simulated_servo(joint)) {
        double goal_rad = motor_[joint].angle_rad, limit_n_mm = 0.0;
        servos_.goal(joint, goal_rad, limit_n_mm);
        return goal_rad;
    }
    return setpoints.now_rad()[joint] + command_[joint].offset_rad;
}

// A command that is not repeated fades out, as brace_hal.h says.
void LimbNode::follow_command(std::size_t joint, double dt_s)
{
    Command &command = command_[joint];
    const double range = drive_[joint].torque_range_n_mm;
    if (is_by_simulated_servo(joint)) {
        double goal_rad = 0.0, limit_n_mm = 0.0;
        servos_.goal(joint, goal_rad, limit_n_mm);
        motor_[joint].limit_n_mm = std::min(range, limit_n_mm);
        return;
    }
    if (command.given && now_us_ - command.since_us > kCommandHolds_us) {
        const double most = dt_s * kCommandFades_rad_per_s;
        command.offset_rad -= std::clamp(command.offset_rad, -most, most);
        command.limit_n_mm = range;
    }
    motor_[joint].limit_n_mm = command.given ? std::min(range, command.limit_n_mm) : range;
}

void LimbNode::move(double t_s, double dt_s)
{
    setpoints.step(t_s, dt_s, drive_);
    move_limb(t_s, dt_s);
}

void LimbNode::move_limb(double t_s, double dt_s)
{
    for (std::size_t i = 0; i < motor_.size(); ++i) {
        follow_command(i, dt_s);
    }
    const Vector3d &load = pressed_.load_n_mm;
    const Eigen::Matrix3d &stiffness = pressed_.stiffness_n_mm_per_rad;
    if (has_coxa_joint_) {
        step_motors<3>(drive_.data(), dt_s, {set_rad(0), set_rad(1), set_rad(2)}, load, stiffness, motor_.data());
    } else {
        step_motors<2>(&drive_[1], dt_s, {set_rad(1), set_rad(2)}, load.tail<2>(), stiffness.bottomRightCorner<2, 2>(),
                       &motor_[1]);
    }
    (void)limb_.settle(motors_rad(), t_s, temp_degc(t_s), pressed_);
}

double LimbNode::temp_degc(double t_s) const
{
    return temp_start_degc_ + temp_rise_degc_ * (1.0 - std::exp(-t_s / temp_time_constant_s_));
}

// ------------------------------------------------------------------------------------------------- readings

void LimbNode::sample()
{
    const double t_s = now_s();
    for (int joint = 0; joint < 3; ++joint) { // noise is drawn for a joint that is not fitted, too: the others' stays
        const brace_node_drive_t &drive = drive_[static_cast<std::size_t>(joint)];
        const Motor &motor = motor_[static_cast<std::size_t>(joint)];
        const double *offset_n_mm = faults.value(BRACE_NODE_FAULT_CURRENT_OFFSET, joint);
        const double read_n_mm = motor.torque_n_mm + drive.torque_bias_n_mm + drive.torque_noise_n_mm * noise_.normal()
                                 + (offset_n_mm != nullptr ? *offset_n_mm : 0.0);
        brace_hal_joint_t &read = sample_[static_cast<std::size_t>(joint)];
        const double step_rad = drive.angle_step_rad;
        if (!faults.is_on(BRACE_NODE_FAULT_ENCODER_STUCK, joint)) {
            read.motor_rad = static_cast<float>(step_rad * std::round(motor.angle_rad / step_rad));
        }
        read.torque_n_mm = static_cast<float>(read_n_mm);
        const double behind_gear_rad = pressed_.link_rad[joint];
        read.link_rad = has_link_encoder_ ? static_cast<float>(step_rad * std::round(behind_gear_rad / step_rad))
                                          : std::numeric_limits<float>::quiet_NaN();
        read.temp_degc = static_cast<float>(temp_degc(t_s));
        read.taken_us = static_cast<std::uint32_t>(now_us_);
    }
    const double *offset_n = faults.value(BRACE_NODE_FAULT_FORCE_OFFSET);
    const Vector2d force = plant::Sensor(plant_).reading_n({pressed_.force_n.x(), pressed_.force_n.z()}, t_s);
    for (const int axis : {0, 1}) {
        const double noise_n = force_noise_n_ * noise_.normal();
        force_sample_n_[static_cast<std::size_t>(axis)] =
            static_cast<float>(force[axis] + noise_n + (offset_n != nullptr ? *offset_n : 0.0));
    }
}

// A limb in which nothing yields across its plane has no coxa joint.
bool LimbNode::is_fitted(std::int32_t joint_index) const
{
    return joint_index >= (has_coxa_joint_ ? 0 : 1) && joint_index <= 2;
}

std::int32_t LimbNode::joint_read(void *context, std::int32_t joint_index, brace_hal_joint_t *joint)
{
    LimbNode &node = *static_cast<LimbNode *>(context);
    if (!node.is_fitted(joint_index)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (node.faults.is_on(BRACE_NODE_FAULT_SENSOR_DEAD, joint_index)) {
        return BRACE_HAL_E_DEVICE;
    }
    if (node.servos_.is_open()) {
        return node.servos_.read(joint_index, joint);
    }
    *joint = node.sample_[static_cast<std::size_t>(joint_index)];
    if (node.faults.is_on(BRACE_NODE_FAULT_SENSOR_NAN, joint_index)) {
        joint->motor_rad = joint->torque_n_mm = std::numeric_limits<float>::quiet_NaN();
    }
    return BRACE_HAL_OK;
}

std::int32_t LimbNode::joint_command(void *context, std::int32_t joint_index, const brace_hal_joint_command_t *command)
{
    LimbNode &node = *static_cast<LimbNode *>(context);
    if (!node.is_fitted(joint_index)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (node.servos_.is_open()) {
        return node.servos_.command(joint_index, command);
    }
    if (!std::isfinite(command->offset_rad) || !(command->torque_limit_n_mm >= 0.0f)) {
        return BRACE_HAL_E_RANGE;
    }
    node.command_[static_cast<std::size_t>(joint_index)] = {
        static_cast<double>(command->offset_rad), static_cast<double>(command->torque_limit_n_mm), node.now_us_, true};
    return BRACE_HAL_OK;
}

std::int32_t LimbNode::tip_force_read(void *context, float *force_x_n, float *force_z_n)
{
    const LimbNode &node = *static_cast<LimbNode *>(context);
    if (node.faults.is_on(BRACE_NODE_FAULT_FORCE_DEAD)) {
        return BRACE_HAL_E_DEVICE;
    }
    *force_x_n = node.force_sample_n_[0];
    *force_z_n = node.force_sample_n_[1];
    return BRACE_HAL_OK;
}

brace_node_truth_t LimbNode::truth() const
{
    brace_node_truth_t truth{};
    for (std::size_t i = 0; i < motor_.size(); ++i) {
        truth.set_rad[i] = set_rad(i);
        truth.motor_rad[i] = motor_[i].angle_rad;
        truth.torque_n_mm[i] = motor_[i].torque_n_mm;
        truth.link_rad[i] = pressed_.link_rad[static_cast<Eigen::Index>(i)];
        truth.load_n_mm[i] = pressed_.load_n_mm[static_cast<Eigen::Index>(i)];
        truth.flank[i] = pressed_.flank[i];
    }
    truth.has_coxa_joint = has_coxa_joint_ ? 1 : 0;
    truth.force_x_n = pressed_.force_n.x();
    truth.force_y_n = pressed_.force_n.y();
    truth.force_z_n = pressed_.force_n.z();
    truth.temp_degc = temp_degc(now_s());
    truth.solved = pressed_.solved;
    return truth;
}

} // namespace brace::node
