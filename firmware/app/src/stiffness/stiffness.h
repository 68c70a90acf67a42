/* K of this tick, with its flags: what is computed from posture, springs and open gaps, and when it may be used. */
#ifndef BRACE_STIFFNESS_STIFFNESS_H
#define BRACE_STIFFNESS_STIFFNESS_H

#include "brace/snapshot.h"
#include "flank/flank.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "stiffness/model.h"

/* K that nobody may use: NaN, with these flags. */
void stiffness_unknown(brace_snapshot_t *snapshot, uint32_t flags);

/* K of this tick, in the limb's plane and, with a coxa joint, in space.
 *   snapshot (out): stiffness, k_is_valid, space
 * Flags: UNCALIBRATED (safe defaults), STALE (no sound samples), OUT_OF_RANGE (outside a drive's travel),
 * NEAR_SINGULAR (the posture has no finite K), GAP_OPEN, and the model's own. At most 900 instructions; 1,200 for a
 * limb in space. */
void stiffness_take(model_t *model, const brace_parameters_t *parameters, brace_parameter_origin_t origin,
                    const joints_t *joints, const flank_t *flank, const posture_t *posture,
                    brace_snapshot_t *snapshot);

#endif
