/* The limb as its calibration describes it: lengths, compliances, and how far each is trusted.
 *
 * Units: mm, N, N mm, rad. docs/physics.md defines frames and signs. All members are plain floats, so that the model
 * file, the parameter block on the controller and the simulation carry the same facts.
 *
 * The structs (brace/limb_fields.h) and the range of each member (brace/ranges.h) are generated from the dictionary,
 * firmware/interface/dictionary.toml.
 */
#ifndef BRACE_LIMB_H
#define BRACE_LIMB_H

#include "brace/limb_fields.h"
#include "brace/status.h"

/* Joint angles of kinematics and of K in space lie in [-BRACE_ANGLE_LIMIT_RAD, BRACE_ANGLE_LIMIT_RAD], a turn and a
 * quarter each way. Angles of K in the plane have theta1^2 + theta2^2 <= BRACE_REACH_RAD2, so both may lie anywhere in
 * [-3.9, 3.9]. */
#define BRACE_ANGLE_LIMIT_RAD 7.9f
#define BRACE_REACH_RAD2 31.0f

/* Can this limb exist? Every field has to be finite and in its range (BRACE_RANGE_...), the limb has to yield in each
 * direction of the plane, and a coxa that passes moments on has to be at least 1 mm long.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_PARAMETER */
brace_status_t brace_limb_check(const brace_limb_t *limb);

/* The same for a limb whose every field is known to be finite and in its range. At most 100 instructions.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER */
brace_status_t brace_limb_check_together(const brace_limb_t *limb);

/* Checks only the lengths: coxa [0, 1e4 mm], femur and tibia [1, 1e4 mm].
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER (NaN and infinity too) */
brace_status_t brace_limb_check_lengths(const brace_limb_t *limb);

/* The true angle of joint `index` (BRACE_COXA..BRACE_TIBIA) when its commanded angle is given [rad]. */
float brace_limb_true_angle(const brace_limb_t *limb, int index, float commanded_rad);

#endif
