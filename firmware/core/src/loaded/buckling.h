/* The load at which the first pivot reaches zero, as a multiple of the present one. Below it all pivots are positive.
 * The search halves the logarithm of the range 1 to 16. It ends at the root of the parabola through the last two
 * determinants and the one below: one step of Newton's method from the chord's root. */
#ifndef BRACE_CORE_BUCKLING_H
#define BRACE_CORE_BUCKLING_H

#include <math.h>
#include <stdbool.h>

#include "base/fma.h"
#include "base/inline.h"

#define BUCKLING_STEPS 3
#define HIGHEST_FACTOR 16.0f

/* Three multiples of the load and the determinants there: the highest one known to be unstable, 0 where none is. */
typedef struct {
    float before, low, high, at_before, at_low, at_high;
} buckling_t;

/* determinant: under the present load. Without a load every pivot is 1. */
INLINE buckling_t buckling_from(float determinant)
{
    return (buckling_t){.low = 1.0f, .high = HIGHEST_FACTOR, .at_before = 1.0f, .at_low = determinant};
}

INLINE float buckling_middle(const buckling_t *search, int step)
{
    static const float ratio[BUCKLING_STEPS] = {4.0f, 2.0f, 1.41421356f};
    return search->low * ratio[step];
}

INLINE void buckling_narrow(buckling_t *search, float middle, float determinant, bool is_stable)
{
    if (is_stable) {
        search->before = search->low, search->at_before = search->at_low;
        search->low = middle, search->at_low = determinant;
    } else {
        search->high = middle, search->at_high = determinant;
    }
}

INLINE float buckling_root(const buckling_t *search)
{
    const float before = search->before, low = search->low, high = search->high;
    if (!(search->at_high < 0.0f)) {
        return high < HIGHEST_FACTOR ? 0.5f * (low + high) : INFINITY;
    }
    const float chord = (search->at_high - search->at_low) / (high - low), root = low - search->at_low / chord;
    const float bend = ((search->at_before - search->at_low) / (before - low) - chord) / (before - high);
    const float off = bend * (root - low) * (root - high), slope = brace_fma(bend, (root - low) + (root - high), chord);
    return root - off / slope;
}

#endif
