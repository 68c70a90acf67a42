/* The buckling factor in fixed point: the search of loaded/buckling.h, on determinants without divisions.
 *
 * At t times the load the matrix is I + c t G. Where its pivots are large or near zero, one over them leaves every
 * range, so the determinant is expanded instead: for each link its two curvatures, then its root, then both links. All
 * numbers are q30 and below 1. For that the matrix is taken as 2^-scale (I + c t G), the moments in units of the power
 * of two above the largest, and the compliances likewise.
 */
#ifndef BRACE_CORE_FIXED_BUCKLING_H
#define BRACE_CORE_FIXED_BUCKLING_H

#include <math.h>
#include <stdbool.h>

#include "loaded/fixed_solve.h"


/* Of a link: what resists at t times the load, in the search's unit. */
typedef struct {
    int32_t root, ra, rb, pivot_a, pivot_b, ab; /* ab and pivots with the curvatures' compliance */
} fixed_turns_t;

/* What a link resists at the present load, and its curvatures' compliance, in the search's units. */
typedef struct {
    fixed_matrix_t resists;
    int32_t end_resists, root_softens, end_softens;
    int32_t bend;
} fixed_scaled_t;

/* The limb as the search sees it. */
typedef struct {
    fixed_scaled_t femur, tibia;
    int32_t hip, knee;
    int32_t units; /* c G in these units is 2^-units times what it is */
} fixed_search_t;

INLINE uint32_t fixed_sizes_of(const fixed_rest_t *rest)
{
    const fixed_matrix_t *m = &rest->resists;
    /* What grows with the square of the load is 16 times as large beside the rest at the end of the search. */
    return magnitude_of(m->rr) | magnitude_of(m->ra) | magnitude_of(m->rb) | magnitude_of(m->aa) |
           magnitude_of(m->ab) | magnitude_of(m->bb) | magnitude_of(rest->end_resists) |
           (uint32_t)(rest->root_softens | rest->end_softens) << 4;
}

/* A number shifted up, or down where `up` is negative. */
INLINE int32_t shifted_up(int32_t number, int32_t up)
{
    return up >= 0 ? (int32_t)((uint32_t)number << up) : number >> (up < -31 ? 31 : -up);
}

/* A moment, shifted up by so many bits, less four; a compliance, less two. */
INLINE int32_t raised(int32_t number, uint32_t bits)
{
    return (int32_t)((uint32_t)number << bits) >> 4;
}

INLINE int32_t compliance_raised(int32_t number, uint32_t bits)
{
    return (int32_t)((uint32_t)number << bits) >> 2;
}

INLINE fixed_scaled_t fixed_scaled_of(const fixed_rest_t *rest, int32_t bend, uint32_t up, uint32_t c_up)
{
    const fixed_matrix_t *m = &rest->resists;
    return (fixed_scaled_t){{raised(m->rr, up), raised(m->ra, up), raised(m->rb, up), raised(m->aa, up),
                             raised(m->ab, up), raised(m->bb, up)},
                            raised(rest->end_resists, up),
                            raised(rest->root_softens, up),
                            raised(rest->end_softens, up),
                            compliance_raised(bend, c_up)};
}

INLINE fixed_search_t fixed_search_of(const fixed_stance_t *stance)
{
    const uint32_t moments = fixed_sizes_of(stance->femur) | fixed_sizes_of(stance->tibia) | 1u;
    const uint32_t compliances =
        (uint32_t)(stance->femur_bend | stance->tibia_bend | stance->hip | stance->knee) | 1u;
    /* Moments below 2^27, so that the sum of three is below 3/8 in q30; compliances below 2^29, which is 1/2. */
    const uint32_t up = leading_zeros(moments) - 1u, c_up = leading_zeros(compliances) - 1u;
    return (fixed_search_t){fixed_scaled_of(stance->femur, stance->femur_bend, up, c_up),
                            fixed_scaled_of(stance->tibia, stance->tibia_bend, up, c_up),
                            compliance_raised(stance->hip, c_up),
                            compliance_raised(stance->knee, c_up),
                            4 + 4 + 2 - (int32_t)(up + c_up)};
}

/* times_q31: the multiple of the load, less whole octaves. */
INLINE fixed_turns_t fixed_turns_of(const fixed_scaled_t *link, int32_t bend, int32_t one, int32_t times_q31,
                                    int32_t octaves)
{
    const fixed_matrix_t *m = &link->resists;
    const int32_t square_q31 = coarse_times(times_q31, times_q31, 31);
    const int32_t root_softens = coarse_times(link->root_softens, square_q31, 31) << octaves;
    const int32_t end_softens = coarse_times(link->end_softens, square_q31, 31) << octaves;
    const int32_t end = coarse_times(link->end_resists, times_q31, 31) - end_softens;
    return (fixed_turns_t){coarse_times(m->rr, times_q31, 31) + end - root_softens,
                           coarse_times(m->ra, times_q31, 31) + end,
                           coarse_times(m->rb, times_q31, 31) + end,
                           one + times(bend, coarse_times(m->aa, times_q31, 31) + end, 30),
                           one + times(bend, coarse_times(m->bb, times_q31, 31) + end, 30),
                           times(bend, coarse_times(m->ab, times_q31, 31) + end, 30)};
}

/* Determinants of a link: of its curvatures alone, and bordered by its root: [[root, r'], [c r, P]]. */
typedef struct {
    int32_t curvatures, bordered;
} fixed_dets_t;

INLINE fixed_dets_t fixed_dets_of(const fixed_turns_t *t, int32_t bend)
{
    const int32_t curvatures = shifted(sum2(t->pivot_a, t->pivot_b, -t->ab, t->ab), 30);
    const int32_t by_a = shifted(sum2(t->ra, t->pivot_b, -t->rb, t->ab), 30);
    const int32_t by_b = shifted(sum2(t->rb, t->pivot_a, -t->ra, t->ab), 30);
    const int32_t sum = shifted(sum2(t->ra, by_a, t->rb, by_b), 30);
    return (fixed_dets_t){curvatures, shifted(sum2(t->root, curvatures, -bend, sum), 30)};
}

/* The same, how fast they grow with what resists the link's end. */
INLINE fixed_dets_t fixed_dets_rise(const fixed_turns_t *t, int32_t bend, int32_t curvatures)
{
    const int32_t spread = t->pivot_a + t->pivot_b - 2 * t->ab, apart = t->ra - t->rb;
    const int32_t sum = shifted(sum2(t->ra, t->pivot_b - t->ab, t->rb, t->pivot_a - t->ab), 30);
    const int32_t rest = shifted(sum2(t->root, spread, -bend, times(apart, apart, 30)), 30);
    return (fixed_dets_t){times(bend, spread, 30), curvatures + times(bend, rest - 2 * sum, 30)};
}

typedef struct {
    fixed_wide_t determinant; /* its mantissa may be negative here */
    bool is_stable;
} fixed_softened_t;

/* Bits by which both numbers may be shifted up, below 2^30. */
INLINE int32_t room_above(int32_t a, int32_t b)
{
    return (int32_t)leading_zeros(magnitude_of(a) | magnitude_of(b) | 1u) - 2;
}

INLINE fixed_softened_t fixed_softened(const fixed_search_t *search, int32_t half_octaves)
{
    const int32_t times_q31 = (half_octaves & 1) != 0 ? Q31(0.70710678118654752) : INT32_MAX;
    const int32_t octaves = (half_octaves + 1) >> 1;
    const int32_t grown = search->units + octaves, scale = grown > 1 ? grown : 1;
    const int32_t one = (1 << 30) >> scale, down = scale - grown > 31 ? 31 : scale - grown;
    const int32_t femur_bend = search->femur.bend >> down, tibia_bend = search->tibia.bend >> down;
    const int32_t hip = search->hip >> down, knee = search->knee >> down;

    const fixed_turns_t tibia = fixed_turns_of(&search->tibia, tibia_bend, one, times_q31, octaves);
    const fixed_dets_t beyond = fixed_dets_of(&tibia, tibia_bend);
    /* with the knee; and what is left of the tibia's root, times that */
    const int32_t with_knee_as_is = shifted(sum2(one, beyond.curvatures, knee, beyond.bordered), 30);
    const int32_t left_as_is = times(one, beyond.bordered, 30), knee_room = room_above(with_knee_as_is, left_as_is);
    const int32_t with_knee = shifted_up(with_knee_as_is, knee_room), left = shifted_up(left_as_is, knee_room);

    const fixed_turns_t femur = fixed_turns_of(&search->femur, femur_bend, one, times_q31, octaves);
    const fixed_dets_t alone = fixed_dets_of(&femur, femur_bend);
    const fixed_dets_t rise = fixed_dets_rise(&femur, femur_bend, alone.curvatures);
    const int32_t alone_as_is = shifted(sum2(one, alone.curvatures, hip, alone.bordered), 30);
    const int32_t rise_as_is = shifted(sum2(one, rise.curvatures, hip, rise.bordered), 30);
    const int32_t hip_room = room_above(alone_as_is, rise_as_is);
    const int64_t whole = sum2(with_knee, shifted_up(alone_as_is, hip_room), left, shifted_up(rise_as_is, hip_room));
    const int32_t whole_high = brace_high_word(whole);
    const int32_t whole_room = room_above(whole_high, 0);
    /* the six factors of 2^-scale */
    return (fixed_softened_t){
        {(int32_t)((uint64_t)whole << whole_room >> 32), 6 * scale - knee_room - hip_room - whole_room + 3},
        tibia.pivot_a > 0 && beyond.curvatures > 0 && with_knee > 0 &&
            sum2(with_knee, femur.pivot_a, left, femur_bend) > 0 &&
            sum2(with_knee, alone.curvatures, left, rise.curvatures) > 0 && whole > 0};
}

/* The two determinants about the root and the one below, in one unit. */
INLINE int32_t wide_in_unit(fixed_wide_t number, int32_t exponent)
{
    const int32_t down = exponent - number.exponent;
    return number.mantissa_q31 >> (down > 31 ? 31 : down);
}

/* Where the parabola through three determinants is zero: at before/low, 1 and sqrt 2 times the load `low`. Returns how
 * far that is from the second to the third, 0 to 1. With L = at_low/(at_low - at_high) the chord's root and
 * g = -k (1 - l rho), rho = (at_before - at_low)/(at_low - at_high), one step of Newton's method from L leads to
 * L - g L (1 - L)/(1 - g (2 L - 1)); k and l follow from where the third lies. */
INLINE int32_t fixed_root_q30(int32_t before, int32_t low, int32_t high, int32_t k_q30, int32_t l_q29)
{
    const uint32_t span = (uint32_t)low - (uint32_t)high; /* both below 2^30: no overflow, and not zero */
    const uint32_t zeros = leading_zeros(span), leading = span << zeros;
    const uint32_t guess = (0x80000000u / (leading >> 16)) << 15;
    /* 2^61/leading */
    const uint32_t inverse = high_unsigned(guess, (0x80000000u - high_unsigned(leading, guess)) << 1);
    const int32_t chord_q30 = (int32_t)(((uint64_t)((uint32_t)low << zeros) * inverse) >> 31);
    const int32_t across = before - low;
    const int32_t most = (span >> 28) != 0u ? 0x7fffffff : (int32_t)(span << 3); /* rho within 8 */
    const int32_t limited = across > most ? most : across < -most ? -most : across;
    const int32_t rho_q27 = (int32_t)(((int64_t)limited * (int64_t)inverse) >> (34u - zeros));
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

/* now: the determinant at the present load. */
INLINE float fixed_buckling_factor(const fixed_stance_t *stance, fixed_wide_t now)
{
    /* of the parabola, by how far the determinant before is below: not at all (the load is `low` itself), 1, 2 and 4
     * half octaves, and at no load */
    static const int32_t k_q30[] = {Q31(0.5857864376 / 2), Q31(0.4530818393 / 2), Q31(0.3557642 / 2),
                                    Q31(0.2928932188 / 2)};
    static const int32_t l_q29[] = {Q31(1.414213562 / 4), Q31(0.8284271247 / 4), Q31(0.5522847498 / 4),
                                    Q31(0.4142135624 / 4)};
    const fixed_search_t search = fixed_search_of(stance);
    fixed_wide_t before = {1 << 30, 1}, low = now, high = {0, 0};
    int32_t at = 0, below = 3;
    bool is_found = false;
    for (int32_t step = 4, size = 2; step != 0; step >>= 1, size--) {
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
                                  k_q30[below], l_q29[below]);
    }
    const int32_t times_low_q29 = (1 << 29) + times(root_q30, Q31(0.414213562373), 32);
    const int32_t less_octaves = (at & 1) != 0 ? times(times_low_q29, Q31(0.70710678118654752), 31) : times_low_q29;
    return float_from(less_octaves, 29 - ((at + 1) >> 1));
}

#endif
