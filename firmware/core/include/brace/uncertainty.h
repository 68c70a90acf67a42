/* How exactly K is known, given how exactly the limb's parameters are known: in the limb's plane, at no load. Under a
 * load and in space: brace/uncertainty_causes.h.
 *
 * The one-sigma figures in brace_limb_t.uncertainty are propagated to first order through C and its inverse,
 * dK = -K dC K. These are taken as independent of each other:
 *   - femur and tibia length, each with length_mm;
 *   - the joint angles theta1 and theta2, each with angle_rad;
 *   - nine compliances, each with compliance_rel of itself: femur and tibia axial and bending, joint femur
 *     and joint tibia, base x, z and rotation. A femur's moment transfer grows with its bending;
 *   - the gain of the force sensor that the calibration used, gain_rel: a factor on the whole of K.
 * These are taken as exact: tilts, the strength of moment transfer, and the chain itself. Parameters that act only in
 * space (coxa, lateral, torsion) play no part in the plane.
 */
#ifndef BRACE_UNCERTAINTY_H
#define BRACE_UNCERTAINTY_H

#include "brace/limb.h"
#include "brace/stiffness.h"

/* pi / sqrt(12): one sigma of an axis that may point anywhere. */
#define BRACE_UNKNOWN_AXIS_RAD 0.906899682f

/* One sigma of each entry of a brace_stiffness_t, all >= 0. */
typedef struct {
    float k_xx_n_per_mm;
    float k_xz_n_per_mm;
    float k_zz_n_per_mm;
    float lambda_min_n_per_mm;
    float lambda_max_n_per_mm;
    float stiff_axis_rad; /* at most BRACE_UNKNOWN_AXIS_RAD */
    uint32_t flags;       /* the flags of K; BRACE_FLAG_SATURATED when stiff_axis_rad is at its limit */
} brace_stiffness_sigma_t;

/* One sigma of K in space, its entries in the robot's frame, all >= 0. brace/uncertainty_causes.h works it out. */
typedef struct {
    float k_xx_n_per_mm, k_xy_n_per_mm, k_xz_n_per_mm;
    float k_yy_n_per_mm, k_yz_n_per_mm, k_zz_n_per_mm;
    float lambda_n_per_mm[3]; /* of the eigenvalues, which ascend */
    float across_n_per_mm;    /* of K across the limb's plane */
} brace_space_sigma_t;

/* One sigma of K at a posture.
 *   limb: checked with brace_limb_check
 *   theta1_rad, theta2_rad: true joint angles [+-7.9 rad]
 *   stiffness: K of this limb at this posture, from any path
 *   sigma (out)
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER (limb), BRACE_E_NOT_FINITE, BRACE_E_RANGE (an angle, or a
 *   stiffness whose eigenvalues are not positive and in order); sigma untouched unless BRACE_OK.
 * accuracy of the first-order figure: with e = 3e-6 + 5e-7 s, s = sqrt(lambda_max/lambda_min), and
 *   g = angle_rad + length_mm / shorter link: e (sigma + g lambda_min) for lambda_min,
 *   e (sigma + g s lambda_max) for lambda_max and the entries of K, e (sigma + g) for the axis unless K is
 *   nearly round. The first order itself is right to some per cent where compliances are trusted to 5 %, lengths
 *   to 0.5 mm and angles to 3 mrad.
 * cost: a fixed list of 28 terms; at most 3,400 instructions on a Cortex-M4F; stack at most 256 bytes.
 * Pure and re-entrant: any thread or interrupt may call it. */
brace_status_t brace_uncertainty_stiffness(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                           const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma);

/* The same for the tick. It checks neither the limb, which has passed brace_limb_check, nor that outputs are not null.
 * Cost on a Cortex-M4F: at most 2,500 instructions. */
brace_status_t brace_uncertainty_known(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                       const brace_stiffness_t *stiffness, brace_stiffness_sigma_t *sigma);

#endif
