/* K of a limb of which a joint's gap is open: that joint carries nothing, so the tip yields along its lever for free.
 *
 * With the joint's compliance going to infinity K loses one rank:
 *     K_free = K - (K p)(K p)' / (p' K p),   p the joint's lever at the tip.
 * The only force left goes through the joint's axis, along u (from the joint to the tip):
 *     K_free = u u' / (u' C u),   u' C u = cos^2 a / lambda_max + sin^2 a / lambda_min,
 * a the angle from the stiff axis to u. That is what is computed: positive terms only, nothing cancels. With both gaps
 * open no force is left, and K_free is zero.
 *
 * Bounds: K_free <= K while it engages <= K engaged, as matrices.
 * Pure functions; any thread or interrupt; no loop. A refused call leaves its outputs untouched.
 */
#ifndef BRACE_GAP_STIFFNESS_H
#define BRACE_GAP_STIFFNESS_H

#include "brace/kinematics.h"
#include "brace/stiffness.h"

/* Joints of the limb's plane whose gap is open, as bits. */
enum { BRACE_GAP_NONE = 0, BRACE_GAP_FEMUR = 1 << BRACE_FEMUR, BRACE_GAP_TIBIA = 1 << BRACE_TIBIA };

typedef struct {
    brace_stiffness_t now;     /* lower bound; flagged BRACE_FLAG_GAP_OPEN while a gap is open, its lambda_min then 0 */
    brace_stiffness_t engaged; /* upper bound: once every gap has closed */
} brace_gap_stiffness_t;

/* K with the joints of `open` free.
 *   engaged: K with every gap closed, from any of the core's planar paths
 *   pose: levers at the same posture
 *   open: BRACE_GAP_... bits; none gives now = engaged
 *   result (out): now.stiff_axis_rad is the direction of u; 0 with both open
 * flags of now: those of engaged, BRACE_FLAG_GAP_OPEN, and BRACE_FLAG_NEAR_SINGULAR with both open and the knee within
 *   1e-3 of straight or folded, where a force along the leg would still be carried: zero is the lower bound.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (eigenvalues not positive and in order, unknown
 *   bits), BRACE_E_SINGULAR (the tip lies within 1e-3 mm of the free joint's axis)
 * accuracy: 3e-6 of lambda_max of K_free plus what twice the stiff axis' error makes of it where u lies along the
 *   stiff axis of a slender K
 * cost: at most 300 instructions on a Cortex-M4F; stack at most 200 bytes */
brace_status_t brace_gap_stiffness(const brace_stiffness_t *engaged, const brace_pose_t *pose, uint32_t open,
                                   brace_gap_stiffness_t *result);

/* The same for the tick, of a K that a planar path of the core has just given and a pose of the same posture: nothing
 * is checked but the free joint's lever. engaged may not lie in result. At most 200 instructions.
 * returns BRACE_OK, BRACE_E_SINGULAR */
brace_status_t brace_gap_stiffness_known(const brace_stiffness_t *engaged, const brace_pose_t *pose, uint32_t open,
                                         brace_gap_stiffness_t *result);

#endif
