#include "node/drive.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace brace::node {
namespace {

template <int N> using Vector = Eigen::Matrix<double, N, 1>;
template <int N> using Matrix = Eigen::Matrix<double, N, N>;

constexpr int kSweeps = 60;

double damping(const brace_node_drive_t &drive)
{
    return std::isnan(drive.servo_n_mm_s_per_rad)
               ? 2.0 * std::sqrt(drive.servo_n_mm_per_rad * drive.inertia_n_mm_s2_per_rad)
               : drive.servo_n_mm_s_per_rad;
}

// The most that friction holds between motor and gear: a constant, and shares of the torque and of the load. The torque
// is that of the step before. Model M5 of Duclusaud et al., arXiv 2410.08650, of a joint that stands.
double friction_n_mm(const brace_node_drive_t &drive, double torque_n_mm, double load_n_mm)
{
    return drive.friction_n_mm
           + std::fabs(drive.friction_per_torque_ratio * torque_n_mm + drive.friction_per_load_ratio * load_n_mm);
}

// Finds the speeds v that make 1/2 v'Mv - b'v + sum rub |v| least: M v = b with dry friction, one joint after another.
template <int N>
Vector<N> speeds_with_friction(const Matrix<N> &inertia, const Vector<N> &impulse, const Vector<N> &rub)
{
    Vector<N> speed = inertia.inverse() * impulse;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const Vector<N> before = speed;
        for (int i = 0; i < N; ++i) {
            double pushed = impulse[i];
            for (int other = 0; other < N; ++other) {
                pushed -= other != i ? inertia(i, other) * speed[other] : 0.0;
            }
            speed[i] = std::copysign(std::max(std::fabs(pushed) - rub[i], 0.0), pushed) / inertia(i, i);
        }
        if (speed == before) { // so would every further sweep leave it
            break;
        }
    }
    return speed;
}

} // namespace

template <int N>
void step_motors(const brace_node_drive_t *drive, double dt_s, const Vector<N> &set_rad, const Vector<N> &load_n_mm,
                 const Matrix<N> &stiffness_n_mm_per_rad, Motor *motor)
{
    std::array<bool, N> limited{};
    Vector<N> speed;
    for (int pass = 0; pass <= N; ++pass) { // a torque at its limit is a constant, so solve again
        Matrix<N> inertia = dt_s * dt_s * stiffness_n_mm_per_rad;
        Vector<N> impulse, rub;
        for (int i = 0; i < N; ++i) {
            const double p = drive[i].servo_n_mm_per_rad;
            inertia(i, i) += drive[i].inertia_n_mm_s2_per_rad;
            impulse[i] = drive[i].inertia_n_mm_s2_per_rad * motor[i].speed_rad_per_s - dt_s * load_n_mm[i];
            rub[i] = dt_s * friction_n_mm(drive[i], motor[i].torque_n_mm, load_n_mm[i]);
            if (limited[i]) {
                impulse[i] += dt_s * motor[i].torque_n_mm;
            } else {
                inertia(i, i) += dt_s * (damping(drive[i]) + dt_s * p);
                impulse[i] += dt_s * p * (set_rad[i] - motor[i].angle_rad);
            }
        }
        speed = speeds_with_friction<N>(inertia, impulse, rub);
        bool again = false;
        for (int i = 0; i < N; ++i) {
            if (limited[i]) {
                continue;
            }
            const double wanted = drive[i].servo_n_mm_per_rad * (set_rad[i] - motor[i].angle_rad - dt_s * speed[i])
                                  - damping(drive[i]) * speed[i];
            motor[i].torque_n_mm = std::clamp(wanted, -motor[i].limit_n_mm, motor[i].limit_n_mm);
            limited[i] = motor[i].torque_n_mm != wanted;
            again |= limited[i];
        }
        if (!again) {
            break;
        }
    }
    for (int i = 0; i < N; ++i) {
        motor[i].speed_rad_per_s = speed[i];
        motor[i].angle_rad += dt_s * speed[i];
    }
}

template void step_motors<2>(const brace_node_drive_t *, double, const Vector<2> &, const Vector<2> &,
                             const Matrix<2> &, Motor *);
template void step_motors<3>(const brace_node_drive_t *, double, const Vector<3> &, const Vector<3> &,
                             const Matrix<3> &, Motor *);

} // namespace brace::node
