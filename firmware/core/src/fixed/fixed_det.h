/* det C of a chain as rest + cross^2, in double precision. Near the posture where cross vanishes, det C of a slender
 * and tilted limb is known no better than the constants of cross, whatever arithmetic the tick has. For collapses that
 * need not be fast. */
#ifndef BRACE_FIXED_DET_H
#define BRACE_FIXED_DET_H

#include <stdint.h>

#include "brace/element.h"
#include "brace/status.h"

/* constant + per_cos cos theta2 + per_sin sin theta2 */
typedef struct {
    double constant, per_cos, per_sin;
} brace_det_harmonic_t;

typedef struct {
    brace_det_harmonic_t rest;  /* [(mm/N)^2] */
    brace_det_harmonic_t cross; /* [mm/N] */
} brace_det_t;

brace_det_t brace_det_of(float iso, const brace_element_t element[BRACE_ELEMENT_COUNT]);

/* Least and largest value over all knee angles. */
typedef struct {
    double least, most, swing;
} brace_det_extent_t;

brace_det_extent_t brace_det_extent(const brace_det_harmonic_t *harmonic);

/* Can K be computed from det, for the given largest mean compliance? BRACE_OK, with BRACE_FLAG_NEAR_SINGULAR in flags
 * where the error of K can reach 2e-6 of lambda_max, or BRACE_E_UNSUPPORTED where single precision is of no use.
 * Measured: the error is at most 1.5e-8 over the root of (least det over mean^2) if anything is tilted, and a twentieth
 * of that if not. */
brace_status_t brace_det_judge(const brace_det_t *det, double mean_most_mm_per_n, uint32_t *flags);

#endif
