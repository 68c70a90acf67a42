/* K in space: the limb's plane carried round by theta0, with what yields across that plane.
 *
 * In the frame of the limb's plane C falls into the plane's own 2 by 2 block (femur, tibia, joints 1 and 2,
 * the coxa link's bending and stretching, the base) and one compliance across it (joint 0, lateral bending
 * and torsion of the links). The block's part that depends on the knee alone is collapsed as for the planar
 * limb (brace/chain.h); what stands still in the plane, the coxa link and an unequal base, adds three terms v
 * v' to it, and det (A + v v') = det A + v' adj(A) v is a sum of positive terms again.
 *
 * Thread rule: pure functions of their arguments; safe from any context once the arguments are not written.
 */
#ifndef BRACE_SPATIAL_H
#define BRACE_SPATIAL_H

#include "brace/chain.h"
#include "brace/limb.h"
#include "brace/stiffness.h"

/* What a link yields across the plane under what lies beyond it: moment transfer per mm and mm^2 along the link,
 * torsion per mm^2 beside it. */
typedef struct {
    float per_mm, per_mm2, torsion;
} brace_aside_t;

/* A collapsed limb. Opaque; written by brace_spatial_collapse. */
typedef struct {
    brace_harmonics_t plane; /* femur, tibia, joints 1 and 2; iso, which is more, is beside them, not in them */
    brace_coxa_t coxa;       /* in the plane */
    brace_vec_t base;        /* where it yields more in one direction [sqrt(mm/N)] */
    float coxa_mm, femur_mm, tibia_mm;
    float yaw_rad_per_n_mm;  /* joint 0 */
    float across_mm_per_n;   /* lateral bending of the three links */
    brace_aside_t aside[2];  /* coxa, with the tip's distance and height; femur, with what is beyond the knee */
} brace_spatial_t;

/* The limb's constants; whenever its parameters change.
 * limb: any that brace_limb_check accepts. spatial: written on success only.
 * returns BRACE_OK or what brace_limb_check says.
 * Cost on a Cortex-M4F: at most 3,200 instructions; stack 168 bytes. RAM: 136 bytes a limb. */
brace_status_t brace_spatial_collapse(const brace_limb_t *limb, brace_spatial_t *spatial);

/* K, its eigenvalues, ascending, and the direction of the largest.
 * theta0_rad, theta1_rad, theta2_rad: true angles [rad, -7.9 to 7.9].
 * stiffness: written on success only. stiff_axis is a unit vector that points outwards in the limb's plane or, if
 *            the limb is stiffest across it, to the left.
 *            flags: BRACE_FLAG_NEAR_SINGULAR when C in the plane is so slender at the posture (its eigenvalues'
 *            ratio beyond 6,000) that the accuracy below is not promised.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE, or
 *         BRACE_E_SINGULAR: nothing yields across the plane, or in some direction in it.
 * Cost on a Cortex-M4F: 427 to 429 instructions, seven divisions and two roots among them; stack 144 bytes.
 *       Meant for controllers with an FPU: without one it is right, but slow.
 * Accuracy: K within 4e-6 of lambda_max and each eigenvalue within 4e-6 of itself (1e-5 promised), the axis an
 *       eigenvector as well.
 * Formula: docs/physics.md; moment transfer across the plane as in it. */
brace_status_t brace_spatial_stiffness(const brace_spatial_t *spatial, float theta0_rad, float theta1_rad,
                                       float theta2_rad, brace_stiffness_spatial_t *stiffness);

#endif
