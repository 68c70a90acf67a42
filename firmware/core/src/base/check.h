/* The one way inputs are tested for being usable numbers. */
#ifndef BRACE_CORE_CHECK_H
#define BRACE_CORE_CHECK_H

#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* BRACE_OK for a value in [-limit, limit], BRACE_E_RANGE for a finite one outside, BRACE_E_NOT_FINITE. */
brace_status_t brace_check_magnitude(float value, float limit);

brace_status_t brace_check_two(float a, float b, float limit);

/* A limb with lengths that a limb can have.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER */
brace_status_t brace_check_lengths(const brace_limb_t *limb);

/* A stiffness that can be divided by: eigenvalues finite, positive, in order; axis within half a turn.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE */
brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness);

#endif
