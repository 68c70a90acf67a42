/* One joint with play, in motion: servo, motor inertia and friction, gap with a sprung and damped flank, link with
 * inertia, friction and gravity, and what the world does to the link. Knows nothing of the firmware.
 * Units: N mm, rad, s; inertias N mm s^2/rad; joint side of the reduction. */
#ifndef BACKLASH_PLANT_H
#define BACKLASH_PLANT_H

#include <stdint.h>

typedef struct {
    uint64_t state;
} dice_t;

double dice_uniform(dice_t *dice, double low, double high);
double dice_log_uniform(dice_t *dice, double low, double high);
double dice_normal(dice_t *dice);

typedef struct {
    double range_n_mm, noise_n_mm, bias_n_mm, step_rad;        /* motor and its instruments */
    double motor_inertia, motor_friction_n_mm, motor_damping;  /* before the gap */
    double breakaway_ratio; /* friction at rest over that in motion; 1: as in motion */
    double gap_rad, stiffness, damping;                        /* of the flanks */
    double link_inertia, link_friction_n_mm, link_damping;     /* behind it */
    double gravity_n_mm, gravity_phase_rad;
    double servo_p, servo_d;
    double motor_rad, motor_speed, link_rad, link_speed;
    double torque_n_mm; /* of the motor, as it is */
    double torque_limit_n_mm;
} plant_t;

/* What the world does to the link: a torque, and a hold (spring and damper at a place) while stiffness > 0. */
typedef struct {
    double torque_n_mm;
    double hold_stiffness, hold_damping, hold_rad;
} world_t;

plant_t plant_random(dice_t *dice);

/* Goes on by a millisecond towards a setpoint. */
void plant_tick(plant_t *plant, double setpoint_rad, double setspeed_rad_per_s, const world_t *world);

/* Truth: +1, -1 the flank that touches, 0 with the gap open. */
int plant_flank(const plant_t *plant);

/* Truth: what the gap transmits. */
double plant_load_n_mm(const plant_t *plant);

/* Truth: link - motor, of it the part that is backlash [rad], in [-gap/2, gap/2]. */
double plant_offset_rad(const plant_t *plant);

double plant_gravity_n_mm(const plant_t *plant, double link_rad);
double plant_angle_read_rad(const plant_t *plant);
double plant_torque_read_n_mm(const plant_t *plant, dice_t *dice);

#endif
