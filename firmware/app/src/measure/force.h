/* The force of the ground on the tip, by the sensor or from what the joints carry, and what the joints
 * should carry. */
#ifndef BRACE_APP_FORCE_H
#define BRACE_APP_FORCE_H

#include "brace/app.h"

/* Prepares the correction of the sensor; not for the tick. */
void force_configure(brace_app_t *app);

/* Reads and corrects the sensor: the force is known, and in the snapshot, or not. Bias, gain, rotation and cross-talk
 * are undone; drift is not (nobody here knows when the sensor was zeroed). A saturated reading is not known, nor one
 * older than controller.age_limit_us. */
void force_sense(brace_app_t *app, brace_snapshot_t *snapshot);

/* Adds to a joint's sample what the joint should transmit, when the force on the tip is sensed: gravity
 * and lever. */
void force_expect(const brace_app_t *app, int index, brace_backlash_sample_t *sample);

/* Force into the snapshot where it is not sensed: from the joints' loads as the levers allow, or NaN. */
void force_tell(const brace_app_t *app, brace_snapshot_t *snapshot);

/* What gravity asks of a motor to hold the posture [N mm]; index: 0 femur, 1 tibia. */
float force_gravity(const brace_app_t *app, int index);

#endif
