#include "backlash_plant.h"

#include <math.h>

enum { STEPS_PER_TICK = 10 };
static const double tick_s = 1e-3;
static const double stribeck_rad_per_s = 0.01; /* where sticking has become slipping */

static uint64_t dice_next(dice_t *dice) /* splitmix64 */
{
    uint64_t z = (dice->state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double dice_uniform(dice_t *dice, double low, double high)
{
    return low + (high - low) * ((double)(dice_next(dice) >> 11) * 0x1p-53);
}

double dice_log_uniform(dice_t *dice, double low, double high)
{
    return low * pow(high / low, dice_uniform(dice, 0.0, 1.0));
}

double dice_normal(dice_t *dice)
{
    const double radius = sqrt(-2.0 * log(dice_uniform(dice, 1e-300, 1.0)));
    return radius * cos(dice_uniform(dice, 0.0, 6.283185307179586));
}

plant_t plant_random(dice_t *dice)
{
    plant_t p = {0};
    const double degree = 0.017453292519943295;
    p.range_n_mm = dice_uniform(dice, 3000.0, 10000.0);
    p.noise_n_mm = 0.05 * p.range_n_mm;
    p.bias_n_mm = dice_uniform(dice, -0.005, 0.005) * p.range_n_mm;
    p.step_rad = dice_log_uniform(dice, 1e-5, 1e-4);
    p.motor_inertia = dice_uniform(dice, 10.0, 50.0);
    p.motor_friction_n_mm = dice_uniform(dice, 0.01, 0.06) * p.range_n_mm;
    p.breakaway_ratio = 1.0;
    p.motor_damping = dice_uniform(dice, 0.0, 50.0);
    p.gap_rad = degree * dice_uniform(dice, 0.1, 1.5);
    p.stiffness = dice_log_uniform(dice, 5e4, 2e5);
    p.damping = dice_uniform(dice, 0.1, 0.5) * sqrt(p.stiffness * p.motor_inertia);
    p.link_inertia = dice_log_uniform(dice, 20.0, 200.0);
    p.link_friction_n_mm = dice_uniform(dice, 0.002, 0.02) * p.range_n_mm;
    p.link_damping = dice_uniform(dice, 0.0, 100.0);
    p.gravity_n_mm = dice_uniform(dice, 0.0, 0.25) * p.range_n_mm;
    p.gravity_phase_rad = dice_uniform(dice, -3.14159, 3.14159);
    p.servo_p = dice_uniform(dice, 5.4e4, 6.6e4);
    p.servo_d = 1.4 * sqrt(p.servo_p * (p.motor_inertia + p.link_inertia));
    p.torque_limit_n_mm = p.range_n_mm;
    p.motor_rad = dice_uniform(dice, -1.0, 1.0);
    p.link_rad = p.motor_rad + dice_uniform(dice, -0.5, 0.5) * p.gap_rad;
    return p;
}

static double clamp(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

static double flank_torque(const plant_t *p)
{
    const double apart = p->motor_rad - p->link_rad, half = 0.5 * p->gap_rad;
    const double damped = p->damping * (p->motor_speed - p->link_speed);
    if (apart > half) {
        return fmax(0.0, p->stiffness * (apart - half) + damped);
    }
    return apart < -half ? fmin(0.0, p->stiffness * (apart + half) + damped) : 0.0;
}

/* Dry friction takes at most the speed there is: it stops, it does not push. */
static double rubbed(double speed, double inertia, double friction_n_mm, double dt)
{
    return speed - clamp(speed, friction_n_mm * dt / inertia);
}

/* Stribeck's curve without its viscous part. */
static double motor_friction_n_mm(const plant_t *p)
{
    const double slip = p->motor_speed / stribeck_rad_per_s;
    return p->motor_friction_n_mm * (1.0 + (p->breakaway_ratio - 1.0) * exp(-slip * slip));
}

double plant_gravity_n_mm(const plant_t *p, double link_rad)
{
    return -p->gravity_n_mm * cos(link_rad + p->gravity_phase_rad);
}

void plant_tick(plant_t *p, double setpoint_rad, double setspeed_rad_per_s, const world_t *world)
{
    const double dt = tick_s / STEPS_PER_TICK;
    for (int i = 0; i < STEPS_PER_TICK; i++) {
        p->torque_n_mm =
            clamp(p->servo_p * (setpoint_rad - p->motor_rad) + p->servo_d * (setspeed_rad_per_s - p->motor_speed),
                  p->torque_limit_n_mm);
        const double passed = flank_torque(p);
        double outside = world->torque_n_mm + plant_gravity_n_mm(p, p->link_rad) - p->link_damping * p->link_speed;
        if (world->hold_stiffness > 0.0) {
            outside -= world->hold_stiffness * (p->link_rad - world->hold_rad) + world->hold_damping * p->link_speed;
        }
        const double friction_n_mm = motor_friction_n_mm(p);
        p->motor_speed += dt * (p->torque_n_mm - passed - p->motor_damping * p->motor_speed) / p->motor_inertia;
        p->link_speed += dt * (passed + outside) / p->link_inertia;
        p->motor_speed = rubbed(p->motor_speed, p->motor_inertia, friction_n_mm, dt);
        p->link_speed = rubbed(p->link_speed, p->link_inertia, p->link_friction_n_mm, dt);
        p->motor_rad += dt * p->motor_speed;
        p->link_rad += dt * p->link_speed;
    }
}

int plant_flank(const plant_t *p)
{
    const double apart = p->motor_rad - p->link_rad;
    return (apart > 0.5 * p->gap_rad) - (apart < -0.5 * p->gap_rad);
}

double plant_load_n_mm(const plant_t *p)
{
    return flank_torque(p);
}

double plant_offset_rad(const plant_t *p)
{
    return clamp(p->link_rad - p->motor_rad, 0.5 * p->gap_rad);
}

double plant_angle_read_rad(const plant_t *p)
{
    return p->step_rad * floor(p->motor_rad / p->step_rad);
}

double plant_torque_read_n_mm(const plant_t *p, dice_t *dice)
{
    return p->torque_n_mm + p->bias_n_mm + p->noise_n_mm * dice_normal(dice);
}
