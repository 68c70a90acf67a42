/* K of any planar limb at the tick, its joints' springs as they are at the moment.
 *
 * When parameters change the limb becomes five elements (brace/chain.h), halved, and what the base yields. Each
 * tick starts from the base and adds the elements one by one, both joints' springs among them, as C + v v' each,
 * whose determinant is a sum of positive terms.
 */
#ifndef BRACE_GENERAL_H
#define BRACE_GENERAL_H

#include "brace/chain.h"

/* Written by brace_general_collapse; nothing in it is for others. */
typedef struct {
    float mean_mm_per_n, dev_mm_per_n, det; /* of the base and of what yields equally in every direction */
    brace_swing_t element[BRACE_CHAIN_FIRM]; /* halved; both joints as springs of 1 rad/(N mm) */
} brace_general_t;

/* Collapses all of a limb but its joints' springs and its base's rotation; to be called when parameters change.
 * limb: one that brace_limb_check accepts. general, limb: not null.
 * Cost on a Cortex-M4F: at most 420 instructions; 80 bytes of stack. */
void brace_general_collapse(const brace_limb_t *limb, brace_general_t *general);

/* K at a posture, with the flags and statuses of brace_chain_stiffness.
 * Accuracy: as there while det C is above 1e-3 of the squared half trace, ten times less down to where it is flagged.
 *   hip_rad_per_n_mm: the femur joint's compliance and the base's rotation; knee_rad_per_n_mm: the tibia joint's; >= 0
 *   general, stiffness: not null (not checked: this is the tick)
 * Cost on a Cortex-M4F: at most 380 instructions; 72 bytes of stack. */
brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness);

#endif
