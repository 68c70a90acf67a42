/* K at the tip from the joint angles: the result types. The functions are in brace/planar.h and brace/general.h.
 *
 * K takes two steps. When parameters change, brace_planar_collapse turns the limb's compliance chain into a few
 * constants (some thousand instructions). Each tick, brace_planar_stiffness evaluates them at the posture, with a fixed
 * number of instructions that is the same for every posture.
 */
#ifndef BRACE_STIFFNESS_H
#define BRACE_STIFFNESS_H

#include <stddef.h>
#include <stdint.h>

#include "brace/limb.h"

/* K in the limb's plane, f = K d; x outwards, z up. Float and fixed point give the same type. */
typedef struct {
    float k_xx_n_per_mm;
    float k_xz_n_per_mm;
    float k_zz_n_per_mm;
    float lambda_min_n_per_mm; /* smaller eigenvalue of K, > 0; 0 while a gap is open; any sign in a measured K */
    float lambda_max_n_per_mm; /* larger eigenvalue of K */
    float stiff_axis_rad;      /* direction of lambda_max from +x, [-pi/2, pi/2] */
    uint32_t flags;            /* BRACE_FLAG_... */
} brace_stiffness_t;

/* C = K^-1 in the limb's plane. */
typedef struct {
    float c_xx_mm_per_n;
    float c_xz_mm_per_n;
    float c_zz_mm_per_n;
} brace_compliance_t;

/* K in the frame of the robot's base: right-handed, z up. At theta0 = 0 the limb's plane is x, z. */
typedef struct {
    float k_xx_n_per_mm, k_xy_n_per_mm, k_xz_n_per_mm;
    float k_yy_n_per_mm, k_yz_n_per_mm, k_zz_n_per_mm;
    float lambda_n_per_mm[3]; /* eigenvalues of K, ascending */
    float stiff_axis[3];      /* unit vector of the largest eigenvalue */
    uint32_t flags;
} brace_stiffness_spatial_t;

#endif
