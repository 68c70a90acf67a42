/* A limb in fixed point under a multiple of its load: its determinant without divisions, and whether it is stable.
 *
 * At t times the load the matrix is I + c t G. Where its pivots are large or near zero, one over them leaves every
 * range, so the determinant is expanded instead: for each link its two curvatures, then its root, then both links. All
 * numbers are q30 and below 1. For that the matrix is taken as 2^-scale (I + c t G), the moments in units of the power
 * of two above the largest, and the compliances likewise.
 */
#ifndef BRACE_CORE_FIXED_SOFTENED_H
#define BRACE_CORE_FIXED_SOFTENED_H

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
    return magnitude_of(m->rr) | magnitude_of(m->ra) | magnitude_of(m->rb) | magnitude_of(m->aa) | magnitude_of(m->ab) |
           magnitude_of(m->bb) | magnitude_of(rest->end_resists) |
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
    const uint32_t compliances = (uint32_t)(stance->femur_bend | stance->tibia_bend | stance->hip | stance->knee) | 1u;
    /* Moments below 2^27, so that the sum of three is below 3/8 in q30; compliances below 2^29, which is 1/2. */
    const uint32_t up = leading_zeros(moments) - 1u, c_up = leading_zeros(compliances) - 1u;
    return (fixed_search_t){fixed_scaled_of(stance->femur, stance->femur_bend, up, c_up),
                            fixed_scaled_of(stance->tibia, stance->tibia_bend, up, c_up),
                            compliance_raised(stance->hip, c_up), compliance_raised(stance->knee, c_up),
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
    const int32_t half = (rest >> 1) - sum; /* the whole may leave its word */
    return (fixed_dets_t){times(bend, spread, 30), curvatures + times(bend, half, 29)};
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

/* A sum below 2^62 times 2^exponent. */
INLINE fixed_wide_t fixed_wide_of(int64_t sum, int32_t exponent)
{
    const int32_t room = room_above(brace_high_word(sum), 0);
    return (fixed_wide_t){(int32_t)((uint64_t)sum << room >> 32), exponent - room};
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
    return (fixed_softened_t){
        fixed_wide_of(whole, 6 * scale - knee_room - hip_room + 3), /* the six factors of 2^-scale */
        tibia.pivot_a > 0 && beyond.curvatures > 0 && with_knee > 0 &&
            sum2(with_knee, femur.pivot_a, left, femur_bend) > 0 &&
            sum2(with_knee, alone.curvatures, left, rise.curvatures) > 0 && whole > 0};
}

#endif
