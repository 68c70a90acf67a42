/* det C of a chain as rest + cross^2 in double precision: near where the cross vanishes a slender, tilted
 * limb's det is known no better than the cross's constants are, whatever the tick's arithmetic. For collapses
 * that need not be fast. */
#ifndef BRACE_FIXED_DET_H
#define BRACE_FIXED_DET_H

#include "brace/chain.h"

/* constant + per_cos cos theta2 + per_sin sin theta2 */
typedef struct {
    double constant, per_cos, per_sin;
} brace_det_harmonic_t;

typedef struct {
    brace_det_harmonic_t rest;  /* [(mm/N)^2] */
    brace_det_harmonic_t cross; /* [mm/N] */
} brace_det_t;

/* element: count of them [0, BRACE_CHAIN_MAX], halved. */
brace_det_t brace_det_of(float iso, const brace_swing_t *element, uint32_t count);

/* Over all knee angles. */
typedef struct {
    double least, most, swing;
} brace_det_extent_t;

brace_det_extent_t brace_det_extent(const brace_det_harmonic_t *harmonic);

/* Whether K can be told from det, with the largest mean compliance given: BRACE_OK, with
 * BRACE_FLAG_NEAR_SINGULAR in flags where its error can reach 2e-6 of lambda_max, or BRACE_E_UNSUPPORTED
 * where single precision is no use. Measured: the error is at most 1.5e-8 over the root of (least det over
 * mean^2) if anything is tilted, and a twentieth of that if not. */
brace_status_t brace_det_judge(const brace_det_t *det, double mean_most_mm_per_n, uint32_t *flags);

#endif
