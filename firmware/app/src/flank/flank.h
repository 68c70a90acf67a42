/* Which flank of each joint's backlash carries: one preload state machine per joint that has play. */
#ifndef BRACE_FLANK_FLANK_H
#define BRACE_FLANK_FLANK_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/backlash.h"
#include "brace/parameters.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "sense/tip_force.h"

typedef struct {
    bool has_play;             /* the joint is fitted and its gap_rad is 1e-5 or more */
    bool watched;              /* the state machine is set up */
    brace_backlash_t machine;  /* while watched */
    brace_backlash_out_t out;  /* of this tick; a joint without play is engaged */
    bool is_engaged;           /* its side is proven, or the load says so */
    bool is_assumed;           /* only the load says so */
} flank_joint_t;

typedef struct {
    flank_joint_t joint[BRACE_LINK_COUNT];
} flank_t;

/* Sets up the state machine of one joint when parameters are put in force. A joint whose take-up torque is too small
 * to be distinguished from noise and friction has play and is not watched: its gap counts as open. At most 1,300
 * instructions. */
void flank_configure(flank_t *flank, int joint_index, const joints_t *joints, const brace_parameters_t *parameters);

/* One tick of each joint's state machine.
 *   posture: of the tick before; with the tip's force it gives what a joint should carry
 *   down: where the weight pulls, in the limb's plane
 *   stands: true: take-ups do not move on. The function finds in both cases which flank carries
 * At most 620 instructions for a joint that is watched. */
void flank_tick(flank_t *flank, const joints_t *joints, const tip_force_t *force, const posture_t *posture,
                brace_vec3_t down, const brace_parameters_t *parameters, bool stands, uint32_t now_us);

/* Adds to a joint's sample what the joint should carry: its share of the sensed tip force, and the weight; and how
 * far that may be off. index: BRACE_FEMUR or BRACE_TIBIA; the force is known and the posture has levers.
 * returns which side the load holds (brace/play.h) */
int flank_expect_load(brace_backlash_sample_t *sample, int index, const tip_force_t *force, const posture_t *posture,
                      brace_vec3_t down, const brace_parameters_t *parameters);

/* The controller reports a joint's load as a mean over 20 ms. This is how far the load now may be from the mean [N mm]:
 * the root mean square distance of the newest three samples from the mean, with the sign of the newest one's distance.
 * NaN: not known.
 * One sample is not enough: noise often puts it near the mean although the load has changed. More than three are too
 * many. After a change by D, the first new sample alone gives D / sqrt(3). A span of that half-width has a sigma of
 * D / 3, so three sigmas reach D from the first sample on. */
float flank_lag_n_mm(const flank_t *flank, const joints_t *joints, int index);

/* Joints whose gap is open or may be, as bits 1 << joint. */
uint32_t flank_open_gaps(const flank_t *flank);

/* Joints that count as engaged because the load says so, not proven, as bits 1 << joint. */
uint32_t flank_assumed(const flank_t *flank);

#endif
