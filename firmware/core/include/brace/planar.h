/* K of the planar limb in the tick: a limb collapsed into constants, and their evaluation at a posture.
 *
 * With h = theta2/2, half the knee angle, seen from the bisector of femur and tibia:
 *     C = mean I + [[dev_x, dev_z], [dev_z, -dev_x]],      det C = rest + cross^2,
 * where mean, dev_x and dev_z are harmonics of the knee angle (brace/harmonics.h). K, both eigenvalues and the stiff
 * axis follow with one root and two divisions. docs/kernel.md has the formula beside the code.
 */
#ifndef BRACE_PLANAR_H
#define BRACE_PLANAR_H

#include "brace/harmonics.h"
#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* A collapsed limb. brace_planar_collapse writes it, brace_planar_stiffness reads it; other code must not read its
 * members. */
typedef struct {
    brace_harmonic_t mean;  /* half the trace of C [mm/N] */
    brace_harmonic_t dev_x; /* deviator of C along the bisector [mm/N] */
    brace_harmonic_t dev_z; /* deviator of C across the bisector [mm/N] */
    /* cross = cross_least + cross_factor (sin h - zero_tan cos h) (cos h - zero_cot sin h) [mm/N] */
    float cross_least, cross_factor, zero_tan, zero_cot;
    float rest_constant, rest_per_mean; /* rest = rest_constant + rest_per_mean mean [(mm/N)^2] */
} brace_planar_t;

/* Collapses a limb into the tick's constants. Call it when parameters change.
 * limb: one that brace_limb_check accepts; a broken limb is refused here only as far as the constants show it.
 * planar: written on success only.
 * returns BRACE_OK, BRACE_E_NULL,
 *         BRACE_E_PARAMETER: no limb has these constants (not finite, or C not positive),
 *         BRACE_E_UNSUPPORTED: the base yields unequally in x and z, or C is so slender at some posture that the
 *         accuracy below cannot be promised; brace/general.h serves such a limb.
 * Cost on a Cortex-M4F: at most 3,000 instructions (2,022 measured), 360 bytes of stack. Any thread; not while a tick
 * reads planar. */
brace_status_t brace_planar_collapse(const brace_limb_t *limb, brace_planar_t *planar);

/* K with eigenvalues and stiff axis at a posture.
 * planar, stiffness: not null (not checked: this runs in every tick).
 * theta1_rad, theta2_rad: true angles, theta1^2 + theta2^2 <= BRACE_REACH_RAD2.
 * stiffness: written on success only; flags are 0.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE (NaN, infinity, and angles whose square overflows).
 * Accuracy: each entry of K within 2e-6 of lambda_max, both eigenvalues within 2e-6 of themselves, the stiff axis
 * within 1e-6 rad times lambda_max / (lambda_max - lambda_min).
 * Cost on a Cortex-M4F: the same straight line of at most 170 instructions for every posture, 40 bytes of stack.
 * Reentrant; any thread or interrupt that may use the FPU. */
brace_status_t brace_planar_stiffness(const brace_planar_t *planar, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness);

#endif
