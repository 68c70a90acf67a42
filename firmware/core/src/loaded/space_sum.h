/* At the equilibrium in space: the limb's matrix, eliminated from the tip to the base, and C.
 *
 * C is a sum of one vector for each eliminated coordinate and each spring. A link's springs are eliminated first: what
 * moves its end turns with the link and all before it, so under a load they soften those.
 */
#ifndef BRACE_CORE_SPACE_SUM_H
#define BRACE_CORE_SPACE_SUM_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "loaded/space_bent.h"

typedef brace_space_freedom_t freedom_t;
typedef brace_space_link_freedoms_t link_freedoms_t;
typedef brace_space_freedoms_t freedoms_t;
typedef brace_space_pivots_t pivots_t;

INLINE bool is_stable(const pivots_t *pivots)
{
    return pivots->sign_bits >> 31 == 0u;
}

/* --- elimination ---------------------------------------------------------------------------------------------- */

INLINE sym3_t chord_resists(vec3_t chord_mm, vec3_t f)
{
    const float xx = chord_mm.x * f.x, yy = chord_mm.y * f.y, zz = chord_mm.z * f.z;
    return (sym3_t){yy + zz,
                    -0.5f * brace_fma(chord_mm.x, f.y, chord_mm.y * f.x),
                    -0.5f * brace_fma(chord_mm.x, f.z, chord_mm.z * f.x),
                    xx + zz,
                    -0.5f * brace_fma(chord_mm.y, f.z, chord_mm.z * f.y),
                    xx + yy};
}

INLINE freedom_t eliminate(held_t *held, vec3_t row, float entry, float rad_per_n_mm, pivots_t *pivots)
{
    const float pivot = brace_fma(rad_per_n_mm, entry, 1.0f), yields = rad_per_n_mm / pivot;
    const vec3_t follows = vec3_scaled(row, -yields);
    sym3_add(&held->resists, row, follows);
    uint32_t bits;
    memcpy(&bits, &pivot, sizeof bits);
    pivots->sign_bits |= bits;
    pivots->product *= pivot;
    return (freedom_t){follows, yields};
}

/* How stiffly everything before a link resists the link's own turns. A unit turn about y, or z, also turns the link by
 * -curl_y, or -curl_z, about x. */
INLINE sym3_t own_turns_resist(sym3_t r, float curl_y, float curl_z)
{
    sym3_t own = r;
    own.xy = brace_fma(-curl_y, r.xx, r.xy);
    own.xz = brace_fma(-curl_z, r.xx, r.xz);
    own.yy = brace_fma(-curl_y, r.xy + own.xy, r.yy);
    own.yz = brace_fma(-curl_z, own.xy, brace_fma(-curl_y, r.xz, r.yz));
    own.zz = brace_fma(-curl_z, r.xz + own.xz, r.zz);
    return own;
}

/* The moments on what lies before for a unit turn of all beyond about y, and about z. */
INLINE vec3_t row_of_y(const held_t *held)
{
    const sym3_t r = held->resists;
    const vec3_t m = held->moment_n_mm;
    return vec3(brace_fma(-0.5f, m.z, r.xy), r.yy, brace_fma(0.5f, m.x, r.yz));
}

INLINE vec3_t row_of_z(const held_t *held)
{
    const sym3_t r = held->resists;
    const vec3_t m = held->moment_n_mm;
    return vec3(brace_fma(0.5f, m.y, r.xz), brace_fma(-0.5f, m.x, r.yz), r.zz);
}

INLINE freedom_t eliminate_joint(held_t *held, float rad_per_n_mm, pivots_t *pivots)
{
    return eliminate(held, row_of_z(held), held->resists.zz, rad_per_n_mm, pivots);
}

/* What a link's end springs, where they move apart, and the axis of the twist behind them add: to the stiffness of the
 * link's own turns, and to the twist's row. See space_bent.h. */
INLINE void count_end(const brace_space_link_t *link, vec3_t turn, const brace_space_bent_t *bent, const held_t *held,
                      sym3_t *own, vec3_t *row_x)
{
    const sym3_t r = held->resists;
    const vec3_t m = held->moment_n_mm;
    const brace_vec_t leans = twist_leans(link, turn);
    const apart_t apart = moves_apart(link, bent, m);
    const float pulls = apart.pulls_n_mm, twists = apart.twists_n_mm;
    const float across = link->across_spread_per_n_mm, sideways = link->sideways_spread_per_n_mm;
    own->xx = brace_fma(2.0f * leans.x, r.xy, brace_fma(2.0f * leans.z, r.xz, own->xx));
    own->xy = brace_fma(leans.x, r.yy, brace_fma(leans.z, r.yz, brace_fma(link->twist_end_half, m.z, own->xy)));
    own->xz = brace_fma(leans.x, r.yz, brace_fma(leans.z, r.zz, brace_fma(-link->twist_end_half, m.y, own->xz)));
    own->yy = brace_fma(-across * twists, twists, brace_fma(-sideways * pulls, pulls, own->yy));
    own->yz = brace_fma((across - sideways) * pulls, twists, own->yz);
    own->zz = brace_fma(-across * pulls, pulls, brace_fma(-sideways * twists, twists, own->zz));
    *row_x = vec3_plus_scaled(vec3_plus_scaled(*row_x, row_of_y(held), leans.x), row_of_z(held), leans.z);
}

/* Adds a spring of a link. Everything before it resists less then, and the link's own turns too.
 * row: the moments on what lies before for a unit of the spring's move; on_own: those on the link's own turns
 * follows, by_own: both times how the spring yields, less */
INLINE void soften_link(vec3_t row, vec3_t follows, vec3_t on_own, vec3_t by_own, held_t *held, sym3_t *own,
                        axes_t *rows)
{
    sym3_add(&held->resists, row, follows);
    sym3_add(own, on_own, by_own);
    rows->x = vec3_plus_scaled(rows->x, row, by_own.x);
    rows->y = vec3_plus_scaled(rows->y, row, by_own.y);
    rows->z = vec3_plus_scaled(rows->z, row, by_own.z);
}

/* is_last: nothing lies beyond the link. */
INLINE void eliminate_link(const brace_space_link_t *link, vec3_t turn, const brace_space_bent_t *bent, bool is_last,
                           held_t *held, link_freedoms_t *free, pivots_t *pivots)
{
    const vec3_t f = bent->beyond_n, chord_f = vec3_plus_scaled(f, bent->own_n, 0.5f);
    const vec3_t m = held->moment_n_mm, chord_n_mm = vec3_cross(bent->chord_mm, chord_f);
    const sym3_t r = held->resists, chord = chord_resists(bent->chord_mm, chord_f);
    const float curl_y = bent->across_curl, curl_z = bent->sideways_curl;
    const brace_vec_t by_bend = bent->by_bend_mm;
    const float by_sideways = bent->by_sideways_mm;

    /* Among the link's own turns, and between them and all before. */
    sym3_t own = is_last ? r : own_turns_resist(r, curl_y, curl_z);
    const float twist = link->twist_share, half_twist = 0.5f * twist;
    own.xx = brace_fma(twist * twist, chord.xx, own.xx);
    own.xy = brace_fma(half_twist, chord.xy, own.xy);
    own.xz = brace_fma(half_twist, chord.xz, own.xz);
    own.yy = brace_fma(link->twelfth_mm, f.x, brace_fma(0.25f, chord.yy, own.yy));
    own.yz = brace_fma(0.25f, chord.yz, own.yz);
    own.zz = brace_fma(brace_fma(-2.0f, link->bow_mm.x, by_bend.z), f.x, brace_fma(0.25f, chord.zz, own.zz));
    own.zz = brace_fma(brace_fma(-2.0f, link->bow_mm.z, -by_bend.x), f.y, own.zz);
    const sym3_t q = sym3_plus_scaled(r, chord, 0.5f);
    const vec3_t half_m = vec3_scaled(vec3_plus_scaled(m, chord_n_mm, 0.5f), 0.5f);
    axes_t rows;
    rows.x = vec3(brace_fma(twist, chord.xx, r.xx),
                  brace_fma(twist, chord.xy, brace_fma(0.5f, brace_fma(twist, chord_n_mm.z, m.z), r.xy)),
                  brace_fma(twist, chord.xz, brace_fma(-0.5f, brace_fma(twist, chord_n_mm.y, m.y), r.xz)));
    rows.y = vec3(q.xy - half_m.z, brace_fma(by_sideways, f.z, q.yy), brace_fma(-by_sideways, f.y, q.yz + half_m.x));
    rows.z = vec3(brace_fma(-by_bend.z, f.z, q.xz + half_m.y), brace_fma(by_bend.x, f.z, q.yz - half_m.x),
                  brace_fma(-by_bend.x, f.y, brace_fma(by_bend.z, f.x, q.zz)));
    if (!is_last) {
        count_end(link, turn, bent, held, &own, &rows.x);
        rows.y = vec3_plus_scaled(rows.y, rows.x, -curl_y);
        rows.z = vec3_plus_scaled(rows.z, rows.x, -curl_z);
    }
    held->resists = sym3_plus_scaled(r, chord, 1.0f);
    held->moment_n_mm = vec3_plus(m, chord_n_mm);

    const float share = link->end_share + 0.5f, stretch_share = link->stretch_end_share + 0.5f;
    const float curled_n = link->curl_per_mm * m.x;
    const vec3_t across = vec3_cross(f, bent->across);
    const vec3_t sideways = vec3(f.y, brace_fma(f.z, bent->sideways.x, -f.x), -(f.y * bent->sideways.x));
    const vec3_t stretch = vec3(-(f.z * link->stretch_root.z), f.z * link->stretch_root.x,
                                brace_fma(f.x, link->stretch_root.z, -(f.y * link->stretch_root.x)));
    const vec3_t on_across = vec3(twist * across.x, brace_fma(share, across.y, curled_n), share * across.z);
    const vec3_t on_sideways = vec3(twist * sideways.x, share * sideways.y, brace_fma(share, sideways.z, curled_n));
    const vec3_t on_stretch = vec3(0.0f, stretch_share * stretch.y, stretch_share * stretch.z);
    const float across_yields = end_yields(link, link->across_mm_per_n, f.x);
    const float sideways_yields = end_yields(link, link->sideways_mm_per_n, f.x);
    free->across = (freedom_t){vec3_scaled(across, -across_yields), across_yields};
    free->sideways = (freedom_t){vec3_scaled(sideways, -sideways_yields), sideways_yields};
    free->stretch_follows = vec3_scaled(stretch, -1.0f);
    free->by_across = vec3_scaled(on_across, -across_yields);
    free->by_sideways = vec3_scaled(on_sideways, -sideways_yields);
    free->y_by_stretch = -on_stretch.y;
    free->z_by_stretch = -on_stretch.z;
    soften_link(across, free->across.follows, on_across, free->by_across, held, &own, &rows);
    soften_link(sideways, free->sideways.follows, on_sideways, free->by_sideways, held, &own, &rows);
    soften_link(stretch, free->stretch_follows, on_stretch, vec3_scaled(on_stretch, -1.0f), held, &own, &rows);
    if (!is_last) {
        float yields = brace_fma(link->sideways_spread_per_n_mm * turn.z, turn.z, link->twist_rad_per_n_mm);
        yields = brace_fma(link->across_spread_per_n_mm * turn.y, turn.y, yields);
        free->x = eliminate(held, rows.x, own.xx, yields, pivots);
        free->y_by_x = -(free->x.yields * own.xy);
        free->z_by_x = -(free->x.yields * own.xz);
        own.yy = brace_fma(free->y_by_x, own.xy, own.yy);
        own.yz = brace_fma(free->y_by_x, own.xz, own.yz);
        own.zz = brace_fma(free->z_by_x, own.xz, own.zz);
        rows.y = vec3_plus_scaled(rows.y, rows.x, free->y_by_x);
        rows.z = vec3_plus_scaled(rows.z, rows.x, free->z_by_x);
    }
    free->y = eliminate(held, rows.y, own.yy, link->sideways_rad_per_n_mm, pivots);
    free->z_by_y = -(free->y.yields * own.yz);
    free->z = eliminate(held, vec3_plus_scaled(rows.z, rows.y, free->z_by_y), brace_fma(free->z_by_y, own.yz, own.zz),
                        link->bend_rad_per_n_mm, pivots);
}

INLINE void held_about_x(held_t *held, brace_vec_t turn)
{
    sym3_about_x(&held->resists, turn);
    held->moment_n_mm = about_x(held->moment_n_mm, turn);
}

INLINE void held_about_y(held_t *held, brace_vec_t turn)
{
    sym3_about_y(&held->resists, turn);
    held->moment_n_mm = about_y(held->moment_n_mm, turn);
}

INLINE pivots_t eliminate_limb(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, freedoms_t *free)
{
    const brace_space_turns_t *turns = &rest->turns;
    const brace_space_pose_t *pose = &rest->pose;
    held_t held = {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    pivots_t pivots = {0u, 1.0f};
    eliminate_link(&loaded->tibia, pose->tibia, &rest->tibia, true, &held, &free->tibia, &pivots);
    held_about_y(&held, turns->tibia_y);
    free->knee = eliminate_joint(&held, rest->knee.slope_rad_per_n_mm, &pivots);
    held_about_z(&held, turns->knee);
    held_about_y(&held, turns->femur_y);
    held_about_x(&held, turns->femur_x);
    eliminate_link(&loaded->femur, pose->femur, &rest->femur, false, &held, &free->femur, &pivots);
    held_about_y(&held, turns->femur_y);
    free->hip = eliminate_joint(&held, rest->hip.slope_rad_per_n_mm, &pivots);
    held_about_z(&held, turns->hip);
    held_about_y(&held, turns->coxa_y);
    held_about_x(&held, turns->coxa_x);
    eliminate_link(&loaded->coxa, pose->coxa, &rest->coxa, false, &held, &free->coxa, &pivots);
    held_about_y(&held, turns->coxa_y);
    held_about_z(&held, turns->coxa_z);
    free->yaw = eliminate(&held, row_of_y(&held), held.resists.yy, rest->yaw.slope_rad_per_n_mm, &pivots);
    held_about_y(&held, turns->yaw);
    const float base_x_n = about_z(rest->whole_n, back(turns->base)).x;
    const float entry = brace_fma(-loaded->coxa.length_mm, base_x_n, held.resists.zz);
    free->base_yields = eliminate(&held, held.moment_n_mm, entry, loaded->base_rotation_rad_per_n_mm, &pivots).yields;
    return pivots;
}

/* --- C -------------------------------------------------------------------------------------------------------- */

typedef brace_space_sum_t sum_t;

INLINE void add_move(sum_t *sum, vec3_t move, float yields)
{
    sym3_add(&sum->c, move, vec3_scaled(move, yields));
}

INLINE void add_freedom(sum_t *sum, const freedom_t *freedom, vec3_t move)
{
    sum->by_turn.x = vec3_plus_scaled(sum->by_turn.x, move, freedom->follows.x);
    sum->by_turn.y = vec3_plus_scaled(sum->by_turn.y, move, freedom->follows.y);
    sum->by_turn.z = vec3_plus_scaled(sum->by_turn.z, move, freedom->follows.z);
    add_move(sum, move, freedom->yields);
}

INLINE void add_joint(sum_t *sum, const freedom_t *joint)
{
    add_freedom(sum, joint, sum->by_turn.z);
}

INLINE void add_link(sum_t *sum, const brace_space_link_t *link, vec3_t turn, const brace_space_bent_t *bent,
                     const link_freedoms_t *free, const axes_t *axes, bool is_last)
{
    const vec3_t chord = bent->chord_mm;
    const axes_t beyond = sum->by_turn;
    const axes_t by_chord = {
        vec3_plus_scaled(vec3_scaled(axes->z, chord.y), axes->y, -chord.z),
        vec3_plus_scaled(vec3_scaled(axes->x, chord.z), axes->z, -chord.x),
        vec3_plus_scaled(vec3_scaled(axes->y, chord.x), axes->x, -chord.y),
    };
    vec3_t across = axes_times(axes, bent->across);
    vec3_t sideways = vec3_plus_scaled(axes->z, axes->x, bent->sideways.x);
    vec3_t y = vec3_plus_scaled(vec3_plus_scaled(beyond.y, by_chord.y, 0.5f), axes->x, bent->by_sideways_mm);
    vec3_t z = vec3_plus_scaled(vec3_plus_scaled(beyond.z, by_chord.z, 0.5f), axes->x, bent->by_bend_mm.x);
    z = vec3_plus_scaled(z, axes->y, bent->by_bend_mm.z);
    if (!is_last) {
        across = vec3_plus_scaled(across, beyond.x, -(link->curl_per_mm * turn.y));
        sideways = vec3_plus_scaled(sideways, beyond.x, -(link->curl_per_mm * turn.z));
        y = vec3_plus_scaled(y, beyond.x, -bent->across_curl);
        z = vec3_plus_scaled(z, beyond.x, -bent->sideways_curl);
    }
    const float share_y = link->stretch_end_share * turn.y, share_z = link->stretch_end_share * turn.z;
    const brace_vec_t root = link->stretch_root;
    const vec3_t own_stretch =
        vec3(brace_fma(-share_z, root.z, root.x), brace_fma(share_z, root.x, root.z), -(share_y * root.x));
    const vec3_t stretch = axes_times(axes, own_stretch);
    y = vec3_plus_scaled(vec3_plus_scaled(y, across, free->by_across.y), sideways, free->by_sideways.y);
    y = vec3_plus_scaled(y, stretch, free->y_by_stretch);
    z = vec3_plus_scaled(vec3_plus_scaled(z, across, free->by_across.z), sideways, free->by_sideways.z);
    z = vec3_plus_scaled(z, stretch, free->z_by_stretch);
    sum->by_turn.x = vec3_plus(beyond.x, by_chord.x);
    sum->by_turn.y = vec3_plus(beyond.y, by_chord.y);
    sum->by_turn.z = vec3_plus(beyond.z, by_chord.z);
    if (!is_last) {
        vec3_t x = vec3_plus_scaled(beyond.x, by_chord.x, link->twist_share);
        const brace_vec_t leans = twist_leans(link, turn);
        x = vec3_plus_scaled(vec3_plus_scaled(x, beyond.y, leans.x), beyond.z, leans.z);
        x = vec3_plus_scaled(vec3_plus_scaled(x, across, free->by_across.x), sideways, free->by_sideways.x);
        y = vec3_plus_scaled(y, x, free->y_by_x);
        z = vec3_plus_scaled(z, x, free->z_by_x);
        add_freedom(sum, &free->x, x);
    }
    add_freedom(sum, &free->across, across);
    add_freedom(sum, &free->sideways, sideways);
    add_freedom(sum, &(freedom_t){free->stretch_follows, 1.0f}, stretch);
    add_freedom(sum, &free->y, y);
    add_freedom(sum, &free->z, vec3_plus_scaled(z, y, free->z_by_y));
    sum->tip_mm = vec3_plus(sum->tip_mm, axes_times(axes, chord));
}

/* From the tip to the hip. */
static void sum_outer(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, const freedoms_t *free,
                      const frames_t *frames, sum_t *sum)
{
    const brace_space_turns_t *turns = &rest->turns;
    const brace_space_pose_t *pose = &rest->pose;
    const vec3_t none = {0.0f, 0.0f, 0.0f};
    sum->by_turn = (axes_t){none, none, none};
    sum->c = (sym3_t){0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    sum->tip_mm = none;
    sum->tibia_mm = axes_times(&frames->tibia, rest->tibia.chord_mm);
    add_link(sum, &loaded->tibia, pose->tibia, &rest->tibia, &free->tibia, &frames->tibia, true);
    axes_about_y(&sum->by_turn, turns->tibia_y);
    add_joint(sum, &free->knee);
    axes_about_z(&sum->by_turn, turns->knee);
    axes_about_y(&sum->by_turn, turns->femur_y);
    axes_about_x(&sum->by_turn, turns->femur_x);
    add_link(sum, &loaded->femur, pose->femur, &rest->femur, &free->femur, &frames->femur, false);
    axes_about_y(&sum->by_turn, turns->femur_y);
    add_joint(sum, &free->hip);
}

/* From the hip to the base. */
static void sum_inner(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, const freedoms_t *free,
                      const axes_t *coxa, sum_t *sum)
{
    const brace_space_turns_t *turns = &rest->turns;
    const float coxa_mm = loaded->coxa.length_mm;
    axes_about_z(&sum->by_turn, turns->hip);
    axes_about_y(&sum->by_turn, turns->coxa_y);
    axes_about_x(&sum->by_turn, turns->coxa_x);
    add_link(sum, &loaded->coxa, rest->pose.coxa, &rest->coxa, &free->coxa, coxa, false);
    axes_about_y(&sum->by_turn, turns->coxa_y);
    axes_about_z(&sum->by_turn, turns->coxa_z);
    add_freedom(sum, &free->yaw, sum->by_turn.y);
    axes_about_y(&sum->by_turn, turns->yaw);
    const vec3_t up = {-turns->base.z, turns->base.x, 0.0f};
    add_move(sum, vec3_plus_scaled(sum->by_turn.z, up, -coxa_mm), free->base_yields);
    sum->c.xx += loaded->base_x_mm_per_n;
    sum->c.yy += loaded->base_z_mm_per_n;
    sum->tip_mm = vec3_plus_scaled(sum->tip_mm, vec3(turns->base.x, turns->base.z, 0.0f), -coxa_mm);
}

#endif
