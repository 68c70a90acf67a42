/* K of any limb in its plane, with the present compliances of its joints' springs: the general path.
 *
 * When parameters change, the links become three elements (brace/element.h), and a base that yields unequally becomes
 * one vector. The compliance that is equal in every direction becomes the number iso. The tick adds these and the
 * joints' springs one by one: C = iso I + sum v v'. This path serves every limb. brace/planar.h is shorter for limbs
 * whose springs and base allow it (docs/kernel.md says when).
 */
#ifndef BRACE_GENERAL_H
#define BRACE_GENERAL_H

#include "brace/element.h"
#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* brace_general_collapse writes it; other code must not read its members. */
typedef struct {
    float iso_mm_per_n; /* the compliance that is equal in every direction */
    brace_vec_t base;   /* in the robot's frame [sqrt(mm/N)] */
    brace_element_t element[BRACE_LINK_ELEMENT_COUNT];
    float femur_mm, tibia_mm;
} brace_general_t;

/* Collapses a limb, except its joints' springs and its base's rotation. Call it when parameters change.
 * limb: one that brace_limb_check accepts. general, limb: not null.
 * Cost on a Cortex-M4F: at most 420 instructions; 80 bytes of stack. */
void brace_general_collapse(const brace_limb_t *limb, brace_general_t *general);

/* K at a posture.
 * general, stiffness: not null (not checked: this runs in the tick).
 * theta1_rad, theta2_rad: true angles, theta1^2 + theta2^2 <= BRACE_REACH_RAD2.
 * hip_rad_per_n_mm: the femur joint's compliance and the base's rotation; knee_rad_per_n_mm: the tibia joint's; >= 0.
 * stiffness: written on success only. flags: BRACE_FLAG_NEAR_SINGULAR when C is so slender (det C below 2e-5 of the
 * squared half trace) that the accuracy is not promised.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE (NaN, infinity, and angles whose square overflows),
 *         BRACE_E_SINGULAR: nothing yields in some direction.
 * Accuracy: each entry of K within 2e-6 of lambda_max, eigenvalues within 2e-6 of themselves, stiff axis within 1e-6
 * rad times lambda_max / (lambda_max - lambda_min), unless flagged.
 * Cost on a Cortex-M4F: at most 380 instructions; 72 bytes of stack. */
brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness);

/* C at the same posture and its determinant [(mm/N)^2], in which nothing cancels. Returns the same statuses except
 * BRACE_E_SINGULAR, because C exists where K does not. */
brace_status_t brace_general_compliance(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                        float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_compliance_t *compliance,
                                        float *det);

#endif
