/* At the equilibrium in space, in fixed point: C, as in loaded/space_sum.h. */
#ifndef BRACE_CORE_FIXED_SPACE_SUM_H
#define BRACE_CORE_FIXED_SPACE_SUM_H

#include "fixed_space/bent.h"
#include "fixed_space/eliminate.h"

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
