/* Which side (flank) of a joint's backlash is loaded: a preload state machine per joint, and the take-up of backlash on
 * request.
 *
 * Between motor and link lies a gap of full width g. The link stands at
 *     joint angle = motor angle + offset,   offset = -g/2 on the positive flank, +g/2 on the negative one,
 * less the elastic wind-up. On the positive flank the motor's torque on the link is positive.
 *
 * The load decides, not the direction of motion. The load that the gap transmits lies in an interval:
 *     motor torque - inertia * acceleration - friction, +- the uncertainty of each term.
 * Friction is known (to its tolerance) while the motor moves one way, and only bounded while the motor stands. Two
 * filters of 10 ms and 80 ms smooth the interval. A flank is valid when the fast interval has been clear of zero by six
 * sigma for 12 ms. A flank is named, but not valid, when the slow interval is clear by 0.7 of its bounds and three
 * sigma, or when an expected load narrows it; that flank is remembered for 250 ms. Otherwise no flank is named. The
 * offset is then a guess, off by up to the gap: it follows the slow mean of a moving motor, or else the motor's travel
 * through the gap, as a play operator does. docs/backlash.md says what accuracy this reaches, and what nobody can reach
 * who only watches the motor.
 *
 * One table of transitions (src/backlash/backlash_table.c) moves the state; a second one moves the phases of a take-up.
 *
 * Angles are in the joint's own sense (theta1, theta2), on the joint's side of the reduction. Time is in the caller's
 * microseconds and may wrap. Each joint has one brace_backlash_t, which one thread uses; joints are independent.
 * No heap, no recursion; of libm sqrtf and fmaf. Loops run over a state's rows, at most 7 (brace_backlash_init: at most
 * 1000).
 * A refused call changes nothing; only brace_backlash_tick goes to FAULT on a bad sample. docs/bench.md has figures.
 */
#ifndef BRACE_BACKLASH_H
#define BRACE_BACKLASH_H

#include <stdint.h>

#include "brace/backlash_types.h"
#include "brace/kinematics.h"
#include "brace/status.h"

/* Prepares a joint. It starts in UNKNOWN, and the link may stand anywhere in the gap.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (a parameter outside its range),
 *   BRACE_E_PARAMETER (torque_max does not exceed what a take-up needs to be seen)
 * cost: 1,200 instructions on a Cortex-M4F with a tick of 1 ms, up to 10,000 with one of 0.1 ms; stack at most 300
 * bytes. Not for the tick. */
brace_status_t brace_backlash_init(brace_backlash_t *joint, const brace_backlash_params_t *params);

/* One tick. Call it once every tick_us. A pause of more than four ticks is a FAULT, because the filters miss its
 * samples.
 *   out: written unless the call returns BRACE_E_NULL; in FAULT: not valid, flank 0
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (a sample out of range: FAULT)
 * cost on a Cortex-M4F: 490 instructions in the mean, at most 700 (take-up running); stack at most 100 bytes. */
brace_status_t brace_backlash_tick(brace_backlash_t *joint, const brace_backlash_sample_t *sample,
                                   brace_backlash_out_t *out);

/* What ticks end at when the motor has stood under one torque for a second or longer, from a fresh start: for tools
 * that know the load and have no controller.
 *   joint: prepared; only read. sample: its torque is the load; motor_rad and now_us do not count
 *   flank (out): the side that is named, +1 or -1; 0: none. is_proven (out): the torque itself proves it
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE
 * Not for the tick; stack at most 400 bytes. */
brace_status_t brace_backlash_at_rest(const brace_backlash_t *joint, const brace_backlash_sample_t *sample, int *flank,
                                      bool *is_proven);

/* Longest time after the gap has opened for which the flank is still valid [us], as brace_backlash_init computed it. 0
 * for null. */
uint32_t brace_backlash_detection_us(const brace_backlash_t *joint);

/* The least preload of a take-up, even when less is wanted: friction with its tolerance, bias, eighteen sigma of the
 * fast filter [N mm]. With noise of 5 % of range that is 21 % of range and the friction. 0 for null. */
float brace_takeup_preload_min_n_mm(const brace_backlash_t *joint);

/* Asks for the backlash to be taken up against a flank. From then on the motor's setpoint has to follow
 * out.command_rad, and its torque has to be limited while out.limit_torque is true. Something has to hold the link.
 *   flank: +1 or -1
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_RANGE (another flank, a take-up is under way, FAULT) */
brace_status_t brace_takeup_request(brace_backlash_t *joint, int flank);

/* Ends a take-up in any phase: the command goes back at its rate, then the phase is IDLE. Let several joints go in the
 * reverse order of taking up, each when the one before is IDLE.
 * returns BRACE_OK, BRACE_E_NULL */
brace_status_t brace_takeup_let_go(brace_backlash_t *joint);

/* Shift of the tip that two joints' offsets cause: offset times lever. With half the gap as offset it is the largest
 * shift that the gap allows.
 *   pose: levers at the posture
 *   offset1_rad, offset2_rad [+-0.5]: offsets of theta1 and theta2 (out.offset_rad). theta2 is flexion: a positive
 *     offset turns the tibia clockwise.
 *   shift (out) [mm]: displacement of the tip from where the motor angles alone would put it
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE
 * cost: 60 instructions */
brace_status_t brace_backlash_tip_shift(const brace_pose_t *pose, float offset1_rad, float offset2_rad,
                                        brace_point_t *shift);

#endif
