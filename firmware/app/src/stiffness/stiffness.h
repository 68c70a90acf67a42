/* K of this tick, with its flags: what is computed from posture, springs and open gaps, and when it may be used. */
#ifndef BRACE_STIFFNESS_STIFFNESS_H
#define BRACE_STIFFNESS_STIFFNESS_H

#include "brace/snapshot.h"
#include "flank/flank.h"
#include "posture/gravity.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "stiffness/model.h"
#include "stiffness/softening.h"

/* Nobody knows how exactly K is known: NaN. */
void stiffness_unknown_sigma(brace_snapshot_t *snapshot);

/* K that nobody may use: NaN, with these flags. */
void stiffness_unknown(brace_snapshot_t *snapshot, uint32_t flags);

/* How each joint's spring yields now, at its load and temperature. At most 260 instructions. */
void stiffness_springs_of_now(model_t *model, const brace_parameters_t *parameters, const joints_t *joints,
                              const flank_t *flank, brace_loaded_joint_t springs[BRACE_LINK_COUNT]);

/* For K at the present posture: a joint whose true angle is measured behind its spring has nowhere to be turned to. */
void stiffness_hold_measured_joints(const posture_t *posture, brace_loaded_joint_t springs[BRACE_LINK_COUNT]);

/* K of this tick, in the limb's plane and, with a coxa joint, in space. It is K at the equilibrium under the tip's
 * force and the limb's weight, where the force is known; the posture goes to that equilibrium.
 *   softening: what it has found of a limb in space is read; (in, out): where the limb rests
 *   snapshot: its forces are read; (out): stiffness, k_is_valid, space, load
 *   is_calibrated: the parameters are of this limb as it was measured last
 * Flags: UNCALIBRATED, STALE (no sound samples; with a valid K: samples so
 * old that their joints stand elsewhere by now), OUT_OF_RANGE (outside a drive's travel, or the encoders of a joint
 * contradict each other, or the springs follow a temperature that is not known), LOAD_UNKNOWN (no load is counted),
 * GAP_OPEN, and the model's own. Where there is no K: NEAR_SINGULAR (nothing yields in some
 * direction, or the force is beyond what the estimator takes), with SOFTENED where no stable equilibrium is near. At
 * most 3,600 instructions; 8,000 for a limb in space. */
void stiffness_take(model_t *model, const brace_parameters_t *parameters, bool is_calibrated, const joints_t *joints,
                    const flank_t *flank, const gravity_t *gravity, softening_t *softening, posture_t *posture,
                    brace_snapshot_t *snapshot);

#endif
