/* At the equilibrium in space, in fixed point: loaded/space_sum.h in integers. */
#ifndef BRACE_CORE_FIXED_SPACE_SUM_H
#define BRACE_CORE_FIXED_SPACE_SUM_H

#include "fixed_space/bent.h"

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

/* Of all pivots, 2^exponent times a mantissa that is at least a half. */
typedef struct {
    int32_t mantissa_q31, exponent;
} fixed_product_t;

INLINE void multiply_by_pivot(fixed_product_t *product, int32_t pivot_q27)
{
    const int32_t by = times(product->mantissa_q31, pivot_q27, 31); /* a pivot is below 16: q27 */
    const uint32_t zeros = leading_zeros((uint32_t)by | 1u) - 1u;
    product->mantissa_q31 = (int32_t)((uint32_t)by << zeros);
    product->exponent += 4 - (int32_t)zeros;
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

INLINE fixed_freedom_t fixed_eliminate(fixed_held_t *held, fixed3_t row_q24, int32_t entry_q24, int32_t yields_q26,
                                       fixed_product_t *pivots, noted_t *noted)
{
    const int32_t pivot = pivot_of(yields_q26, entry_q24, noted);
    const int32_t yields = softened_of(yields_q26, inverse_q27(pivot), noted);
    multiply_by_pivot(pivots, pivot);
    note_row(row_q24, noted);
    const fixed3_t follows = follow(row_q24, yields, noted);
    fixed_sym3_add(&held->resists_q24, row_q24, follows, noted);
    return (fixed_freedom_t){follows, yields};
}

INLINE fixed_freedom_t fixed_eliminate_joint(fixed_held_t *held, int32_t yields_q26, fixed_product_t *pivots,
                                             noted_t *noted)
{
    const fixed_sym3_t r = held->resists_q24;
    const fixed3_t m = held->moment_q27, row = fixed3(plus(r.xz, m.y >> 4), less(r.yz, m.x >> 4), r.zz);
    return fixed_eliminate(held, row, r.zz, yields_q26, pivots, noted);
}

/* is_last: nothing lies beyond the link. What the load softens at the link's end springs is left out. */
INLINE void fixed_eliminate_link(const fixed_link3_t *link, const fixed_rest3_t *rest, fixed3_t turn,
                                 const fixed_bent3_t *bent, bool is_last, fixed_held_t *held,
                                 fixed_link_freedoms_t *free, fixed_product_t *pivots, noted_t *noted)
{
    const fixed3_t f = bent->beyond_q30, chord_f = fixed3_plus(f, fixed3_halved(bent->own_q30, 1));
    const fixed3_t m = held->moment_q27, chord_q27 = fixed3_cross(bent->chord_q28, chord_f, 31);
    const fixed_sym3_t r = held->resists_q24, chord = fixed_chord_resists(bent->chord_q28, chord_f);
    const int32_t curl_y = bent->across_curl_q30, curl_z = bent->sideways_curl_q30;
    const fixed_vec_t by_bend = bent->by_bend_q28;
    const int32_t by_sideways = bent->by_sideways_q28;
    const uint32_t turn_shift = rest->turn_shift, arm = link->arm_shift;

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
    const fixed3_t x = fixed3(q.xx, plus(q.xy, half_m.z), less(q.xz, half_m.y));
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
    const int32_t across_yields = link->across_arm_q31 >> turn_shift;
    const int32_t sideways_yields = link->sideways_arm_q31 >> turn_shift, sideways_x = bent->sideways_x_q30;
    const fixed3_t across = fixed3_halved(fixed3_cross(f, bent->across_q30, 30), 6u + arm);
    const fixed3_t sideways = fixed3_halved(
        fixed3(f.y, less(by_q30(f.z, sideways_x), f.x), minus(by_q30(f.y, sideways_x))), 6u + arm);
    free->across = (fixed_freedom_t){follow(across, across_yields, noted), across_yields};
    free->sideways = (fixed_freedom_t){follow(sideways, sideways_yields, noted), sideways_yields};
    free->by_across = fixed3_scaled_q30(free->across.follows, share);
    free->by_across.y = plus(free->by_across.y, follows_of(across_yields, curled_q24, noted));
    free->by_sideways = fixed3_scaled_q30(free->sideways.follows, share);
    free->by_sideways.z = plus(free->by_sideways.z, follows_of(sideways_yields, curled_q24, noted));

    if (!is_last) {
        const int32_t by_z = by_q29(by_q29(link->sideways_spread_q31 >> turn_shift, turn.z), turn.z);
        const int32_t by_y = by_q29(by_q29(link->across_spread_q31 >> turn_shift, turn.y), turn.y);
        const int32_t twist = plus(link->twist_q31 >> turn_shift, plus(by_y, by_z));
        free->x = fixed_eliminate(held, x, own.xx, twist, pivots, noted);
        free->y_by_x = follows_of(free->x.yields_q26, own.xy, noted);
        free->z_by_x = follows_of(free->x.yields_q26, own.xz, noted);
        own.yy = plus(own.yy, by_q29(own.xy, free->y_by_x));
        own.yz = plus(own.yz, by_q29(own.xz, free->y_by_x));
        own.zz = plus(own.zz, by_q29(own.xz, free->z_by_x));
        y = fixed3_plus_q29(y, x, free->y_by_x);
        z = fixed3_plus_q29(z, x, free->z_by_x);
    }
    free->y = fixed_eliminate(held, y, own.yy, link->sideways_q31 >> turn_shift, pivots, noted);
    free->z_by_y = follows_of(free->y.yields_q26, own.yz, noted);
    free->z = fixed_eliminate(held, fixed3_plus_q29(z, y, free->z_by_y), plus(own.zz, by_q29(own.yz, free->z_by_y)),
                              link->bend_q31 >> turn_shift, pivots, noted);
}

INLINE void fixed_held_about_x(fixed_held_t *held, fixed_vec_t turn)
{
    fixed_sym3_about_x(&held->resists_q24, turn);
    held->moment_q27 = fixed_about_x(held->moment_q27, turn);
}

INLINE void fixed_held_about_y(fixed_held_t *held, fixed_vec_t turn)
{
    fixed_sym3_about_y(&held->resists_q24, turn);
    held->moment_q27 = fixed_about_y(held->moment_q27, turn);
}

INLINE void fixed_eliminate_limb(const brace_loaded_space_fixed_t *limb, const fixed_rest3_t *rest,
                                 fixed_freedoms_t *free, fixed_product_t *pivots, noted_t *noted)
{
    const fixed_turns3_t *turns = &rest->turns;
    const brace_space_fixed_pose_t *pose = &rest->pose;
    fixed_held_t held = {{0, 0, 0, 0, 0, 0}, {0, 0, 0}};
    fixed_eliminate_link(&limb->tibia, rest, pose->tibia, &rest->tibia, true, &held, &free->tibia, pivots, noted);
    fixed_held_about_y(&held, turns->tibia_y);
    free->knee = fixed_eliminate_joint(&held, rest->knee_q26, pivots, noted);
    fixed_held_about_z(&held, turns->knee);
    fixed_held_about_y(&held, turns->femur_y);
    fixed_held_about_x(&held, turns->femur_x);
    fixed_eliminate_link(&limb->femur, rest, pose->femur, &rest->femur, false, &held, &free->femur, pivots, noted);
    fixed_held_about_y(&held, turns->femur_y);
    free->hip = fixed_eliminate_joint(&held, rest->hip_q26, pivots, noted);
    fixed_held_about_z(&held, turns->hip);
    fixed_held_about_y(&held, turns->coxa_y);
    fixed_held_about_x(&held, turns->coxa_x);
    fixed_eliminate_link(&limb->coxa, rest, pose->coxa, &rest->coxa, false, &held, &free->coxa, pivots, noted);
    fixed_held_about_y(&held, turns->coxa_y);
    fixed_held_about_z(&held, turns->coxa_z);
    const fixed_sym3_t r = held.resists_q24;
    const fixed3_t m = held.moment_q27, row = fixed3(less(r.xy, m.z >> 4), r.yy, plus(r.yz, m.x >> 4));
    free->yaw = fixed_eliminate(&held, row, r.yy, rest->yaw_q26, pivots, noted);
    fixed_sym3_about_y(&held.resists_q24, turns->yaw);
    const int32_t base_x_q30 = fixed_about_z(rest->whole_q30, fixed_back(turns->base)).x;
    const int32_t entry = less(held.resists_q24.zz, high_of(limb->coxa.length_q28, base_x_q30) >> 2);
    const int32_t pivot = pivot_of(rest->base_q26, entry, noted);
    multiply_by_pivot(pivots, pivot);
    free->base_yields_q26 = softened_of(rest->base_q26, inverse_q27(pivot), noted);
}

/* --- C -------------------------------------------------------------------------------------------------------- */

/* Whole sums of products. */
typedef struct {
    int64_t xx, xy, xz, yy, yz, zz;
} fixed_tensor3_t;

/* C (q54) so far, and how the tip moves (q26) when all beyond a place turns about the axes there; the tip from the base
 * and from the knee. All in the limb's plane's frame. */
typedef struct {
    fixed_axes_t by_turn;
    fixed_tensor3_t c;
    fixed3_t tip_q28, tibia_q28;
} fixed_sum_t;

#define LEVER_MOST_BITS 27  /* 2 */

INLINE int32_t yielded(int32_t move_q26, int32_t yields_q26, noted_t *noted)
{
    const int64_t product = (int64_t)move_q26 * yields_q26;
    note(noted, brace_high_word(product), 22);
    return shifted(product, 24);
}

INLINE void note_lever(fixed3_t lever_q26, noted_t *noted)
{
    note(noted, lever_q26.x, LEVER_MOST_BITS);
    note(noted, lever_q26.y, LEVER_MOST_BITS);
    note(noted, lever_q26.z, LEVER_MOST_BITS);
}

INLINE void note_levers(const fixed_axes_t *levers, noted_t *noted)
{
    note_lever(levers->x, noted);
    note_lever(levers->y, noted);
    note_lever(levers->z, noted);
}

INLINE void add_whole(int64_t *sum, int64_t more)
{
    *sum = (int64_t)((uint64_t)*sum + (uint64_t)more);
}

INLINE void add_product(int64_t *sum, int32_t a, int32_t b)
{
    add_whole(sum, (int64_t)a * b);
}

INLINE void fixed_add_move(fixed_sum_t *sum, fixed3_t move_q26, int32_t yields_q26, noted_t *noted)
{
    note_lever(move_q26, noted);
    const fixed3_t by_q28 = fixed3(yielded(move_q26.x, yields_q26, noted), yielded(move_q26.y, yields_q26, noted),
                                   yielded(move_q26.z, yields_q26, noted));
    add_product(&sum->c.xx, by_q28.x, move_q26.x);
    add_product(&sum->c.xy, by_q28.x, move_q26.y);
    add_product(&sum->c.xz, by_q28.x, move_q26.z);
    add_product(&sum->c.yy, by_q28.y, move_q26.y);
    add_product(&sum->c.yz, by_q28.y, move_q26.z);
    add_product(&sum->c.zz, by_q28.z, move_q26.z);
}

INLINE void fixed_add_freedom(fixed_sum_t *sum, const fixed_freedom_t *freedom, fixed3_t move_q26, noted_t *noted)
{
    sum->by_turn.x = fixed3_plus_q29(sum->by_turn.x, move_q26, freedom->follows.x);
    sum->by_turn.y = fixed3_plus_q29(sum->by_turn.y, move_q26, freedom->follows.y);
    sum->by_turn.z = fixed3_plus_q29(sum->by_turn.z, move_q26, freedom->follows.z);
    fixed_add_move(sum, move_q26, freedom->yields_q26, noted);
}

INLINE void fixed_add_joint(fixed_sum_t *sum, const fixed_freedom_t *joint, noted_t *noted)
{
    fixed_add_freedom(sum, joint, sum->by_turn.z, noted);
    note_levers(&sum->by_turn, noted);
}

/* An axial spring (q33) along a direction. */
INLINE void fixed_add_stretch(fixed_sum_t *sum, fixed3_t along_q30, int32_t yields_q33)
{
    const fixed3_t by_q31 = fixed3(high_of(along_q30.x, yields_q33), high_of(along_q30.y, yields_q33),
                                   high_of(along_q30.z, yields_q33));
    add_whole(&sum->c.xx, ((int64_t)by_q31.x * along_q30.x) >> 7);
    add_whole(&sum->c.xy, ((int64_t)by_q31.x * along_q30.y) >> 7);
    add_whole(&sum->c.xz, ((int64_t)by_q31.x * along_q30.z) >> 7);
    add_whole(&sum->c.yy, ((int64_t)by_q31.y * along_q30.y) >> 7);
    add_whole(&sum->c.yz, ((int64_t)by_q31.y * along_q30.z) >> 7);
    add_whole(&sum->c.zz, ((int64_t)by_q31.z * along_q30.z) >> 7);
}

/* A lever across a link (q26): by a chord's part (q28) along one axis, less another along the other. */
INLINE fixed3_t fixed_across(fixed3_t a, int32_t by_q28, fixed3_t b, int32_t less_q28)
{
    return fixed3(brace_high_word(sum2(a.x, by_q28, minus(b.x), less_q28)),
                  brace_high_word(sum2(a.y, by_q28, minus(b.y), less_q28)),
                  brace_high_word(sum2(a.z, by_q28, minus(b.z), less_q28)));
}

INLINE fixed3_t fixed3_plus_half(fixed3_t a, fixed3_t b)
{
    return fixed3_plus(a, fixed3_halved(b, 1));
}

/* a + an axis (q30) times a length (q28) */
INLINE fixed3_t fixed3_plus_axis(fixed3_t a, fixed3_t axis_q30, int32_t length_q28)
{
    return fixed3_plus(a, fixed3(high_of(axis_q30.x, length_q28), high_of(axis_q30.y, length_q28),
                                 high_of(axis_q30.z, length_q28)));
}

INLINE void fixed_add_link(fixed_sum_t *sum, const fixed_link3_t *link, const fixed_rest3_t *rest, fixed3_t turn,
                           const fixed_bent3_t *bent, const fixed_link_freedoms_t *free, const fixed_axes_t *axes,
                           bool is_last, noted_t *noted)
{
    const fixed3_t chord = bent->chord_q28;
    const fixed_axes_t beyond = sum->by_turn;
    const fixed_axes_t by_chord = {fixed_across(axes->z, chord.y, axes->y, chord.z),
                                   fixed_across(axes->x, chord.z, axes->z, chord.x),
                                   fixed_across(axes->y, chord.x, axes->x, chord.y)};
    const uint32_t arm = 2u + link->arm_shift;
    fixed3_t across = fixed3_halved(fixed_axes_times(axes, bent->across_q30), arm);
    const int32_t sideways_x = bent->sideways_x_q30;
    fixed3_t sideways = fixed3_halved(fixed3_plus_q30(axes->z, axes->x, sideways_x), 2u + arm);
    fixed3_t y = fixed3_plus_axis(fixed3_plus_half(beyond.y, by_chord.y), axes->x, bent->by_sideways_q28);
    fixed3_t z = fixed3_plus_axis(fixed3_plus_half(beyond.z, by_chord.z), axes->x, bent->by_bend_q28.x);
    z = fixed3_plus_axis(z, axes->y, bent->by_bend_q28.z);
    if (!is_last) {
        across = fixed3_plus_q29(across, beyond.x, minus(by_q30(turn.y, link->curl_q30)));
        sideways = fixed3_plus_q29(sideways, beyond.x, minus(by_q30(turn.z, link->curl_q30)));
        y = fixed3_plus_q30(y, beyond.x, minus(bent->across_curl_q30));
        z = fixed3_plus_q30(z, beyond.x, minus(bent->sideways_curl_q30));
    }
    y = fixed3_plus_q29(fixed3_plus_q29(y, across, free->by_across.y), sideways, free->by_sideways.y);
    z = fixed3_plus_q29(fixed3_plus_q29(z, across, free->by_across.z), sideways, free->by_sideways.z);
    sum->by_turn.x = fixed3_plus(beyond.x, by_chord.x);
    sum->by_turn.y = fixed3_plus(beyond.y, by_chord.y);
    sum->by_turn.z = fixed3_plus(beyond.z, by_chord.z);
    if (!is_last) {
        fixed3_t x = fixed3_plus_half(beyond.x, by_chord.x);
        x = fixed3_plus_q29(fixed3_plus_q29(x, across, free->by_across.x), sideways, free->by_sideways.x);
        y = fixed3_plus_q29(y, x, free->y_by_x);
        z = fixed3_plus_q29(z, x, free->z_by_x);
        fixed_add_freedom(sum, &free->x, x, noted);
    }
    fixed_add_freedom(sum, &free->across, across, noted);
    fixed_add_freedom(sum, &free->sideways, sideways, noted);
    fixed_add_freedom(sum, &free->y, y, noted);
    fixed_add_freedom(sum, &free->z, fixed3_plus_q29(z, y, free->z_by_y), noted);
    note_levers(&sum->by_turn, noted);

    const int32_t share_y = by_q29(link->stretch_end_share_q30, turn.y);
    const int32_t share_z = by_q29(link->stretch_end_share_q30, turn.z);
    const fixed_vec_t root = link->along_q30;
    const fixed3_t own = fixed3(less(root.x, by_q30(share_z, root.z)), plus(root.z, by_q30(share_z, root.x)),
                                minus(by_q30(share_y, root.x)));
    const fixed3_t along = fixed3_doubled(fixed_axes_times(axes, own), 2);
    fixed_add_stretch(sum, along, link->stretch_q31 >> rest->spring_shift);
    sum->tip_q28 = fixed3_plus(sum->tip_q28, fixed3_doubled(fixed_axes_times(axes, chord), 2));
}

static void fixed_sum_limb(const brace_loaded_space_fixed_t *limb, const fixed_rest3_t *rest,
                           const fixed_freedoms_t *free, const fixed_frames_t *frames, fixed_sum_t *s, noted_t *noted)
{
    const fixed_turns3_t *turns = &rest->turns;
    const brace_space_fixed_pose_t *pose = &rest->pose;
    const int32_t coxa = limb->coxa.length_q28;
    const fixed3_t none = {0, 0, 0};
    *s = (fixed_sum_t){.by_turn = {none, none, none},
                       .c = {.xx = (int64_t)(limb->base_x_q31 >> rest->spring_shift) << 21,
                             .yy = (int64_t)(limb->base_z_q31 >> rest->spring_shift) << 21},
                       .tip_q28 = fixed3(minus(by_q30(coxa, turns->base.x)), minus(by_q30(coxa, turns->base.z)), 0)};
    fixed_add_link(s, &limb->tibia, rest, pose->tibia, &rest->tibia, &free->tibia, &frames->tibia, true, noted);
    s->tibia_q28 = fixed3_doubled(fixed_axes_times(&frames->tibia, rest->tibia.chord_q28), 2);
    fixed_axes_about_y(&s->by_turn, turns->tibia_y);
    fixed_add_joint(s, &free->knee, noted);
    fixed_axes_about_z(&s->by_turn, turns->knee);
    fixed_axes_about_y(&s->by_turn, turns->femur_y);
    fixed_axes_about_x(&s->by_turn, turns->femur_x);
    fixed_add_link(s, &limb->femur, rest, pose->femur, &rest->femur, &free->femur, &frames->femur, false, noted);
    fixed_axes_about_y(&s->by_turn, turns->femur_y);
    fixed_add_joint(s, &free->hip, noted);
    fixed_axes_about_z(&s->by_turn, turns->hip);
    fixed_axes_about_y(&s->by_turn, turns->coxa_y);
    fixed_axes_about_x(&s->by_turn, turns->coxa_x);
    fixed_add_link(s, &limb->coxa, rest, pose->coxa, &rest->coxa, &free->coxa, &frames->coxa, false, noted);
    fixed_axes_about_y(&s->by_turn, turns->coxa_y);
    fixed_axes_about_z(&s->by_turn, turns->coxa_z);
    fixed_add_freedom(s, &free->yaw, s->by_turn.y, noted);
    fixed_axes_about_y(&s->by_turn, turns->yaw);
    const fixed3_t up = {minus(turns->base.z), turns->base.x, 0};
    fixed_add_move(s, fixed3_plus_axis(s->by_turn.z, up, minus(coxa)), free->base_yields_q26, noted);
}

#endif
