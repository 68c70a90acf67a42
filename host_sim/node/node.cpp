// The C interface of a node.
#include "node/node.h"

#include <cerrno>
#include <cmath>
#include <new>

#include "plant/model_keys.h"

using brace::node::in_range;
using brace::node::LimbNode;
using brace::node::Robot;

bool brace::node::in_range(double value, double low, double high)
{
    return value >= low && value <= high;
}

namespace {

bool is_sound(const brace_node_drive_t &drive)
{
    return in_range(drive.servo_n_mm_per_rad, 1e-6, 1e9)
           && (std::isnan(drive.servo_n_mm_s_per_rad) || in_range(drive.servo_n_mm_s_per_rad, 0.0, 1e9))
           && in_range(drive.inertia_n_mm_s2_per_rad, 1e-6, 1e6) && in_range(drive.friction_n_mm, 0.0, 1e6)
           && in_range(drive.friction_per_torque_ratio, 0.0, 0.9) && in_range(drive.friction_per_load_ratio, 0.0, 0.9)
           && in_range(drive.torque_range_n_mm, 1e-6, 1e6) && in_range(drive.torque_noise_n_mm, 0.0, 1e6)
           && in_range(drive.torque_bias_n_mm, -1e6, 1e6) && in_range(drive.angle_step_rad, 1e-9, 0.1)
           && in_range(drive.rate_rad_per_s, 1e-6, 100.0);
}

bool is_sound(const brace_node_press_t &press)
{
    return in_range(press.x_mm, -1e3, 1e3) && in_range(press.y_mm, -1e3, 1e3) && in_range(press.z_mm, -1e3, 1e3);
}

std::int32_t fault_of(const brace_node_limb_t &limb)
{
    if (brace::plant::first_fault(limb.plant) != nullptr) {
        return BRACE_HOST_E_PARAMETER;
    }
    bool sound = limb.hold_n_per_mm >= 0.0 && is_sound(limb.press) && in_range(limb.force_noise_n, 0.0, 1e6)
                 && in_range(limb.temp_start_degc, -273.15, 1e3) && in_range(limb.temp_rise_degc, -1e3, 1e3)
                 && limb.temp_time_constant_s > 0.0 && std::isfinite(limb.temp_time_constant_s);
    for (int i = 0; i < 3; ++i) {
        sound = sound && is_sound(limb.drive[i]) && in_range(limb.theta_rad[i], -7.9, 7.9);
    }
    return sound ? BRACE_HOST_OK : BRACE_HOST_E_RANGE;
}

brace_node_failure_t build(brace_node &node, const brace_node_limb_t *limbs, std::int32_t count,
                           const brace_robot_t *body, const char *can, std::uint64_t seed)
{
    for (std::int32_t i = 0; i < count; ++i) {
        if (const std::int32_t fault = fault_of(limbs[i]); fault != BRACE_HOST_OK) {
            return {BRACE_NODE_PART_LIMB, fault, i, 0};
        }
    }
    if (can != nullptr) {
        node.bus = std::make_unique<brace_posix_bus_t>();
        if (const std::int32_t status = brace_posix_bus_open(node.bus.get(), can); status != BRACE_POSIX_OK) {
            return {BRACE_NODE_PART_CAN, status, 0, errno};
        }
    }
    brace::rig::Noise seeds(seed);
    for (std::int32_t i = 0; i < count; ++i) {
        node.limbs.push_back(std::make_unique<LimbNode>(limbs[i], seeds.bits()));
        LimbNode &limb = *node.limbs.back();
        brace_node_failure_t failure = limb.open(limbs[i], node.bus.get());
        if (failure.part != BRACE_NODE_PART_NONE && failure.detail != 0) {
            failure.limb = i;
            return failure;
        }
        if (!(body != nullptr ? limb.has_coxa_joint() && limb.stand_on_body() : limb.stand_alone(limbs[i]))) {
            return {BRACE_NODE_PART_LIMB, BRACE_HOST_E_SINGULAR, i, 0};
        }
        if (body == nullptr) {
            limb.start();
        }
    }
    if (body != nullptr) {
        node.robot = std::make_unique<Robot>(*body, node.limbs);
        node.robot->put_down();
        for (const auto &limb : node.limbs) {
            limb->start();
        }
    }
    return {};
}

} // namespace

extern "C" void brace_node_limb_default(brace_node_limb_t *limb)
{
    if (limb == nullptr) {
        return;
    }
    *limb = {};
    brace_plant_model_default(&limb->plant);
    limb->plant.link[1].axial_mm_per_n = 0.001;
    limb->plant.link[1].bending_mm_per_n = 0.06;
    limb->plant.link[2].axial_mm_per_n = 0.002;
    limb->plant.link[2].bending_mm_per_n = 0.25;
    limb->plant.joint[1].compliance_rad_per_n_mm = 1.0e-5;
    limb->plant.joint[2].compliance_rad_per_n_mm = 1.6e-5;
    for (brace_node_drive_t &drive : limb->drive) {
        drive = {6e4, std::nan(""), 20.0, 200.0, 8000.0, 400.0, 0.0, 2e-5, 0.5, 0.0, 0.0};
    }
    limb->theta_rad[1] = 1.0;
    limb->theta_rad[2] = 1.4;
    limb->hold_n_per_mm = INFINITY;
    limb->force_noise_n = 0.05;
    limb->has_force_sensor = 1;
    limb->temp_start_degc = 22.0;
    limb->temp_time_constant_s = 600.0;
    for (int i = 0; i < 3; ++i) {
        limb->servo_id[i] = static_cast<uint8_t>(11 + i);
    }
}

brace_node *brace::node::make_node(const brace_node_limb_t *limbs, std::int32_t count, const brace_robot_t *body,
                                   const char *can, std::uint64_t seed, brace_node_failure_t *failure)
{
    brace_node_failure_t found{BRACE_NODE_PART_LIMB, BRACE_HOST_E_RANGE, 0, 0};
    std::unique_ptr<brace_node> node;
    try {
        if (limbs != nullptr && count > 0 && count <= BRACE_NODE_LIMBS) {
            node = std::make_unique<brace_node>();
            found = build(*node, limbs, count, body, can, seed);
        }
    } catch (const std::bad_alloc &) {
        found = {BRACE_NODE_PART_MEMORY, BRACE_POSIX_E_SYSTEM, 0, ENOMEM};
    }
    if (failure != nullptr) {
        *failure = found;
    }
    return found.part == BRACE_NODE_PART_NONE ? node.release() : nullptr;
}

extern "C" brace_node_t *brace_node_create(const brace_node_limb_t *limbs, int32_t count, const char *can,
                                           uint64_t seed, brace_node_failure_t *failure)
{
    return brace::node::make_node(limbs, count, nullptr, can, seed, failure);
}

extern "C" void brace_node_destroy(brace_node_t *node)
{
    delete node;
}

extern "C" const char *brace_node_can_place(const brace_node_t *node)
{
    return node != nullptr && node->bus ? node->bus->where : "";
}

extern "C" const char *brace_node_serial_place(const brace_node_t *node, int32_t limb, int32_t port)
{
    const LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr || port < 0 || port >= BRACE_SERIAL_PORT_COUNT) {
        return "";
    }
    return port == BRACE_SERIAL_MODBUS_TCP ? one->posix().modbus.where : one->posix().stream[port].where;
}

extern "C" const char *brace_node_posix_text(int32_t status)
{
    return brace_posix_status_text(status);
}

extern "C" uint64_t brace_node_step(brace_node_t *node, uint64_t time_us)
{
    if (node == nullptr || time_us > 1000000000u) {
        return node != nullptr ? node->now_us : 0;
    }
    const std::uint64_t until_us = node->now_us + time_us;
    for (std::uint64_t next = node->next_us(); next <= until_us; next = node->next_us()) {
        node->advance_to(next);
    }
    node->now_us = until_us;
    return until_us;
}

extern "C" uint64_t brace_node_run(brace_node_t *node, uint64_t until_us)
{
    if (node == nullptr) {
        return 0;
    }
    const brace::node::SignalsBlocked blocked;
    node->pace.start(node->now_us);
    while (!node->stop) {
        const std::uint64_t next = node->next_us();
        if (next > until_us) {
            break;
        }
        node->pace.wait_for(next);
        node->advance_to(next);
    }
    return node->now_us;
}

extern "C" void brace_node_stop(brace_node_t *node)
{
    if (node != nullptr) {
        node->stop = true;
    }
}

extern "C" int32_t brace_node_posture(brace_node_t *node, int32_t limb, double at_s, double theta1_rad,
                                      double theta2_rad)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr || !std::isfinite(at_s) || !in_range(theta1_rad, -7.9, 7.9)
        || !in_range(theta2_rad, -7.9, 7.9)) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    one->setpoints.add(at_s, {std::nan(""), theta1_rad, theta2_rad});
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_node_contact(brace_node_t *node, int32_t limb, double hold_n_per_mm,
                                      const brace_node_press_t *press)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr || press == nullptr || node->robot || !(hold_n_per_mm >= 0.0) || !is_sound(*press)) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    one->hold(hold_n_per_mm, *press);
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_node_fault(brace_node_t *node, int32_t limb, int32_t fault, int32_t joint, double value,
                                    double at_s, double for_s)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr || fault < 0 || fault >= BRACE_NODE_FAULT_COUNT || !std::isfinite(value) || !(at_s >= 0.0)
        || !(for_s >= 0.0)
        || (brace::node::is_of_a_joint(fault) && (joint < (one->has_coxa_joint() ? 0 : 1) || joint > 2))
        || (fault == BRACE_NODE_FAULT_TICK_LATE && !in_range(value, 0.0, 1e4))
        || (fault == BRACE_NODE_FAULT_JOINT_SOFT && !in_range(value, 1e-3, 1e3))) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    one->faults.add(fault, joint, value, at_s, for_s);
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_node_snapshot(brace_node_t *node, int32_t limb, brace_snapshot_t *snapshot)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr || snapshot == nullptr) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    *snapshot = *brace_app_snapshot(&one->app());
    return BRACE_HOST_OK;
}

extern "C" int32_t brace_node_servo(brace_node_t *node, int32_t limb, int32_t joint, brace_node_servo_t *servo)
{
    const std::lock_guard<std::mutex> held(node->lock);
    const LimbNode *found = node->limb(limb);
    if (found == nullptr || found->servos() == nullptr || joint < 0 || joint > 2) {
        return BRACE_HOST_E_RANGE;
    }
    brace_servo_report_t reported{};
    brace_servo_counters_t line{};
    brace_dynamixel_report(found->servos(), joint, &reported);
    brace_dynamixel_counters(found->servos(), &line);
    *servo = {reported.state,   reported.model,    reported.hardware_error,
              reported.samples, reported.lost,     reported.doubted,
              reported.refused, reported.restarts, line.requests,
              line.answers,     line.damaged,      line.skipped_bytes,
              line.foreign};
    return 0;
}

extern "C" int32_t brace_node_truth(brace_node_t *node, int32_t limb, brace_node_truth_t *truth)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr || truth == nullptr) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    *truth = one->truth();
    return BRACE_HOST_OK;
}

extern "C" void brace_node_stats(brace_node_t *node, brace_node_stats_t *stats)
{
    if (node == nullptr || stats == nullptr) {
        return;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    *stats = {};
    stats->time_us = node->now_us;
    stats->late_wakes = node->pace.late_wakes();
    stats->worst_late_us = node->pace.worst_late_us();
    stats->slipped_us = node->pace.slipped_us();
    stats->can_clients = node->bus ? brace_posix_bus_clients(node->bus.get()) : 0;
    for (const auto &limb : node->limbs) {
        stats->ticks += limb->ticks();
        stats->watchdog_resets += limb->watchdog_resets();
        if (node->bus) {
            stats->can_sent += node->bus->node[limb->posix().node].sent;
            stats->can_received += node->bus->node[limb->posix().node].received;
        }
    }
}

extern "C" brace_app_t *brace_node_app(brace_node_t *node, int32_t limb)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    return one != nullptr ? &one->app() : nullptr;
}

extern "C" int32_t brace_node_limbs(const brace_node_t *node)
{
    return node != nullptr ? static_cast<std::int32_t>(node->limbs.size()) : 0;
}

extern "C" int32_t brace_node_restart(brace_node_t *node, int32_t limb)
{
    LimbNode *one = node != nullptr ? node->limb(limb) : nullptr;
    if (one == nullptr) {
        return BRACE_HOST_E_RANGE;
    }
    const std::lock_guard<std::mutex> held(node->lock);
    one->restart(BRACE_RESET_POWER);
    return BRACE_HOST_OK;
}
