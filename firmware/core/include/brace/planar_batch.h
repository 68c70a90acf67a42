/* K in the limb's plane at many postures at once, for maps and fits on a host: columns in, columns out, in a
 * loop that compilers turn into vector instructions. The same model as brace/planar.h.
 */
#ifndef BRACE_PLANAR_BATCH_H
#define BRACE_PLANAR_BATCH_H

#include <stddef.h>

#include "brace/chain.h"
#include "brace/limb.h"
#include "brace/stiffness.h"

/* A collapsed limb. Opaque but for flags; written by brace_planar_batch_collapse. */
typedef struct {
    brace_harmonic_t mean, dev_x, dev_y, rest; /* their per_cos and per_sin doubled */
    /* the harmonic form's cross, as cross_least + cross_swing sin(theta2/2 - zero[0]) sin(theta2/2 -
     * zero[1]): exact where it vanishes; each zero as a float and what the float leaves [rad] */
    float cross_least, cross_swing;
    float zero_rad[2], zero_rest_rad[2];
    int upright; /* nothing is tilted: the zeros are the straight and the folded knee */
    uint32_t flags; /* of every result; BRACE_FLAG_NEAR_SINGULAR: so slender that the accuracy is not promised */
} brace_planar_batch_t;

/* Where the results go: six columns of n floats each, none of which overlaps another or an input. */
typedef struct {
    float *k_xx_n_per_mm;
    float *k_xz_n_per_mm;
    float *k_zz_n_per_mm;
    float *lambda_min_n_per_mm;
    float *lambda_max_n_per_mm;
    float *stiff_axis_rad;
} brace_stiffness_soa_t;

/* The limb's constants; whenever its parameters change. Uses libm: meant for hosts.
 * limb: any that brace_limb_check accepts. batch: written on success only.
 * returns BRACE_OK, what brace_limb_check says, or
 *         BRACE_E_UNSUPPORTED: the base yields unequally in x and z, or C is so slender at some posture that
 *         single precision does not hold its inverse. */
brace_status_t brace_planar_batch_collapse(const brace_limb_t *limb, brace_planar_batch_t *batch);

/* K, its eigenvalues and the stiff axis at n postures. No argument is checked for null.
 * theta1_rad, theta2_rad: n true angles each [rad, -7.9 to 7.9]. A posture outside, or NaN, gives NaN in all six
 *                         columns.
 * returns the number of such postures.
 * Cost: 1.6 ns a posture, 2.0 ns with tilted links (one core of an AMD EPYC, GCC 12, AVX-512; 1.9 and 2.3 ns with
 *       AVX2, 5.3 and 6.4 ns with SSE2; columns in the cache: some thousand postures a call). Stack: 7 KiB.
 * Thread rule: a pure function of its arguments; safe from any context once they are not written.
 * Accuracy: K within 1.5e-6 of lambda_max, the eigenvalues within 1.5e-6 of themselves (2e-6 promised), the axis
 *       within 7e-7 rad / (1 - lambda_min/lambda_max). Its bits may differ between processors: sums are fused
 *       where they can be.
 * Formula: the harmonic form of brace/chain.h. */
size_t brace_planar_batch(const brace_planar_batch_t *batch, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const brace_stiffness_soa_t *stiffness);

#endif
