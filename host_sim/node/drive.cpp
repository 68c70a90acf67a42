#include "node/drive.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace brace::node
{
namespace
{

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kSweeps = 60;

double damping(const brace_node_drive_t &drive)
{
    return std::isnan(drive.servo_n_mm_s_per_rad)
               ? 2.0 * std::sqrt(drive.servo_n_mm_per_rad * drive.inertia_n_mm_s2_per_rad)
               : drive.servo_n_mm_s_per_rad;
}

// The speeds v of least 1/2 v'Mv - b'v + sum rub |v|: M v = b with dry friction, each joint in turn.
Vector2d speeds_with_friction(const Matrix2d &inertia, const Vector2d &impulse, const Vector2d &rub)
{
    Vector2d speed = inertia.inverse() * impulse;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const int i : {0, 1}) {
            const double pushed = impulse[i] - inertia(i, 1 - i) * speed[1 - i];
            speed[i] = std::copysign(std::max(std::fabs(pushed) - rub[i], 0.0), pushed) / inertia(i, i);
        }
    }
    return speed;
}

} // namespace

void step_motors(const std::array<const brace_node_drive_t *, 2> &drive, double dt_s, const Vector2d &set_rad,
                 const Vector2d &load_n_mm, const Matrix2d &stiffness_n_mm_per_rad,
                 std::array<Motor, 2> &motor)
{
    std::array<bool, 2> limited{};
    Vector2d speed;
    for (int pass = 0; pass < 3; ++pass) { // a torque at its limit is a constant: found, then solved again
        Matrix2d inertia = dt_s * dt_s * stiffness_n_mm_per_rad;
        Vector2d impulse, rub;
        for (const int i : {0, 1}) {
            const double p = drive[i]->servo_n_mm_per_rad;
            inertia(i, i) += drive[i]->inertia_n_mm_s2_per_rad;
            impulse[i] = drive[i]->inertia_n_mm_s2_per_rad * motor[i].speed_rad_per_s - dt_s * load_n_mm[i];
            rub[i] = dt_s * drive[i]->friction_n_mm;
            if (limited[i]) {
                impulse[i] += dt_s * motor[i].torque_n_mm;
            } else {
                inertia(i, i) += dt_s * (damping(*drive[i]) + dt_s * p);
                impulse[i] += dt_s * p * (set_rad[i] - motor[i].angle_rad);
            }
        }
        speed = speeds_with_friction(inertia, impulse, rub);
        bool again = false;
        for (const int i : {0, 1}) {
            if (limited[i]) {
                continue;
            }
            const double wanted =
                drive[i]->servo_n_mm_per_rad * (set_rad[i] - motor[i].angle_rad - dt_s * speed[i])
                - damping(*drive[i]) * speed[i];
            motor[i].torque_n_mm = std::clamp(wanted, -motor[i].limit_n_mm, motor[i].limit_n_mm);
            limited[i] = motor[i].torque_n_mm != wanted;
            again |= limited[i];
        }
        if (!again) {
            break;
        }
    }
    for (const int i : {0, 1}) {
        motor[i].speed_rad_per_s = speed[i];
        motor[i].angle_rad += dt_s * speed[i];
    }
}

} // namespace brace::node
