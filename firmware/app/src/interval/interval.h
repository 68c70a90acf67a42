/* Intervals that hold the joints' loads and the force on the tip with 90 %. Friction in the gears hides a part of each
 * (brace/load_band.h). Each tick works out one of six parts: three joints, then x, z and y of the force. So a load is
 * of at most six ticks before, and the force of loads of at most eleven ticks before. */
#ifndef BRACE_INTERVAL_INTERVAL_H
#define BRACE_INTERVAL_INTERVAL_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/load_band.h"
#include "brace/parameters.h"
#include "flank/flank.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "sense/tip_force.h"

/* How a joint turned last: a play operator on its angle, so that an encoder's steps are no motion. */
typedef struct {
    float anchor_rad; /* NaN: no angle was known yet */
    float way;        /* +1, -1; 0: it has not moved since it was known */
    uint32_t still_us; /* since the anchor moved last */
} interval_turn_t;

typedef struct {
    uint8_t part; /* the next one to work out */
    interval_turn_t turn[BRACE_LINK_COUNT];
    brace_load_band_t band[BRACE_LINK_COUNT]; /* middle_n_mm is NaN: not known */
    float z_middle_n;                         /* of the force, between its parts */
    brace_interval_t load_n_mm[BRACE_LINK_COUNT]; /* NaN: not known */
    brace_interval_t x_n, y_n, z_n;               /* of the force, as the snapshot's */
} interval_t;

typedef struct {
    const joints_t *joints;
    const flank_t *flank;
    const posture_t *posture;
    const tip_force_t *force;
    bool is_sensed; /* the sensor at the tip measures the force in the plane */
    const brace_parameters_t *parameters;
    brace_vec3_t down;
} interval_inputs_t;

/* Nothing is known. */
void interval_start(interval_t *interval);

/* One part. At most 200 instructions. */
void interval_step(interval_t *interval, const interval_inputs_t *inputs);

#endif
