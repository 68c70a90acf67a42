/* K of any planar limb at the tick, its joints' springs as they are at the moment.
 *
 * What a tick of the general path (brace/chain.h) would work out anew each time is worked out here when parameters change:
 * seen from the bisector of femur and tibia, all that is firm is a quadratic in the half knee angle's cosine and sine, and
 * so is the cross of each pair of elements, of which det C is the sum of squares. Both joints' springs are weights.
 */
#ifndef BRACE_GENERAL_H
#define BRACE_GENERAL_H

#include "brace/chain.h"

/* femur and tibia ellipsoids, the femur's moment transfer; with them the springs of both joints */
enum { BRACE_GENERAL_FIRM = 3, BRACE_GENERAL_PAIRS = 10 };

/* With h = theta2/2: straight^2 cos^2 h + both cos h sin h + folded^2 sin^2 h. */
typedef struct {
    float straight, both, folded;
} brace_quadratic_t;

/* A cross of two elements: at_fold + per_cos cos^2 h + per_sin cos h sin h. */
typedef struct {
    float at_fold, per_cos, per_sin;
} brace_cross_t;

/* Written by brace_general_collapse; nothing in it is for others. */
typedef struct {
    float iso_mm_per_n, femur_mm, tibia_mm;
    brace_quadratic_t mean, dev_x, dev_y;       /* of what is firm [mm/N] */
    brace_cross_t cross[BRACE_GENERAL_PAIRS];   /* firm with firm, hip with firm, knee with firm, knee with hip */
    brace_element_t firm[BRACE_GENERAL_FIRM];   /* straight (in .femur) and folded (in .tibia), for the base */
    brace_vec_t base;                           /* where it yields more in one direction; sqrt(mm/N) */
} brace_general_t;

/* Collapses all of a limb but its joints' springs and its base's rotation; to be called when parameters change.
 * limb: one that brace_limb_check accepts. general, limb: not null. At most 1,600 instructions. */
void brace_general_collapse(const brace_limb_t *limb, brace_general_t *general);

/* K at a posture, with the flags and statuses of brace_chain_stiffness.
 * Accuracy: as there while det C is above 1e-3 of the squared half trace, ten times less down to where it is flagged.
 *   hip_rad_per_n_mm: the femur joint's compliance and the base's rotation; knee_rad_per_n_mm: the tibia joint's; >= 0
 *   general, stiffness: not null (not checked: this is the tick)
 * Cost on a Cortex-M4F: at most 450 instructions; 150 bytes of stack. */
brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness);

#endif
