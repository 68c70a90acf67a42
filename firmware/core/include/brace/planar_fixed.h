/* K in the limb's plane on a controller without a floating-point unit: 32-bit integers all the way, IEEE
 * floats built by shifts at the end, so that the result is the same type that the float path gives.
 *
 * Two steps, as everywhere: collapse the limb once when its parameters change (floating point, in software
 * if need be), then evaluate at every tick (no floating point, no call, no branch that depends on the data).
 */
#ifndef BRACE_PLANAR_FIXED_H
#define BRACE_PLANAR_FIXED_H

#include <stdint.h>

#include "brace/limb.h"
#include "brace/stiffness.h"

/* A function of the knee angle, constant + per_cos cos theta2 + per_sin sin theta2, scaled to integers. */
typedef struct {
    int64_t constant;  /* q32 of the result's unit, half a unit added to round */
    uint64_t per_turn; /* per_cos in the low word, per_sin in the high one; doubled: the trigonometry is q31 */
} brace_fixed_harmonic_t;

/* One limb, ready for the tick. Opaque; written by brace_planar_fixed_collapse. */
typedef struct {
    brace_fixed_harmonic_t mean;        /* trace of C */
    brace_fixed_harmonic_t minus_dev_x; /* deviator of C along the bisector, negated, */
    brace_fixed_harmonic_t dev_y;       /* and across it */
    brace_fixed_harmonic_t cross;       /* det C = cross^2 + rest rest_weight */
    brace_fixed_harmonic_t rest;
    int32_t rest_weight;
    uint32_t exponent_k; /* exponent fields of IEEE floats, before normalisation is taken off */
    uint32_t exponent_min;
    uint32_t flags;
} brace_planar_fixed_t;

/* The limb's fifteen constants as scaled integers.
 * limb: any that brace_limb_check accepts. fixed: written on success only.
 * returns BRACE_OK, what brace_limb_check says, or
 *         BRACE_E_UNSUPPORTED: the base yields unequally in x and z; or C is so slender at some posture (det C
 *         below 2.5e-7 of the largest mean^2) that 32 bits do not hold it; or so far from 1 mm/N (mean compliance
 *         beyond 1e-7 to 1e7). brace_chain_stiffness serves such a limb.
 * Cost: once per parameter change; float and double, in software where there is no FPU: at most 134,000
 *       instructions on a Cortex-M3, stack 632 bytes. RAM: 96 bytes a limb. */
brace_status_t brace_planar_fixed_collapse(const brace_limb_t *limb, brace_planar_fixed_t *fixed);

/* K, its eigenvalues and the stiff axis.
 * theta1_rad_q28, theta2_rad_q28: true angles [rad * 2^28; every int32, that is -8 rad to 8 rad, is one].
 * stiffness: written on success only. stiff_axis_rad: [-pi/2, pi/2); where the eigenvalues are equal to within
 *            1e-5 it is the less determined the closer they are.
 *            flags: BRACE_FLAG_NEAR_SINGULAR when the limb is so slender or so uneven that the accuracy below is
 *            not promised.
 * returns BRACE_OK, BRACE_E_NULL.
 * Cost on a Cortex-M3: 238 instructions at every posture (GCC 12, -O2), one division (udiv) and no call among
 *       them; stack 48 bytes; flash 1,896 bytes with its tables.
 * Thread rule: a pure function of its arguments; safe from any context once they are not written.
 * Accuracy: K within 5e-7 of lambda_max, the eigenvalues within 5e-7 of themselves (2e-6 and 5e-6 promised), the
 *       axis within 3e-7 rad / (1 - lambda_min/lambda_max). Floats are rounded towards zero.
 * Formula: the harmonic form of brace/chain.h. */
brace_status_t brace_planar_fixed_stiffness(const brace_planar_fixed_t *fixed, int32_t theta1_rad_q28,
                                            int32_t theta2_rad_q28, brace_stiffness_t *stiffness);

#endif
