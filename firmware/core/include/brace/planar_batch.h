/* K in the limb's plane at many postures at once, for maps and fits on a host: columns in, columns out. Compilers turn
 * its loop into vector instructions. It serves the same limbs as brace/planar.h, by the same formula.
 */
#ifndef BRACE_PLANAR_BATCH_H
#define BRACE_PLANAR_BATCH_H

#include <stddef.h>

#include "brace/planar.h"

/* Where the results go: six columns of n floats each, none of which overlaps another or an input. */
typedef struct {
    float *k_xx_n_per_mm;
    float *k_xz_n_per_mm;
    float *k_zz_n_per_mm;
    float *lambda_min_n_per_mm;
    float *lambda_max_n_per_mm;
    float *stiff_axis_rad;
} brace_stiffness_soa_t;

/* K, its eigenvalues and the stiff axis at n postures. No argument is checked for null.
 * planar: from brace_planar_collapse.
 * theta1_rad, theta2_rad: n true angles each [rad, -7.9 to 7.9]. A posture out of range, or NaN, gives NaN in all six
 *                         columns.
 * returns the number of such postures.
 * Cost: 1.5 ns a posture (one core of an AMD EPYC, GCC 12, AVX-512; columns in the cache: some thousand postures a
 *       call). Stack: 7 KiB.
 * Thread rule: a pure function of its arguments; safe from any context once they are not written.
 * Accuracy: as brace_planar_stiffness. Its bits may differ between processors, because some fuse products and sums. */
size_t brace_planar_batch(const brace_planar_t *planar, size_t n, const float *theta1_rad, const float *theta2_rad,
                          const brace_stiffness_soa_t *stiffness);

#endif
