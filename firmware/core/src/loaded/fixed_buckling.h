/* The buckling factor in fixed point: the search of loaded/buckling.h. */
#ifndef BRACE_CORE_FIXED_BUCKLING_H
#define BRACE_CORE_FIXED_BUCKLING_H

#include <math.h>
#include <stdbool.h>

#include "loaded/fixed_softened.h"

/* The two determinants about the root and the one below, in one unit. */
INLINE int32_t wide_in_unit(fixed_wide_t number, int32_t exponent)
{
    const int32_t down = exponent - number.exponent;
    return number.mantissa_q31 >> (down > 31 ? 31 : down);
}

/* One over how far the determinant falls from `low` to `high`, which differ: 2^61/(span 2^zeros). */
typedef struct {
    uint32_t span, zeros, inverse;
} fixed_fall_t;

INLINE fixed_fall_t fixed_fall_of(int32_t low, int32_t high)
{
    const uint32_t span = (uint32_t)low - (uint32_t)high, zeros = leading_zeros(span), leading = span << zeros;
    const uint32_t guess = (0x80000000u / (leading >> 16)) << 15;
    return (fixed_fall_t){span, zeros, high_unsigned(guess, (0x80000000u - high_unsigned(leading, guess)) << 1)};
}

/* Where the chord is zero, 0 to 1. */
INLINE int32_t fixed_chord_q30(int32_t low, fixed_fall_t fall)
{
    return (int32_t)(((uint64_t)((uint32_t)low << fall.zeros) * fall.inverse) >> 31);
}

/* How far it has come before, as a share of the fall, within 8. */
INLINE int32_t fixed_before_q27(int32_t across, fixed_fall_t fall)
{
    const int32_t most = (fall.span >> 28) != 0u ? 0x7fffffff : (int32_t)(fall.span << 3);
    const int32_t limited = across > most ? most : across < -most ? -most : across;
    return (int32_t)(((int64_t)limited * (int64_t)fall.inverse) >> (34u - fall.zeros));
}

/* One step of Newton's method from the chord's root. */
INLINE int32_t fixed_past_chord_q30(int32_t chord_q30, int32_t rho_q27, int32_t k_q30, int32_t l_q29)
{
    const int32_t g_q27 = times(k_q30, times(l_q29, rho_q27, 29) - ONE_Q27, 30);
    const int32_t slope_q27 = ONE_Q27 - times(g_q27, 2 * (chord_q30 - (1 << 29)), 30);
    if (slope_q27 < LEAST_PIVOT_Q27) {
        return chord_q30; /* no parabola that falls there */
    }
    const int32_t across_q30 = times(chord_q30, (1 << 30) - chord_q30, 30);
    const int64_t off_q30 = ((int64_t)times(g_q27, across_q30, 27) * inverse_q27(slope_q27)) >> 27;
    const int64_t root_q30 = chord_q30 - off_q30;
    return root_q30 < 0 ? 0 : root_q30 > (1 << 30) ? 1 << 30 : (int32_t)root_q30;
}

/* Where the parabola through three determinants is zero: at before/low, 1 and sqrt 2 times the load `low`. Returns how
 * far that is from the second to the third, 0 to 1. With L = at_low/(at_low - at_high) the chord's root and
 * g = -k (1 - l rho), rho = (at_before - at_low)/(at_low - at_high), one step of Newton's method from L leads to
 * L - g L (1 - L)/(1 - g (2 L - 1)); k and l follow from where the third lies.
 * All three are below 2^30; low is not negative, high is. */
INLINE int32_t fixed_root_q30(int32_t before, int32_t low, int32_t high, int32_t k_q30, int32_t l_q29)
{
    const fixed_fall_t fall = fixed_fall_of(low, high);
    return fixed_past_chord_q30(fixed_chord_q30(low, fall), fixed_before_q27(before - low, fall), k_q30, l_q29);
}

/* Of the parabola, by how far the determinant before is below: not at all (the load is `low` itself), 1, 2 and 4 half
 * octaves, and at no load. */
static const int32_t parabola_k_q30[] = {Q31(0.5857864376 / 2), Q31(0.4530818393 / 2), Q31(0.3557642 / 2),
                                         Q31(0.2928932188 / 2)};
static const int32_t parabola_l_q29[] = {Q31(1.414213562 / 4), Q31(0.8284271247 / 4), Q31(0.5522847498 / 4),
                                         Q31(0.4142135624 / 4)};

/* now: the determinant at the present load. */
INLINE float fixed_buckling_factor(const fixed_stance_t *stance, fixed_wide_t now)
{
    const fixed_search_t search = fixed_search_of(stance);
    fixed_wide_t before = {1 << 30, 1}, low = now, high = {0, 0};
    int at = 0, below = 3;
    bool is_found = false;
    for (int step = 4, size = 2; step != 0; step >>= 1, size--) {
        const fixed_softened_t then = fixed_softened(&search, at + step);
        if (then.is_stable) {
            before = low, below = size;
            low = then.determinant, at += step;
        } else {
            high = then.determinant, is_found = true;
        }
    }
    if (!is_found) {
        return INFINITY;
    }
    int32_t root_q30 = 1 << 29;
    if (high.mantissa_q31 < 0) {
        int32_t unit = low.exponent > high.exponent ? low.exponent : high.exponent;
        unit = (unit > before.exponent ? unit : before.exponent) + 1;
        root_q30 = fixed_root_q30(wide_in_unit(before, unit), wide_in_unit(low, unit), wide_in_unit(high, unit) - 1,
                                  parabola_k_q30[below], parabola_l_q29[below]);
    }
    const int32_t times_low_q29 = (1 << 29) + times(root_q30, Q31(0.414213562373), 32);
    const int32_t less_octaves = (at & 1) != 0 ? times(times_low_q29, Q31(0.70710678118654752), 31) : times_low_q29;
    return float_from(less_octaves, 29 - ((at + 1) >> 1));
}

#endif
