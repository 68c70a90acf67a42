/* Floats of a limb as integers, when parameters change. */
#ifndef BRACE_LOADED_FIXED_QUANTISE_H
#define BRACE_LOADED_FIXED_QUANTISE_H

#include <math.h>
#include <stdint.h>

#include "base/exact.h"

#define LEAST_EXPONENT (-100)   /* stands for zero: no other number's exponent is as small */
#define REFUSED_EXPONENT 100    /* of compliances that no word holds, whatever the load */

/* The least exponent whose power of two is above a magnitude. What is no number is refused. */
static inline int32_t exponent_above(float value)
{
    if (!brace_is_finite(value)) {
        return REFUSED_EXPONENT;
    }
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

/* value 2^exponent as an integer, rounded; from -(2^31 - 1) to 2^31 - 1, whatever the value is. */
static inline int32_t quantised(double value, int32_t exponent)
{
    const double most = 0x7fffffffp0, scaled = ldexp(value, exponent);
    const double limited = scaled > most ? most : scaled > -most ? scaled : -most; /* what is no number is the least */
    return (int32_t)(limited + (limited < 0.0 ? -0.5 : 0.5));
}

#endif
