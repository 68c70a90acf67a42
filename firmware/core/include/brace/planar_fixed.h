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
    uint64_t per_turn; /* per_cos in the low word, per_sin in the high one; twice as large: the trigonometry is q31 */
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
 * returns BRACE_OK, what brace_limb_check says, or BRACE_E_UNSUPPORTED: the base yields unequally in x and z, or
 *         C is so slender at some posture, or so far from 1 mm/N, that the stated accuracy can not be kept;
 *         brace_chain_stiffness serves such a limb.
 * Cost: once per parameter change; uses float, in software where there is no FPU. */
brace_status_t brace_planar_fixed_collapse(const brace_limb_t *limb, brace_planar_fixed_t *fixed);

/* K, its eigenvalues and the stiff axis.
 * theta1_rad_q28, theta2_rad_q28: true angles [rad * 2^28, every int32: -8 rad to 8 rad].
 * stiffness: written on success only.
 * returns BRACE_OK, BRACE_E_NULL. */
brace_status_t brace_planar_fixed_stiffness(const brace_planar_fixed_t *fixed, int32_t theta1_rad_q28,
                                            int32_t theta2_rad_q28, brace_stiffness_t *stiffness);

#endif
