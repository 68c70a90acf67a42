/* K in the limb's plane on a controller without a floating-point unit. The tick uses 32-bit integers only. At the end
 * it builds IEEE floats by shifts, so that the result has the same type as that of the float path.
 *
 * There are two steps, as on every path. When parameters change, collapse the limb; this uses floating point, in
 * software if there is no FPU. In every tick, evaluate: no floating point, no call, no branch that depends on the data.
 */
#ifndef BRACE_PLANAR_FIXED_H
#define BRACE_PLANAR_FIXED_H

#include <stdint.h>

#include "brace/fixed_harmonic.h"
#include "brace/limb.h"
#include "brace/stiffness.h"

/* One limb, ready for the tick. brace_planar_fixed_collapse writes it; other code must not read its members. */
typedef struct {
    brace_fixed_harmonic_t mean;        /* trace of C */
    brace_fixed_harmonic_t minus_dev_x; /* deviator of C along the bisector, negated */
    brace_fixed_harmonic_t dev_z;       /* deviator of C across the bisector */
    brace_fixed_harmonic_t cross;       /* det C = cross^2 + rest rest_weight */
    brace_fixed_harmonic_t rest;
    int32_t rest_weight;
    uint32_t exponent_k; /* exponent fields of IEEE floats, before the shift that normalises a number is subtracted */
    uint32_t exponent_min;
    uint32_t flags;
} brace_planar_fixed_t;

/* The limb's fifteen constants as scaled integers.
 * limb: any that brace_limb_check accepts. fixed: written on success only.
 * returns BRACE_OK, what brace_limb_check says, or
 *         BRACE_E_UNSUPPORTED: the base yields unequally in x and z; or C is so slender at some posture (det C
 *         below 2.5e-7 of the largest mean^2) that 32 bits do not hold it; or C is too far from 1 mm/N (mean compliance
 *         outside 1e-7 to 1e7); or what was made might leave a word at some knee angle, or give a K that is not
 *         positive (no case of it is known). brace_chain_stiffness serves such a limb.
 * Cost: once per parameter change; float and double, in software where there is no FPU: at most 144,000
 *       instructions on a Cortex-M3, stack 888 bytes. RAM: 96 bytes a limb. */
brace_status_t brace_planar_fixed_collapse(const brace_limb_t *limb, brace_planar_fixed_t *fixed);

/* K, its eigenvalues and the stiff axis.
 * theta1_rad_q28, theta2_rad_q28: true angles [rad * 2^28]; every int32 is valid, from -8 rad to 8 rad.
 * stiffness: written on success only. stiff_axis_rad: [-pi/2, pi/2). Where the eigenvalues are equal to within 1e-5,
 *            the axis is less exact the closer they are.
 *            flags: BRACE_FLAG_NEAR_SINGULAR when the limb is so slender or so uneven that the accuracy below is
 *            not promised.
 * returns BRACE_OK, BRACE_E_NULL.
 * Cost on a Cortex-M3: 237 instructions at every posture (GCC 12, -O2), one division (udiv) and no call among
 *       them; stack 48 bytes; flash 1,920 bytes with its tables.
 * Thread rule: a pure function of its arguments; safe from any context once they are not written.
 * Accuracy: K within 5e-7 of lambda_max, the eigenvalues within 5e-7 of themselves (2e-6 and 5e-6 promised), the
 *       axis within 3e-7 rad / (1 - lambda_min/lambda_max). Floats are rounded towards zero.
 * Formula: the harmonic form of brace/chain.h. */
brace_status_t brace_planar_fixed_stiffness(const brace_planar_fixed_t *fixed, int32_t theta1_rad_q28,
                                            int32_t theta2_rad_q28, brace_stiffness_t *stiffness);

#endif
