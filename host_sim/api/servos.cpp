// The C interface of simulated servos on a line.
#include <algorithm>
#include <cmath>
#include <new>

#include "servo/line.h"

using brace::servo::Line;
using brace::servo::Servo;
namespace reg = brace::servo;

struct brace_servos : Line {
    using Line::Line;
};

namespace {

constexpr double kCountsPerRad = 4096.0 / (2.0 * 3.14159265358979323846);
constexpr double kVelocity_rad_per_s = 0.229 * 2.0 * 3.14159265358979323846 / 60.0;

std::int32_t clamped(double value, double most)
{
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -most, most)));
}

} // namespace

brace_servos_t *brace_servos_create(uint32_t baud, uint64_t seed)
{
    return baud > 0 ? new (std::nothrow) brace_servos(baud, seed) : nullptr;
}

void brace_servos_destroy(brace_servos_t *servos)
{
    delete servos;
}

int32_t brace_servos_add(brace_servos_t *servos, uint8_t id, uint16_t model)
{
    return servos->add(id, model);
}

void brace_servos_hear(brace_servos_t *servos, uint64_t at_ns, const uint8_t *bytes, uint32_t count)
{
    servos->hear(at_ns, {bytes, bytes + count});
}

uint32_t brace_servos_give(brace_servos_t *servos, uint64_t now_ns, uint8_t *bytes, uint32_t room)
{
    return servos->give(now_ns, bytes, room);
}

int32_t brace_servos_peek(const brace_servos_t *servos, int32_t servo, uint16_t address, uint32_t count)
{
    const Servo *found = servos->servo(servo);
    return found != nullptr && address + count <= reg::kTableBytes ? found->get(address, count) : 0;
}

void brace_servos_poke(brace_servos_t *servos, int32_t servo, uint16_t address, uint32_t count, int32_t value)
{
    Servo *found = servos->servo(servo);
    if (found != nullptr && address + count <= reg::kTableBytes) {
        found->set(address, count, value);
    }
}

void brace_servos_shaft(brace_servos_t *servos, int32_t servo, double turned_rad, double speed_rad_per_s,
                        double current_a, double temp_degc)
{
    if (Servo *found = servos->servo(servo)) {
        found->set(reg::kPresentPosition, 4, clamped(turned_rad * kCountsPerRad, reg::kTurns));
        found->set(reg::kPresentVelocity, 4, clamped(speed_rad_per_s / kVelocity_rad_per_s, 1023));
        found->set(reg::kPresentCurrent, 2, clamped(current_a / found->current_step_a, 2047));
        found->set(reg::kTemperature, 1, clamped(std::max(temp_degc, 0.0), 150));
    }
}

int32_t brace_servos_goal(const brace_servos_t *servos, int32_t servo, double *goal_rad, double *current_a)
{
    const Servo *found = servos->servo(servo);
    if (found == nullptr || found->get(reg::kTorque, 1) == 0) {
        return 0;
    }
    const bool is_limited = found->get(reg::kOperatingMode, 1) == 5;
    *goal_rad = found->get(reg::kGoalPosition, 4) / kCountsPerRad;
    *current_a = found->current_step_a * std::abs(found->get(is_limited ? reg::kGoalCurrent : reg::kCurrentLimit, 2));
    return 1;
}

void brace_servos_plug(brace_servos_t *servos, int32_t servo, int32_t is_in)
{
    if (Servo *found = servos->servo(servo)) {
        found->plugged = is_in != 0;
    }
}

void brace_servos_power(brace_servos_t *servos, int32_t servo, uint64_t now_ns)
{
    if (Servo *found = servos->servo(servo)) {
        found->restart(now_ns);
    }
}

void brace_servos_break(brace_servos_t *servos, int32_t servo, uint8_t hardware_error)
{
    if (Servo *found = servos->servo(servo)) {
        found->fail(hardware_error);
    }
}

void brace_servos_damage(brace_servos_t *servos, double share)
{
    servos->damage_share = share;
}

void brace_servos_counts(const brace_servos_t *servos, brace_servos_counts_t *counts)
{
    *counts = servos->counts;
}
