/* Floats of a limb as integers, when parameters change. */
#ifndef BRACE_LOADED_FIXED_QUANTISE_H
#define BRACE_LOADED_FIXED_QUANTISE_H

#include <math.h>
#include <stdint.h>

#define LEAST_EXPONENT (-100) /* stands for zero: no other number's exponent is as small */

/* The least exponent whose power of two is above a magnitude. */
static inline int32_t exponent_above(float value)
{
    if (!(fabsf(value) > 1e-30f)) {
        return LEAST_EXPONENT;
    }
    int exponent;
    (void)frexpf(value, &exponent);
    return exponent;
}

static inline int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* value 2^exponent as an integer, rounded. Its magnitude is below 2^31. */
static inline int32_t quantised(double value, int32_t exponent)
{
    const double scaled = ldexp(value, exponent);
    const double limited = scaled > 0x7fffffffp0 ? 0x7fffffffp0 : scaled; /* what rounds to 2^31 */
    return (int32_t)(limited + (limited < 0.0 ? -0.5 : 0.5));
}

#endif
