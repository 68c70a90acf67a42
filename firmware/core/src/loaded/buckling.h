/* The load at which the first pivot reaches zero, as a multiple of the present one. Below it all pivots are positive.
 * The search halves the logarithm of the range 1 to 16. It ends at the root of the parabola through the last two
 * determinants and the one below: one step of Newton's method from the chord's root. */
#ifndef BRACE_CORE_BUCKLING_H
#define BRACE_CORE_BUCKLING_H

#include <math.h>
#include <stdbool.h>

#include "base/fma.h"
#include "base/inline.h"

#define HIGHEST_FACTOR 16.0f

/* The limb with its load taken some times: the product of its pivots, and whether all are positive. */
typedef struct {
    float determinant;
    bool is_stable;
} softened_t;

/* softened: what it tells of the limb at a multiple of the load. determinant_now: at the present load. */
INLINE float buckling_factor_of(softened_t (*softened)(const void *limb, float times), const void *limb,
                                float determinant_now)
{
    static const float ratio[] = {4.0f, 2.0f, 1.41421356f};
    float before = 0.0f, low = 1.0f, high = HIGHEST_FACTOR;
    float at_before = 1.0f, at_low = determinant_now, at_high = 0.0f; /* no load: every pivot is 1 */
    for (int i = 0; i < 3; i++) {
        const float middle = low * ratio[i];
        const softened_t now = softened(limb, middle);
        if (now.is_stable) {
            before = low, at_before = at_low;
            low = middle, at_low = now.determinant;
        } else {
            high = middle, at_high = now.determinant;
        }
    }
    if (!(at_high < 0.0f)) {
        return high < HIGHEST_FACTOR ? 0.5f * (low + high) : INFINITY;
    }
    const float chord = (at_high - at_low) / (high - low), root = low - at_low / chord;
    const float bend = ((at_before - at_low) / (before - low) - chord) / (before - high);
    const float off = bend * (root - low) * (root - high), slope = brace_fma(bend, (root - low) + (root - high), chord);
    return root - off / slope;
}

#endif
