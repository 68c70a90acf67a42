/* K and C in the limb's plane at many postures at once, for any limb, on a host: columns in, columns out. The results
 * are those of brace/chain.h, bit for bit. brace/planar_batch.h is faster for the limbs that it serves.
 */
#ifndef BRACE_CHAIN_BATCH_H
#define BRACE_CHAIN_BATCH_H

#include <stddef.h>

#include "brace/chain.h"
#include "brace/planar_batch.h"

/* C's columns of n floats each. */
typedef struct {
    float *c_xx_mm_per_n;
    float *c_xz_mm_per_n;
    float *c_zz_mm_per_n;
} brace_compliance_soa_t;

/* Calls brace_chain_stiffness, and brace_chain_compliance where compliance is wanted, at n postures.
 * chain: from brace_chain_build. No argument but the last two is checked for null.
 * theta1_rad, theta2_rad: n true angles each, in the range of brace_chain_stiffness.
 * stiffness:  six columns. A posture that brace_chain_stiffness refuses gives NaN in all six and no flags; call that
 *             function for the one posture to learn why.
 * compliance: three columns, or null when C is not wanted. NaN where brace_chain_compliance refuses: C may exist
 *             where K does not.
 * flags:      n words of BRACE_FLAG_..., or null.
 * No column overlaps another or an input.
 * returns the number of postures without K.
 * Cost: 0.4 us a posture for six elements, 0.8 us with C (one core of an AMD EPYC, GCC 12). Stack: 0.5 KiB.
 * Thread rule: a pure function of its arguments; safe from any context once they are not written. */
size_t brace_chain_batch(const brace_chain_t *chain, size_t n, const float *theta1_rad, const float *theta2_rad,
                         const brace_stiffness_soa_t *stiffness, const brace_compliance_soa_t *compliance,
                         uint32_t *flags);

#endif
