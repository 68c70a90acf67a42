/* Every input of the core is checked here. Each limit is inclusive, and must be finite.
 * returns BRACE_OK; BRACE_E_RANGE for a number beyond its limit; BRACE_E_NOT_FINITE for NaN and infinity. Where two
 * numbers are wrong and one is NaN or infinite, the answer is BRACE_E_NOT_FINITE. */
#ifndef BRACE_CORE_CHECK_H
#define BRACE_CORE_CHECK_H

#include "base/exact.h"
#include "brace/status.h"

/* Why two numbers were refused. */
brace_status_t brace_refusal_of(float a, float b);

/* Bits are compared, because a comparison of floats refuses NaN only where the compiler counts with NaN. Limits of
 * magnitudes are not negative. */

/* Two values in [-limit, limit]. */
static inline brace_status_t brace_check_two(float a, float b, float limit)
{
    const uint32_t most = brace_bits(limit);
    return brace_magnitude_bits(a) <= most && brace_magnitude_bits(b) <= most ? BRACE_OK : brace_refusal_of(a, b);
}

/* A value in [-limit, limit]. */
static inline brace_status_t brace_check_magnitude(float value, float limit)
{
    return brace_magnitude_bits(value) <= brace_bits(limit) ? BRACE_OK : brace_refusal_of(value, 0.0f);
}

/* A value in [least, most]. */
static inline brace_status_t brace_check_range(float value, float least, float most)
{
    return brace_is_finite(value) && value >= least && value <= most ? BRACE_OK : brace_refusal_of(value, 0.0f);
}

/* The first of the statuses that is not BRACE_OK; BRACE_OK if all are. */
static inline brace_status_t brace_first_refusal(brace_status_t first, brace_status_t second)
{
    return first != BRACE_OK ? first : second;
}

#endif
