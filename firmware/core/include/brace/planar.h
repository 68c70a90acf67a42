/* K of the planar limb at the tick: a limb collapsed into constants, and their evaluation at a posture.
 *
 * det C = rest_per_mean mean + rest + cross^2 and the deviator of C are first harmonics of the knee angle; K, both
 * eigenvalues and the stiff axis follow with one square root and one division. Angles, harmonics and the axis are
 * integers (exact near the straight and the folded knee), K and eigenvalues floats.
 * Formulas: brace/chain.h and docs/kernel.md.
 */
#ifndef BRACE_PLANAR_H
#define BRACE_PLANAR_H

#include <stdint.h>

#include "brace/chain.h"
#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* The angles' reach: theta1^2 + theta2^2 <= this [rad^2]. Both may lie anywhere within [-3.9, 3.9]. */
#define BRACE_PLANAR_REACH_RAD2 31.0f

/* A first harmonic of the knee angle in fixed point; the factors are those of minus the cosine and minus the sine. */
typedef struct {
    int32_t constant, per_cos, per_sin;
} brace_planar_harmonic_t;

/* A collapsed limb. Written by brace_planar_collapse, read by the tick; nothing in it is for others. */
typedef struct {
    const int32_t *sine, *cosine; /* tables of the tick, carried along: one load brings both addresses */
    const void *axis;
    brace_planar_harmonic_t mean, dev_x, dev_y, cross;
    float rest_per_mean, rest;
    float per_unit_n_per_mm; /* one over the compliance of one unit of the last place */
    float slope_per_unit;    /* nearly 2^31 over that: undoes it for the axis */
} brace_planar_t;

/* Collapses a limb into the tick's constants; to be called when parameters change.
 * limb: one that brace_limb_check accepts; what a broken one leads to is refused here only as far as it shows in
 *       the constants. planar: written on success only.
 * returns BRACE_OK, BRACE_E_NULL,
 *         BRACE_E_PARAMETER: the constants are no limb's (not finite, or C not positive),
 *         BRACE_E_UNSUPPORTED: the base yields unequally in x and z, or C is so slender at some posture that the
 *         accuracy of the tick cannot be promised; brace_chain_stiffness serves such a limb.
 * Cost on a Cortex-M4F: at most 3,000 instructions, 256 bytes of stack. Any thread; not while a tick reads planar. */
brace_status_t brace_planar_collapse(const brace_limb_t *limb, brace_planar_t *planar);

/* K with eigenvalues and stiff axis at a posture.
 * planar, stiffness: not null (not checked: this is the tick).
 * theta1_rad, theta2_rad: true angles, theta1^2 + theta2^2 <= BRACE_PLANAR_REACH_RAD2.
 * stiffness: written on success only; flags are 0.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE (NaN, infinity, and angles whose square overflows).
 * Accuracy: each entry of K within 2e-6 of lambda_max, both eigenvalues within 2e-6 of themselves, the stiff axis
 * within 1e-6 rad times lambda_max / (lambda_max - lambda_min).
 * Cost on a Cortex-M4F: the same straight line of at most 140 instructions for every posture, 230 cycles by the
 * manual's table, 40 bytes of stack. Reentrant; any thread or interrupt that may use the FPU. */
brace_status_t brace_planar_stiffness(const brace_planar_t *planar, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness);

#endif
