/* A limb and its sensors, as a function of the tick alone: where its joints stand, what its motors carry, what each
 * sensor says, noise included. Two controllers that are given the same ticks see the same. Written for this judge; it
 * shares nothing with the firmware but the struct of parameters. */
#ifndef FAULTS_PLANT_H
#define FAULTS_PLANT_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace_hal.h"

typedef enum { PHASE_RESTS, PHASE_MOVES, PHASE_PRESSED, PHASE_COUNT } phase_t;

/* What the sensors of one tick say, and how they answer. */
typedef struct {
    brace_hal_joint_t joint[BRACE_LINK_COUNT];
    int32_t joint_answer[BRACE_LINK_COUNT];
    float force_x_n, force_z_n;
    int32_t force_answer;
} sensors_t;

typedef struct {
    brace_parameters_t parameters;
    bool has_coxa, has_link_encoders, has_force, has_temperature;
    phase_t phase;
    double start_rad[BRACE_LINK_COUNT], swing_rad[BRACE_LINK_COUNT], swing_hz; /* of the motors */
    double force_n[2], force_swing_ratio, force_hz;                           /* of the ground on the tip */
    double degc;
    uint32_t seed; /* of the noise */
} plant_t;

/* A limb by lot: lengths, springs, drives, posture, load, instruments. */
void plant_draw(plant_t *plant, uint32_t seed, phase_t phase);

/* What its sensors say in a tick. taken_us is the tick's own time. */
void plant_sense(const plant_t *plant, int32_t tick, uint32_t taken_us, sensors_t *sensors);

/* Numbers by lot, of a state of its own. */
uint32_t lot_bits(uint32_t *state);
double lot_between(uint32_t *state, double low, double high);

#endif
