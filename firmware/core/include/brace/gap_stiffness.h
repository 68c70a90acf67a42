/* K of a limb while the gap of a joint is open. That joint carries nothing, so the tip yields freely along its lever.
 *
 * As the joint's compliance goes to infinity, K loses one rank:
 *     K_free = K - (K p)(K p)' / (p' K p),   p the joint's lever at the tip.
 * The only force left goes through the joint's axis, along u (from the joint to the tip):
 *     K_free = u u' / (u' C u),   u' C u = cos^2 a / lambda_max + sin^2 a / lambda_min,
 * where a is the angle from the stiff axis to u. The code computes this form: its terms are positive, so nothing
 * cancels. With both gaps open no force is left, and K_free is zero.
 *
 * Bounds, as matrices: K_free <= K while a flank comes into contact <= K with the gap closed.
 * Pure functions; any thread or interrupt; no loop. A refused call leaves its outputs untouched.
 */
#ifndef BRACE_GAP_STIFFNESS_H
#define BRACE_GAP_STIFFNESS_H

#include "brace/kinematics.h"
#include "brace/stiffness.h"

/* Joints of the limb's plane whose gap is open, as bits. */
enum { BRACE_GAP_NONE = 0, BRACE_GAP_FEMUR = 1 << BRACE_FEMUR, BRACE_GAP_TIBIA = 1 << BRACE_TIBIA };

typedef struct {
    brace_stiffness_t now;     /* lower bound; while a gap is open: BRACE_FLAG_GAP_OPEN, lambda_min 0 */
    brace_stiffness_t engaged; /* upper bound: K once every gap has closed */
} brace_gap_stiffness_t;

/* K with the joints of `open` free.
 *   engaged: K with every gap closed, from any of the core's planar paths
 *   pose: levers at the same posture
 *   open: BRACE_GAP_... bits; without any bit now = engaged
 *   result (out): now.stiff_axis_rad is the direction of u; 0 with both open
 * flags of now: those of engaged, BRACE_FLAG_GAP_OPEN, and BRACE_FLAG_NEAR_SINGULAR with both open and the knee
 *   within 1e-3 of straight or folded. There the limb would still carry a force along the leg, and zero is the lower
 *   bound.
 * returns BRACE_OK, BRACE_E_SINGULAR (the tip lies within 1e-3 mm of the free joint's axis). Nothing else is checked,
 *   because the tick calls this with a K and a pose that the core has just computed. engaged must not lie in result.
 * accuracy: 3e-6 of lambda_max of K_free. Where u lies along the stiff axis of a slender K, add the error that follows
 *   from twice the stiff axis' error.
 * cost: at most 200 instructions on a Cortex-M4F; stack at most 200 bytes */
brace_status_t brace_gap_stiffness_known(const brace_stiffness_t *engaged, const brace_pose_t *pose, uint32_t open,
                                         brace_gap_stiffness_t *result);

#endif
