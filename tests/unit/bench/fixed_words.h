/* Numbers by chance, as doubles and as the words of a format, for the suites of the integer paths. */
#ifndef FIXED_WORDS_H
#define FIXED_WORDS_H

#include <math.h>
#include <stdint.h>

#include "times.h"

static uint32_t state = 7u;

static inline double any(double least, double most)
{
    state = state * 1664525u + 1013904223u;
    return least + (most - least) * ((double)(state >> 8) / 16777216.0);
}

static inline int32_t word(double number, int format)
{
    return (int32_t)floor(ldexp(number, format));
}

static inline double number(int32_t word_, int format)
{
    return ldexp((double)word_, -format);
}

#endif
