/* At the equilibrium in space, in fixed point: the limb's matrix, eliminated from the tip to the base, as in
 * loaded/space_sum.h. */
#ifndef BRACE_CORE_FIXED_SPACE_ELIMINATE_H
#define BRACE_CORE_FIXED_SPACE_ELIMINATE_H

#include <stddef.h>

#include "fixed_space/held.h"

/* A coordinate's compliance, load included, and how all beyond follows when the places before it turn. */
typedef struct {
    fixed3_t follows;
    int32_t yields_q26;
} fixed_freedom_t;

/* A link's springs first, then its turns about x, y and z: each adds to those after it. */
typedef struct {
    fixed_freedom_t across, sideways, x, y, z;
    fixed3_t by_across, by_sideways; /* to x, y and z */
    int32_t y_by_x, z_by_x, z_by_y;
} fixed_link_freedoms_t;

typedef struct {
    fixed_link_freedoms_t coxa, femur, tibia;
    fixed_freedom_t yaw, hip, knee;
    int32_t base_yields_q26;
} fixed_freedoms_t;

/* The load taken many times, for the buckling factor: which is as the compliances taken as many times. Then what the
 * load softens at the links' end springs counts. determinant: the product of all pivots, 2^exponent times a mantissa
 * that is at least a half; has_buckled: one of them is negative. is_refused: a word does not hold what was met; then
 * the determinant is that of the pivots up to there. */
typedef struct {
    int32_t times_q27;
    int32_t mantissa_q31, exponent;
    bool is_negative, has_buckled, is_refused;
} fixed_overload_t;

INLINE int32_t overloaded(int32_t yields_q26, const fixed_overload_t *overload, noted_t *noted)
{
    if (overload == NULL) {
        return yields_q26;
    }
    const int64_t product = (int64_t)yields_q26 * overload->times_q27;
    note(noted, brace_high_word(product), 30);
    return shifted(product, 35);
}

INLINE ranges_t ranges_of(const fixed_overload_t *overload)
{
    return overload == NULL ? RANGES : OVERLOAD_RANGES;
}

/* A force, a 16th of it for an overload. */
INLINE fixed3_t overload_of(fixed3_t f, const fixed_overload_t *overload)
{
    return overload == NULL ? f : fixed3_halved(f, 4);
}

#define OVERLOAD_PIVOT_LEAST_Q20 (1 << 14) /* a 64th; of either sign */

INLINE void multiply_determinant(fixed_overload_t *overload, uint32_t pivot_q20, bool is_negative)
{
    if (overload->is_refused) {
        return;
    }
    const int32_t by = times(overload->mantissa_q31, (int32_t)pivot_q20, 31); /* a pivot is below 2048: q20 */
    const uint32_t zeros = leading_zeros((uint32_t)by | 1u) - 1u;
    overload->mantissa_q31 = (int32_t)((uint32_t)by << zeros);
    overload->exponent += 11 - (int32_t)zeros;
    overload->is_negative = overload->is_negative != is_negative;
    overload->has_buckled = overload->has_buckled || is_negative;
}

/* A compliance under the load taken many times. */
INLINE int32_t overload_softened(int32_t yields_q14, int32_t entry_q24, fixed_overload_t *overload, noted_t *noted)
{
    const int64_t more = (int64_t)yields_q14 * entry_q24;
    note(noted, brace_high_word(more), 16);
    overload->is_refused = is_refused(*noted); /* before this pivot counts */
    const int32_t pivot = plus(1 << 20, shifted(more, 18));
    const uint32_t magnitude = magnitude_of(pivot);
    const uint32_t size = magnitude < OVERLOAD_PIVOT_LEAST_Q20 ? OVERLOAD_PIVOT_LEAST_Q20 : magnitude;
    multiply_determinant(overload, size, pivot < 0);
    const uint32_t zeros = leading_zeros(size);
    const int64_t softened = ((int64_t)yields_q14 * (int32_t)over_q61(size << zeros)) >> (41u - zeros);
    note(noted, shifted(softened, 16), 14);
    const int32_t word = (int32_t)(uint32_t)(uint64_t)softened;
    return pivot < 0 ? minus(word) : word;
}

/* A compliance with its load. */
INLINE int32_t eliminated_yields(int32_t yields, int32_t entry_q24, fixed_overload_t *overload, noted_t *noted)
{
    return overload == NULL ? softened_of(yields, inverse_q27(pivot_of(yields, entry_q24, noted)), noted)
                            : overload_softened(yields, entry_q24, overload, noted);
}

/* --- elimination ---------------------------------------------------------------------------------------------- */

/* What a chord resists (q24) under a force. */
INLINE fixed_sym3_t fixed_chord_resists(fixed3_t chord_q28, fixed3_t f)
{
    const int64_t xx = (int64_t)chord_q28.x * f.x, yy = (int64_t)chord_q28.y * f.y, zz = (int64_t)chord_q28.z * f.z;
    const int32_t x = brace_high_word(xx) >> 2, y = brace_high_word(yy) >> 2, z = brace_high_word(zz) >> 2;
    return (fixed_sym3_t){plus(y, z),
                          minus(brace_high_word(sum2(chord_q28.x, f.y, chord_q28.y, f.x)) >> 3),
                          minus(brace_high_word(sum2(chord_q28.x, f.z, chord_q28.z, f.x)) >> 3),
                          plus(x, z),
                          minus(brace_high_word(sum2(chord_q28.y, f.z, chord_q28.z, f.y)) >> 3),
                          plus(x, y)};
}

INLINE fixed_freedom_t fixed_eliminate(fixed_held_t *held, fixed3_t row_q24, int32_t entry_q24, int32_t yields,
                                       fixed_overload_t *overload, noted_t *noted)
{
    const ranges_t ranges = ranges_of(overload);
    note_row(row_q24, ranges, noted);
    const int32_t softened = eliminated_yields(yields, entry_q24, overload, noted);
    const fixed3_t follows = follow_row(row_q24, softened, ranges, noted);
    fixed_sym3_add(&held->resists_q24, row_q24, follows, ranges, noted);
    return (fixed_freedom_t){follows, softened};
}

INLINE fixed_freedom_t fixed_eliminate_joint(fixed_held_t *held, int32_t yields_q26, fixed_overload_t *overload,
                                             noted_t *noted)
{
    const fixed_sym3_t r = held->resists_q24;
    const fixed3_t m = held->moment_q27, row = fixed3(plus(r.xz, m.y >> 4), less(r.yz, m.x >> 4), r.zz);
    return fixed_eliminate(held, row, r.zz, overloaded(yields_q26, overload, noted), overload, noted);
}

/* Among a link's own turns: at most 16, of an overload 2, so that a ratio times it still fits. */
INLINE void note_own(int32_t own_q24, ranges_t ranges, noted_t *noted)
{
    note(noted, own_q24, ranges.row_most_bits + 1);
}

/* is_last: nothing lies beyond the link. overload: NULL for K, and what the load softens at the link's end springs is
 * left out. */
INLINE void fixed_eliminate_link(const fixed_link3_t *link, const fixed_rest3_t *rest, fixed3_t turn,
                                 const fixed_bent3_t *bent, bool is_last, fixed_overload_t *overload,
                                 fixed_held_t *held, fixed_link_freedoms_t *free, noted_t *noted)
{
    const fixed3_t f = overload_of(bent->beyond_q30, overload);
    const fixed3_t chord_f = fixed3_plus(f, fixed3_halved(overload_of(bent->own_q30, overload), 1));
    const fixed3_t m = held->moment_q27, chord_q27 = fixed3_cross(bent->chord_q28, chord_f, 31);
    const fixed_sym3_t r = held->resists_q24, chord = fixed_chord_resists(bent->chord_q28, chord_f);
    const int32_t curl_y = bent->across_curl_q30, curl_z = bent->sideways_curl_q30;
    const fixed_vec_t by_bend = bent->by_bend_q28;
    const int32_t by_sideways = bent->by_sideways_q28;
    const uint32_t turn_shift = rest->turn_shift, arm = link->arm_shift;
    const ranges_t ranges = ranges_of(overload);

    /* Among the link's own turns, and between them and all before. */
    fixed_sym3_t own = r;
    if (!is_last) {
        own.xy = less(r.xy, by_q30(r.xx, curl_y));
        own.xz = less(r.xz, by_q30(r.xx, curl_z));
        own.yy = less(r.yy, by_q30(plus(r.xy, own.xy), curl_y));
        own.yz = less(r.yz, coarse(sum2(curl_z, own.xy, curl_y, r.xz), 30));
        own.zz = less(r.zz, by_q30(plus(r.xz, own.xz), curl_z));
    }
    own = fixed_sym3_plus(own, chord, 2);
    own.yy = plus(own.yy, high_of(link->twelfth_q28, f.x) >> 2);
    const int32_t along_x = less(by_bend.z, twice(link->bow_q28.x)), along_y = plus(by_bend.x, twice(link->bow_q28.z));
    own.zz = plus(own.zz, brace_high_word(sum2(along_x, f.x, minus(along_y), f.y)) >> 2);
    const fixed_sym3_t q = fixed_sym3_plus(r, chord, 1);
    const fixed3_t half_m = fixed3(plus(m.x >> 4, chord_q27.x >> 5), plus(m.y >> 4, chord_q27.y >> 5),
                                   plus(m.z >> 4, chord_q27.z >> 5));
    fixed3_t x = fixed3(q.xx, plus(q.xy, half_m.z), less(q.xz, half_m.y));
    fixed3_t y = fixed3(less(q.xy, half_m.z), plus(q.yy, high_of(by_sideways, f.z) >> 2),
                        less(plus(q.yz, half_m.x), high_of(by_sideways, f.y) >> 2));
    fixed3_t z = fixed3(less(plus(q.xz, half_m.y), high_of(by_bend.z, f.z) >> 2),
                        plus(less(q.yz, half_m.x), high_of(by_bend.x, f.z) >> 2),
                        plus(q.zz, brace_high_word(sum2(by_bend.z, f.x, minus(by_bend.x), f.y)) >> 2));
    if (!is_last) {
        y = fixed3_plus_q30(y, x, minus(curl_y));
        z = fixed3_plus_q30(z, x, minus(curl_z));
    }
    held->resists_q24 = fixed_sym3_plus(r, chord, 0);
    held->moment_q27 = fixed3_plus(m, chord_q27);

    const int32_t share = plus(link->end_share_q30, 1 << 29), curled_q24 = by_q30(m.x, link->curl_q30) >> 3;
    const int32_t across_yields = overloaded(link->across_arm_q31 >> turn_shift, overload, noted);
    const int32_t sideways_yields = overloaded(link->sideways_arm_q31 >> turn_shift, overload, noted);
    const int32_t sideways_x = bent->sideways_x_q30;
    const fixed3_t across = fixed3_halved(fixed3_cross(f, bent->across_q30, 30), 6u + arm);
    const fixed3_t sideways = fixed3_halved(
        fixed3(f.y, less(by_q30(f.z, sideways_x), f.x), minus(by_q30(f.y, sideways_x))), 6u + arm);
    free->across = (fixed_freedom_t){follow_row(across, across_yields, ranges, noted), across_yields};
    free->sideways = (fixed_freedom_t){follow_row(sideways, sideways_yields, ranges, noted), sideways_yields};
    free->by_across = fixed3_scaled_q30(free->across.follows, share);
    free->by_across.y = plus(free->by_across.y, follow(curled_q24, across_yields, ranges, noted));
    free->by_sideways = fixed3_scaled_q30(free->sideways.follows, share);
    free->by_sideways.z = plus(free->by_sideways.z, follow(curled_q24, sideways_yields, ranges, noted));

    const int32_t across_spread = overloaded(link->across_spread_q31 >> turn_shift, overload, noted);
    const int32_t sideways_spread = overloaded(link->sideways_spread_q31 >> turn_shift, overload, noted);
    if (overload != NULL) {
        const int32_t third_y = turn.y / 3, third_z = turn.z / 3; /* of half the moment: a sixth */
        own.yy = less(own.yy, by_q29(half_m.z, third_z));
        own.yz = plus(own.yz, coarse(sum2(half_m.z, third_y, half_m.y, third_z), 30));
        own.zz = less(own.zz, by_q29(half_m.y, third_y));
        fixed3_t own_across = fixed3_scaled_q30(across, share), own_sideways = fixed3_scaled_q30(sideways, share);
        own_across.y = plus(own_across.y, curled_q24);
        own_sideways.z = plus(own_sideways.z, curled_q24);
        own.yy = plus(own.yy, by_ratio(m.x >> 3, follow(m.x >> 3, across_spread, ranges, noted), ranges));
        own.zz = plus(own.zz, by_ratio(m.x >> 3, follow(m.x >> 3, sideways_spread, ranges, noted), ranges));
        fixed_sym3_add(&own, own_across, free->by_across, ranges, noted);
        fixed_sym3_add(&own, own_sideways, free->by_sideways, ranges, noted);
        fixed_sym3_add(&held->resists_q24, across, free->across.follows, ranges, noted);
        fixed_sym3_add(&held->resists_q24, sideways, free->sideways.follows, ranges, noted);
        x = fixed3_plus_ratio(fixed3_plus_ratio(x, across, free->by_across.x, ranges), sideways,
                              free->by_sideways.x, ranges);
        y = fixed3_plus_ratio(fixed3_plus_ratio(y, across, free->by_across.y, ranges), sideways,
                              free->by_sideways.y, ranges);
        z = fixed3_plus_ratio(fixed3_plus_ratio(z, across, free->by_across.z, ranges), sideways,
                              free->by_sideways.z, ranges);
    }

    if (!is_last) {
        const int32_t by_z = by_q29(by_q29(sideways_spread, turn.z), turn.z);
        const int32_t by_y = by_q29(by_q29(across_spread, turn.y), turn.y);
        const int32_t twist = plus(overloaded(link->twist_q31 >> turn_shift, overload, noted), plus(by_y, by_z));
        if (overload != NULL) { /* whose ratios are 16 times as large */
            note_own(own.xy, ranges, noted);
            note_own(own.xz, ranges, noted);
        }
        free->x = fixed_eliminate(held, x, own.xx, twist, overload, noted);
        free->y_by_x = follow(own.xy, free->x.yields_q26, ranges, noted);
        free->z_by_x = follow(own.xz, free->x.yields_q26, ranges, noted);
        own.yy = plus(own.yy, by_ratio(own.xy, free->y_by_x, ranges));
        own.yz = plus(own.yz, by_ratio(own.xz, free->y_by_x, ranges));
        own.zz = plus(own.zz, by_ratio(own.xz, free->z_by_x, ranges));
        y = fixed3_plus_ratio(y, x, free->y_by_x, ranges);
        z = fixed3_plus_ratio(z, x, free->z_by_x, ranges);
    }
    note_own(own.yz, ranges, noted);
    note_own(own.zz, ranges, noted);
    const int32_t sideways_turns = overloaded(link->sideways_q31 >> turn_shift, overload, noted);
    const int32_t bends = overloaded(link->bend_q31 >> turn_shift, overload, noted);
    free->y = fixed_eliminate(held, y, own.yy, sideways_turns, overload, noted);
    free->z_by_y = follow(own.yz, free->y.yields_q26, ranges, noted);
    free->z = fixed_eliminate(held, fixed3_plus_ratio(z, y, free->z_by_y, ranges),
                              plus(own.zz, by_ratio(own.yz, free->z_by_y, ranges)),
                              bends, overload, noted);
}

INLINE void fixed_eliminate_limb(const brace_loaded_space_fixed_t *limb, const fixed_rest3_t *rest,
                                 fixed_overload_t *overload, fixed_freedoms_t *free, noted_t *noted)
{
    const fixed_turns3_t *turns = &rest->turns;
    const brace_space_fixed_pose_t *pose = &rest->pose;
    fixed_held_t held = {{0, 0, 0, 0, 0, 0}, {0, 0, 0}};
    fixed_eliminate_link(&limb->tibia, rest, pose->tibia, &rest->tibia, true, overload, &held, &free->tibia,
                         noted);
    fixed_held_about_y(&held, turns->tibia_y);
    free->knee = fixed_eliminate_joint(&held, rest->knee_q26, overload, noted);
    fixed_held_about_z(&held, turns->knee);
    fixed_held_about_y(&held, turns->femur_y);
    fixed_held_about_x(&held, turns->femur_x);
    fixed_eliminate_link(&limb->femur, rest, pose->femur, &rest->femur, false, overload, &held, &free->femur,
                         noted);
    fixed_held_about_y(&held, turns->femur_y);
    free->hip = fixed_eliminate_joint(&held, rest->hip_q26, overload, noted);
    fixed_held_about_z(&held, turns->hip);
    fixed_held_about_y(&held, turns->coxa_y);
    fixed_held_about_x(&held, turns->coxa_x);
    fixed_eliminate_link(&limb->coxa, rest, pose->coxa, &rest->coxa, false, overload, &held, &free->coxa,
                         noted);
    fixed_held_about_y(&held, turns->coxa_y);
    fixed_held_about_z(&held, turns->coxa_z);
    const fixed_sym3_t r = held.resists_q24;
    const fixed3_t m = held.moment_q27, row = fixed3(less(r.xy, m.z >> 4), r.yy, plus(r.yz, m.x >> 4));
    free->yaw = fixed_eliminate(&held, row, r.yy, overloaded(rest->yaw_q26, overload, noted), overload, noted);
    fixed_sym3_about_y(&held.resists_q24, turns->yaw);
    const int32_t base_x_q30 = fixed_about_z(overload_of(rest->whole_q30, overload), fixed_back(turns->base)).x;
    const int32_t entry = less(held.resists_q24.zz, high_of(limb->coxa.length_q28, base_x_q30) >> 2);
    free->base_yields_q26 = eliminated_yields(overloaded(rest->base_q26, overload, noted), entry, overload, noted);
}

#endif
