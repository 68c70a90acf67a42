/* A limb in space with its links in parts, for the buckling factor: its determinant under a multiple of its load, with
 * the shape that it has now.
 *
 * The load bends and twists a link's parts against one another long before it folds the limb, first of all those of a
 * coxa link, which is short and bears the moments of a long limb. So the coxa link counts as two parts. A part is a
 * uniform beam: it turns about x, y and z of its own frame, half of it on either side of its chord, and its curvature
 * changes along it, which moves its end across. Behind the last part are the springs at the link's end.
 */
#ifndef BRACE_CORE_SPACE_PARTS_H
#define BRACE_CORE_SPACE_PARTS_H

#include "loaded/space_sum.h"

/* The index of each link's first part in brace_space_shape_t. */
static const int first_part[BRACE_LINK_COUNT + 1] = {0, BRACE_SPACE_COXA_PARTS, BRACE_SPACE_COXA_PARTS + 1,
                                                     BRACE_SPACE_PARTS};

/* --- the shape ------------------------------------------------------------------------------------------------ */

/* The loads, in the axes of one frame. */
typedef struct {
    vec3_t tip_n, down;
} loads_t;

INLINE void loads_about_x(loads_t *loads, brace_vec_t turn)
{
    loads->tip_n = about_x(loads->tip_n, turn);
    loads->down = about_x(loads->down, turn);
}

INLINE void loads_about_y(loads_t *loads, brace_vec_t turn)
{
    loads->tip_n = about_y(loads->tip_n, turn);
    loads->down = about_y(loads->down, turn);
}

INLINE void loads_about_z(loads_t *loads, brace_vec_t turn)
{
    loads->tip_n = about_z(loads->tip_n, turn);
    loads->down = about_z(loads->down, turn);
}

/* How a link is bent: `curl` of the rest is how far its beam's end is moved across, as a part of its length. That comes
 * from a curvature that falls from the root to the end; the turn alone is spread evenly. */
typedef struct {
    vec3_t turn;
    float across, sideways;
} bend_t;

INLINE bend_t bend_of(vec3_t turn, const brace_space_bent_t *bent)
{
    return (bend_t){turn, 12.0f * bent->across_curl, 12.0f * bent->sideways_curl};
}

/* The turns about y and z of a stretch whose middle lies `off` from the link's, both as parts of its length. */
INLINE float turned_y(const bend_t *bend, float off, float stretch)
{
    return brace_fma(bend->sideways, off, bend->turn.y) * stretch;
}

INLINE float turned_z(const bend_t *bend, float off, float stretch)
{
    return brace_fma(-bend->across, off, bend->turn.z) * stretch;
}

/* How far the first part of a link turns about z before its chord. */
INLINE float root_turn(vec3_t turn, const brace_space_bent_t *bent, int parts)
{
    const bend_t bend = bend_of(turn, bent);
    const float share = 1.0f / (float)parts;
    return 0.5f * turned_z(&bend, brace_fma(0.5f, share, -0.5f), share);
}

/* The shape of a part. share: of the link's length; off: of its middle from the link's middle. */
INLINE void shape_part(const brace_space_link_t *link, const bend_t *bend, float share, float off,
                       brace_space_part_t *part)
{
    const float y = turned_y(bend, off, share), z = turned_z(bend, off, share), length_mm = link->length_mm * share;
    const float per_part = share * share * (1.0f / 12.0f);
    const float across = per_part * bend->across, sideways = per_part * bend->sideways;
    const brace_vec_t bow_mm = vec_scaled(link->bow_mm, share), tilt_mm = vec_scaled(link->tilt_mm, 1.0f - 2.0f * off);
    const brace_vec_t bow = vec_plus_scaled(tilt_mm, bow_mm, z), twice = vec_plus_scaled(bow, bow_mm, z);
    const float half_bow_mm = -0.5f * link->twelfth_mm * share * y, across_mm = across * length_mm;
    part->about_y = brace_small_turn(0.5f * y);
    part->about_x = brace_small_turn(brace_fma(bend->turn.x, share, -brace_fma(across, y, sideways * z)));
    part->chord_mm =
        vec3(brace_fma(link->across.x, across_mm, length_mm), link->across.z * across_mm, sideways * length_mm);
    part->chord_mm.x = brace_fma(bow.x, z, brace_fma(half_bow_mm, y, part->chord_mm.x));
    part->chord_mm.y = brace_fma(bow.z, z, part->chord_mm.y);
    part->across_curl = across;
    part->sideways_curl = sideways;
    part->third_y_rad = y * (1.0f / 3.0f);
    part->third_z_rad = z * (1.0f / 3.0f);
    part->by_sideways_mm = half_bow_mm + half_bow_mm;
    part->by_bend_mm = twice;
    part->bend_twice_mm = (brace_vec_t){brace_fma(-2.0f, bow_mm.x, twice.z), -brace_fma(2.0f, bow_mm.z, twice.x)};
}

/* The parts of a link and the forces on them. loads: as its root sees them, then as its end does. */
INLINE void shape_link(const brace_space_link_t *link, const bend_t *bend, int parts, float beyond_n, loads_t *loads,
                       brace_space_part_t part[], brace_vec3_t *end_n, brace_vec3_t *end_mm)
{
    const float share = 1.0f / (float)parts;
    for (int i = 0; i < parts; i++) {
        const float off = brace_fma((float)i + 0.5f, share, -0.5f);
        shape_part(link, bend, share, off, &part[i]);
        loads_about_y(loads, back(part[i].about_y));
        part[i].own_n = vec3_scaled(loads->down, link->weight_n * share);
        part[i].beyond_n =
            vec3_plus_scaled(loads->tip_n, loads->down, brace_fma(link->weight_n, 0.5f - share * 0.5f - off, beyond_n));
        const float half = 0.5f * turned_z(bend, off, share);
        const float next = i + 1 < parts ? 0.5f * turned_z(bend, off + share, share) : 0.0f;
        part[i].about_z = brace_small_turn(half + next);
        loads_about_x(loads, back(part[i].about_x));
        loads_about_y(loads, back(part[i].about_y));
        loads_about_z(loads, back(part[i].about_z));
    }
    const vec3_t f = vec3_plus_scaled(loads->tip_n, loads->down, beyond_n);
    const float beam = link->curl_per_mm * link->length_mm;
    const float across_n = brace_fma(link->across.x, f.x, link->across.z * f.y);
    const float across_mm = (1.0f - beam) * link->across_mm_per_n * across_n;
    *end_n = f;
    *end_mm =
        vec3(link->across.x * across_mm, link->across.z * across_mm, (1.0f - beam) * link->sideways_mm_per_n * f.z);
}

static void shape_limb(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, brace_space_shape_t *shape)
{
    const brace_space_link_t *const links[BRACE_LINK_COUNT] = {&loaded->coxa, &loaded->femur, &loaded->tibia};
    const brace_space_bent_t *const bent[BRACE_LINK_COUNT] = {&rest->coxa, &rest->femur, &rest->tibia};
    const brace_space_pose_t *pose = &rest->pose;
    const vec3_t turn[BRACE_LINK_COUNT] = {pose->coxa, pose->femur, pose->tibia};
    const float joint_rad[BRACE_LINK_COUNT] = {0.0f, pose->hip, pose->knee};
    const brace_vec_t commanded[BRACE_LINK_COUNT] = {{1.0f, 0.0f}, rest->hip_commanded, rest->knee_commanded};
    const float beyond_n[BRACE_LINK_COUNT] = {loaded->beyond_coxa_n, loaded->beyond_femur_n, 0.0f};
    loads_t loads = {rest->tip_n, rest->down};
    loads_about_z(&loads, back(rest->turns.base));
    loads_about_y(&loads, back(rest->turns.yaw));
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const int from = first_part[i], parts = first_part[i + 1] - from;
        const bend_t bend = bend_of(turn[i], bent[i]);
        shape->about_joint[i] = joint_turn(commanded[i], joint_rad[i] + root_turn(turn[i], bent[i], parts));
        loads_about_z(&loads, back(shape->about_joint[i]));
        shape_link(links[i], &bend, parts, beyond_n[i], &loads, &shape->part[from], &shape->end_n[i],
                   &shape->end_mm[i]);
    }
    shape->whole_n = rest->whole_n;
    shape->yaw = rest->turns.yaw;
    shape->base = rest->turns.base;
    shape->joint_rad_per_n_mm[BRACE_COXA] = rest->yaw.slope_rad_per_n_mm;
    shape->joint_rad_per_n_mm[BRACE_FEMUR] = rest->hip.slope_rad_per_n_mm;
    shape->joint_rad_per_n_mm[BRACE_TIBIA] = rest->knee.slope_rad_per_n_mm;
}

/* --- its determinant ------------------------------------------------------------------------------------------ */

INLINE vec3_t in_plane(brace_vec_t v)
{
    return vec3(v.x, v.z, 0.0f);
}

/* Adds a spring. Everything before it resists less then. row: the moments on what lies before, for a unit of the
 * spring's move. */
INLINE void soften(held_t *held, vec3_t row, float yields)
{
    sym3_add(&held->resists, row, vec3_scaled(row, -yields));
}

/* Adds the springs at a link's end: those that move the end, the link's axial spring among them, and then a twist. */
INLINE void hold_end(const brace_space_link_t *link, vec3_t end_n, vec3_t end_mm, held_t *held, pivots_t *pivots)
{
    const float beam = link->curl_per_mm * link->length_mm, twists = 0.5f + link->stretch_end_share;
    const sym3_t r = held->resists;
    const vec3_t m = held->moment_n_mm, row = vec3(r.xx, brace_fma(0.5f, m.z, r.xy), brace_fma(-0.5f, m.y, r.xz));
    (void)eliminate(held, row, r.xx, twists * link->twist_rad_per_n_mm, pivots);
    soften(held, vec3_cross(end_n, in_plane(link->across)), (1.0f - beam) * link->across_mm_per_n);
    soften(held, vec3(end_n.y, -end_n.x, 0.0f), (1.0f - beam) * link->sideways_mm_per_n);
    soften(held, vec3_cross(end_n, in_plane(link->stretch_root)), 1.0f);
    held->resists = sym3_plus_scaled(held->resists, chord_resists(end_mm, end_n), 1.0f);
    held->moment_n_mm = vec3_plus(held->moment_n_mm, vec3_cross(end_mm, end_n));
}

/* Adds a part and its own turns. */
INLINE void hold_part(const brace_space_link_t *link, const brace_space_part_t *part, float share, float times,
                      held_t *held, pivots_t *pivots)
{
    const vec3_t f = vec3_scaled(part->beyond_n, times), chord_f = vec3_plus_scaled(f, part->own_n, 0.5f * times);
    const float length_mm = link->length_mm * share, per_part = share * (1.0f / 12.0f);
    const brace_vec_t by_bend = part->by_bend_mm;
    const float by_sideways = part->by_sideways_mm, curl_y = part->across_curl, curl_z = part->sideways_curl;
    held_about_z(held, part->about_z);
    held_about_y(held, part->about_y);
    held_about_x(held, part->about_x);
    const vec3_t m = held->moment_n_mm, chord_n_mm = vec3_cross(part->chord_mm, chord_f);
    const vec3_t half_m = vec3_scaled(vec3_plus_scaled(m, chord_n_mm, 0.5f), 0.5f);
    const sym3_t r = held->resists, chord = chord_resists(part->chord_mm, chord_f);

    /* Among the part's own turns, and between them and all before. */
    sym3_t own = own_turns_resist(r, curl_y, curl_z);
    own = sym3_plus_scaled(own, chord, 0.25f);
    own.yy = brace_fma(-part->third_z_rad, half_m.z, brace_fma(link->twelfth_mm * share, f.x, own.yy));
    own.yz = brace_fma(0.5f, brace_fma(part->third_y_rad, half_m.z, part->third_z_rad * half_m.y), own.yz);
    own.zz = brace_fma(-part->third_y_rad, half_m.y, own.zz);
    own.zz = brace_fma(part->bend_twice_mm.x, f.x, brace_fma(part->bend_twice_mm.z, f.y, own.zz));
    const sym3_t q = sym3_plus_scaled(r, chord, 0.5f);
    const vec3_t x = vec3(q.xx, q.xy + half_m.z, q.xz - half_m.y);
    vec3_t y = vec3(q.xy - half_m.z, brace_fma(by_sideways, f.z, q.yy), brace_fma(-by_sideways, f.y, q.yz + half_m.x));
    vec3_t z = vec3(brace_fma(-by_bend.z, f.z, q.xz + half_m.y), brace_fma(by_bend.x, f.z, q.yz - half_m.x),
                    brace_fma(-by_bend.x, f.y, brace_fma(by_bend.z, f.x, q.zz)));
    y = vec3_plus_scaled(y, x, -curl_y);
    z = vec3_plus_scaled(z, x, -curl_z);
    held->resists = sym3_plus_scaled(r, chord, 1.0f);
    held->moment_n_mm = vec3_plus(m, chord_n_mm);

    /* What moves the part's end across, in parts of its length. */
    const vec3_t bent_across = vec3_scaled(vec3_cross(f, in_plane(link->across)), length_mm);
    const vec3_t bent_sideways = vec3(length_mm * f.y, -length_mm * f.x, 0.0f);
    const float across_yields = per_part * link->bend_rad_per_n_mm;
    const float sideways_yields = per_part * link->sideways_rad_per_n_mm;
    const float across_y = brace_fma(0.5f, bent_across.y, m.x), across_z = 0.5f * bent_across.z;
    const float sideways_y = 0.5f * bent_sideways.y, sideways_z = m.x;
    const float y_by_across = -across_yields * across_y, z_by_across = -across_yields * across_z;
    const float y_by_sideways = -sideways_yields * sideways_y, z_by_sideways = -sideways_yields * sideways_z;
    own.yy = brace_fma(y_by_across, across_y, brace_fma(y_by_sideways, sideways_y, own.yy));
    own.yz = brace_fma(y_by_across, across_z, brace_fma(y_by_sideways, sideways_z, own.yz));
    own.zz = brace_fma(z_by_across, across_z, brace_fma(z_by_sideways, sideways_z, own.zz));
    y = vec3_plus_scaled(vec3_plus_scaled(y, bent_across, y_by_across), bent_sideways, y_by_sideways);
    z = vec3_plus_scaled(vec3_plus_scaled(z, bent_across, z_by_across), bent_sideways, z_by_sideways);
    soften(held, bent_across, across_yields);
    soften(held, bent_sideways, sideways_yields);

    const float twists = 0.5f - link->stretch_end_share;
    const float x_yields = eliminate(held, x, own.xx, twists * share * link->twist_rad_per_n_mm, pivots).yields;
    const float y_by_x = -(x_yields * own.xy), z_by_x = -(x_yields * own.xz);
    own.yy = brace_fma(y_by_x, own.xy, own.yy);
    own.yz = brace_fma(y_by_x, own.xz, own.yz);
    own.zz = brace_fma(z_by_x, own.xz, own.zz);
    y = vec3_plus_scaled(y, x, y_by_x);
    z = vec3_plus_scaled(z, x, z_by_x);
    const float y_yields = eliminate(held, y, own.yy, share * link->sideways_rad_per_n_mm, pivots).yields;
    const float z_by_y = -(y_yields * own.yz);
    (void)eliminate(held, vec3_plus_scaled(z, y, z_by_y), brace_fma(z_by_y, own.yz, own.zz),
                    share * link->bend_rad_per_n_mm, pivots);
    held_about_y(held, part->about_y);
}

/* Adds link i and the joint before it, with each force taken `times` times, at the shape that the limb has under its
 * load. */
INLINE void hold_link(const brace_loaded_space_t *loaded, const brace_space_shape_t *shape, int i, float times,
                      held_t *held, pivots_t *pivots)
{
    const brace_space_link_t *const links[BRACE_LINK_COUNT] = {&loaded->coxa, &loaded->femur, &loaded->tibia};
    const int from = first_part[i], parts = first_part[i + 1] - from;
    const float share = 1.0f / (float)parts;
    hold_end(links[i], vec3_scaled(shape->end_n[i], times), shape->end_mm[i], held, pivots);
    for (int k = from + parts - 1; k >= from; k--) {
        hold_part(links[i], &shape->part[k], share, times, held, pivots);
    }
    if (i > 0) {
        (void)eliminate_joint(held, shape->joint_rad_per_n_mm[i], pivots);
    }
    held_about_z(held, shape->about_joint[i]);
}

/* Adds the coxa joint and the base. */
INLINE void hold_base(const brace_loaded_space_t *loaded, const brace_space_shape_t *shape, float times, held_t *held,
                      pivots_t *pivots)
{
    (void)eliminate(held, row_of_y(held), held->resists.yy, shape->joint_rad_per_n_mm[BRACE_COXA], pivots);
    held_about_y(held, shape->yaw);
    const float base_x_n = times * about_z(shape->whole_n, back(shape->base)).x;
    const float entry = brace_fma(-loaded->coxa.length_mm, base_x_n, held->resists.zz);
    (void)eliminate(held, held->moment_n_mm, entry, loaded->base_rotation_rad_per_n_mm, pivots);
}

#endif
