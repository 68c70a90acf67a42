/* Servos after the published fit of the MX-106, and a limb of two of them. It shares nothing with host_sim/plant: its
 * friction lies between motor and gear, it moves by Newton's law, and it is written from the papers alone.
 *
 * M. Duclusaud, G. Passault, V. Padois, O. Ly, Extended friction models for the physics simulation of servo actuators,
 * ICRA 2025, arXiv 2410.08650: models M5 and M6, their numbers as published with the paper (github.com/Rhoban/bam,
 * bam/params/mx106/m5.json and m6.json, July 2025). SI units. */
#ifndef SERVOS_H
#define SERVOS_H

#include <stdint.h>

enum { SERVOS = 2 }; /* femur, tibia */

/* One fit. */
typedef struct {
    double kt, r, armature;                    /* N m/A, Ohm, kg m^2 */
    double base, base_stribeck;                /* N m */
    double motor, motor_stribeck, motor_quad;  /* per N m of the motor's torque */
    double outside, outside_stribeck, outside_quad; /* per N m of the load */
    double stribeck_rad_per_s, alpha, viscous; /* N m s */
} fit_t;

extern const fit_t mx106_m5, mx106_m6;

typedef struct {
    fit_t fit;
    double friction_factor; /* of this very servo */
    double goal_rad, angle_rad, speed_rad_per_s, current_a;
} servo_t;

/* The limb: links without compliance, uniform. theta2 is flexion: the tibia points along theta1 - theta2. */
typedef struct {
    servo_t servo[SERVOS];
    double femur_m, tibia_m, femur_n, tibia_n;
    double force_n[2]; /* of the ground on the tip: x, z */
} limb_t;

/* What the ground's force and the weights turn the joints by [N m], in the joints' own sense. */
void limb_turned(const limb_t *limb, double torque[SERVOS]);

void limb_step(limb_t *limb, double dt_s);

/* A generator of its own: splitmix64. */
double draw_uniform(uint64_t *state, double low, double high);
double draw_normal(uint64_t *state);

#endif
