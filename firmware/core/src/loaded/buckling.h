/* The load at which the first pivot reaches zero, as a multiple of the present one. Below it all pivots are positive.
 * The search halves the logarithm of the range 1 to 16. It ends at the root of the parabola through the last two
 * determinants and the one below: one step of Newton's method from the chord's root. */
#ifndef BRACE_CORE_BUCKLING_H
#define BRACE_CORE_BUCKLING_H

#include <math.h>
#include <stdbool.h>

#include "base/fma.h"
#include "base/inline.h"
#include "brace/buckling_search.h"

#define HIGHEST_FACTOR 16.0f
#define SEARCH_STEPS 3

/* The limb with its load taken some times: the product of its pivots, and whether all are positive. */
typedef struct {
    float determinant;
    bool is_stable;
} softened_t;

/* determinant_now: at the present load. */
INLINE brace_buckling_search_t buckling_search_from(float determinant_now)
{
    return (brace_buckling_search_t){.before = 0.0f,
                                     .low = 1.0f,
                                     .high = HIGHEST_FACTOR,
                                     .at_before = 1.0f, /* no load: every pivot is 1 */
                                     .at_low = determinant_now,
                                     .at_high = 0.0f};
}

/* The multiple of the load that step 0, 1 or 2 looks at. */
INLINE float buckling_search_at(const brace_buckling_search_t *search, int step)
{
    static const float ratio[SEARCH_STEPS] = {4.0f, 2.0f, 1.41421356f};
    return search->low * ratio[step];
}

INLINE void buckling_search_narrow(brace_buckling_search_t *search, float at, softened_t found)
{
    if (found.is_stable) {
        search->before = search->low, search->at_before = search->at_low;
        search->low = at, search->at_low = found.determinant;
    } else {
        search->high = at, search->at_high = found.determinant;
    }
}

INLINE float buckling_search_end(const brace_buckling_search_t *search)
{
    const float before = search->before, low = search->low, high = search->high;
    const float at_before = search->at_before, at_low = search->at_low, at_high = search->at_high;
    if (!(at_high < 0.0f)) {
        return high < HIGHEST_FACTOR ? 0.5f * (low + high) : INFINITY;
    }
    const float chord = (at_high - at_low) / (high - low), root = low - at_low / chord;
    const float bend = ((at_before - at_low) / (before - low) - chord) / (before - high);
    const float off = bend * (root - low) * (root - high), slope = brace_fma(bend, (root - low) + (root - high), chord);
    return root - off / slope;
}

#endif
