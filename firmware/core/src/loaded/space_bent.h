/* A bent limb in space: its turns, its links' chords, and what drives its coordinates.
 *
 * A link's frame stands between its root and its end: each is turned from there by half of the link's own turn, first
 * about y, then about z. The halves about z are in the joints' turns. A uniform beam that is bent evenly has its chord
 * along x there.
 */
#ifndef BRACE_CORE_SPACE_BENT_H
#define BRACE_CORE_SPACE_BENT_H

#include <stdbool.h>

#include "base/trig.h"
#include "loaded/space_straight.h"

typedef brace_space_curls_t curls_t;

/* more_rad: [-pi/2, pi/2] */
INLINE brace_vec_t joint_turn(brace_vec_t commanded, float more_rad)
{
    return vec_turned(commanded, (brace_vec_t){brace_cosine_coarse(more_rad), brace_sine(more_rad)});
}

static void turns_of(const brace_space_pose_t *pose, curls_t curls, const commanded_t *commanded,
                     brace_space_turns_t *turns)
{
    turns->base = brace_small_turn(pose->base);
    turns->yaw = brace_small_turn(pose->yaw);
    turns->coxa_z = brace_small_turn(0.5f * pose->coxa.z);
    turns->coxa_y = brace_small_turn(0.5f * pose->coxa.y);
    turns->coxa_x = brace_small_turn(pose->coxa.x + curls.coxa);
    turns->hip = joint_turn(commanded->hip, brace_fma(0.5f, pose->coxa.z + pose->femur.z, pose->hip));
    turns->femur_y = brace_small_turn(0.5f * pose->femur.y);
    turns->femur_x = brace_small_turn(pose->femur.x + curls.femur);
    turns->knee = joint_turn(commanded->knee, brace_fma(0.5f, pose->femur.z + pose->tibia.z, pose->knee));
    turns->tibia_y = brace_small_turn(0.5f * pose->tibia.y);
}

/* --- frames --------------------------------------------------------------------------------------------------- */

/* A link's axes, seen from the limb's plane. */
typedef struct {
    axes_t coxa, femur, tibia;
} frames_t;

static void frames_of(const brace_space_turns_t *turns, frames_t *frames)
{
    axes_t axes = {{turns->base.x, turns->base.z, 0.0f}, {-turns->base.z, turns->base.x, 0.0f}, {0.0f, 0.0f, 1.0f}};
    axes_about_y(&axes, back(turns->yaw));
    axes_about_z(&axes, back(turns->coxa_z));
    axes_about_y(&axes, back(turns->coxa_y));
    frames->coxa = axes;
    axes_about_x(&axes, back(turns->coxa_x));
    axes_about_y(&axes, back(turns->coxa_y));
    axes_about_z(&axes, back(turns->hip));
    axes_about_y(&axes, back(turns->femur_y));
    frames->femur = axes;
    axes_about_x(&axes, back(turns->femur_x));
    axes_about_y(&axes, back(turns->femur_y));
    axes_about_z(&axes, back(turns->knee));
    axes_about_y(&axes, back(turns->tibia_y));
    frames->tibia = axes;
}

/* A vector of the limb's plane's frame as each link sees it. */
typedef struct {
    vec3_t coxa, femur, tibia;
} seen_t;

INLINE seen_t seen(const brace_space_turns_t *turns, vec3_t v)
{
    seen_t by;
    by.coxa = about_y(about_z(about_y(about_z(v, back(turns->base)), back(turns->yaw)), back(turns->coxa_z)),
                      back(turns->coxa_y));
    v = about_z(about_y(about_x(by.coxa, back(turns->coxa_x)), back(turns->coxa_y)), back(turns->hip));
    by.femur = about_y(v, back(turns->femur_y));
    v = about_z(about_y(about_x(by.femur, back(turns->femur_x)), back(turns->femur_y)), back(turns->knee));
    by.tibia = about_y(v, back(turns->tibia_y));
    return by;
}

static void see_forces(const brace_loaded_space_t *loaded, vec3_t tip_n, vec3_t down, brace_space_rest_t *rest)
{
    const seen_t tip = seen(&rest->turns, tip_n), weight = seen(&rest->turns, down);
    rest->coxa.beyond_n = vec3_plus_scaled(tip.coxa, weight.coxa, loaded->beyond_coxa_n);
    rest->coxa.own_n = vec3(0.0f, 0.0f, 0.0f);
    rest->femur.beyond_n = vec3_plus_scaled(tip.femur, weight.femur, loaded->beyond_femur_n);
    rest->femur.own_n = vec3_scaled(weight.femur, loaded->femur.weight_n);
    rest->tibia.beyond_n = tip.tibia;
    rest->tibia.own_n = vec3_scaled(weight.tibia, loaded->tibia.weight_n);
}

/* --- a link --------------------------------------------------------------------------------------------------- */

/* How a spring at a link's end yields [mm/N]. It shortens the link by the square of its move: a force that pulls at the
 * link resists that, one that presses helps. */
INLINE float end_yields(const brace_space_link_t *link, float mm_per_n, float along_n)
{
    return mm_per_n / brace_fma(2.0f * link->shortens_per_mm * mm_per_n, along_n, 1.0f);
}

/* The end spring's part of the twist acts at the link's end, which is turned by half of the link's own turn: so much
 * its axis leans from x to y (.x) and to z (.z) of the link's frame. */
INLINE brace_vec_t twist_leans(const brace_space_link_t *link, vec3_t turn)
{
    return (brace_vec_t){link->twist_end_half * turn.z, -(link->twist_end_half * turn.y)};
}

/* The beam's own end spring twists the link and keeps its direction; the spring behind it turns with the link and
 * twists nothing. As one spring (`across`, and `sideways` likewise) they miss what moves them against one another: half
 * the pull along the link, turned with it, and the twisting moment. Per radian of the link's turn, times its length. */
typedef struct {
    float pulls_n_mm, twists_n_mm;
} apart_t;

INLINE apart_t moves_apart(const brace_space_link_t *link, const brace_space_bent_t *bent, vec3_t moment_n_mm)
{
    return (apart_t){0.5f * link->length_mm * bent->beyond_n.x, moment_n_mm.x};
}

/* A bent beam of length L whose end is moved across by d twists by -d/L for each radian that it turns about y or z with
 * d: turns in space do not commute. So the end's springs carry a part of the twisting moment.
 * twists_n_mm: the moment about x of all beyond the end. */
INLINE void bend_link(const brace_space_link_t *link, vec3_t turn, float twists_n_mm, brace_space_bent_t *bent)
{
    const vec3_t f = vec3_plus_scaled(bent->beyond_n, bent->own_n, link->own_share);
    const float share_y = link->end_share * turn.y, share_z = link->end_share * turn.z;
    const float curled_n = link->curl_per_mm * twists_n_mm;
    vec3_t across = vec3(brace_fma(-share_z, link->across.z, link->across.x),
                         brace_fma(share_z, link->across.x, link->across.z), -(share_y * link->across.x));
    const float across_n = brace_fma(-turn.y, curled_n, vec3_dot(across, f));
    const float sideways_n = brace_fma(-turn.z, curled_n, brace_fma(share_y, f.x, f.z));
    const float across_mm = end_yields(link, link->across_mm_per_n, f.x) * across_n;
    const float sideways_mm = end_yields(link, link->sideways_mm_per_n, f.x) * sideways_n;
    const float stretch = brace_fma(link->stretch_root.x, f.x, link->stretch_root.z * f.y);
    const float across_shortens = link->shortens_per_mm * across_mm;
    const float sideways_shortens = link->shortens_per_mm * sideways_mm;
    const float half_bow = -0.5f * link->twelfth_mm * turn.y;
    const brace_vec_t bow = vec_plus_scaled(link->tilt_mm, link->bow_mm, turn.z);
    const brace_vec_t twice_bow = vec_plus_scaled(bow, link->bow_mm, turn.z);
    vec3_t chord = vec3(brace_fma(half_bow, turn.y, link->length_mm), brace_fma(bow.z, turn.z, 0.0f), 0.0f);
    chord.x = brace_fma(bow.x, turn.z, brace_fma(stretch, link->stretch_root.x, chord.x));
    chord.y = brace_fma(stretch, link->stretch_root.z, chord.y);
    chord.x =
        brace_fma(across.x - across_shortens, across_mm, brace_fma(share_y - sideways_shortens, sideways_mm, chord.x));
    chord.y = brace_fma(across.y, across_mm, chord.y);
    chord.z = brace_fma(across.z, across_mm, sideways_mm);
    bent->chord_mm = chord;
    bent->across = vec3(across.x - 2.0f * across_shortens, across.y, across.z);
    bent->sideways = vec3(share_y - 2.0f * sideways_shortens, 0.0f, 1.0f);
    bent->by_sideways_mm = brace_fma(link->end_share, sideways_mm, half_bow + half_bow);
    bent->by_bend_mm = vec_plus_scaled(twice_bow, vec_quarter(link->across), link->end_share * across_mm);
    bent->across_curl = link->curl_per_mm * across_mm;
    bent->sideways_curl = link->curl_per_mm * sideways_mm;
}

INLINE vec3_t chord_moment(const brace_space_bent_t *bent)
{
    return vec3_cross(bent->chord_mm, vec3_plus_scaled(bent->beyond_n, bent->own_n, 0.5f));
}

INLINE vec3_t drives_of(const brace_space_link_t *link, vec3_t turn, const brace_space_bent_t *bent, vec3_t moment_n_mm,
                        vec3_t chord_n_mm)
{
    const vec3_t f = bent->beyond_n;
    vec3_t drives = vec3_plus_scaled(moment_n_mm, chord_n_mm, 0.5f);
    const brace_vec_t leans = twist_leans(link, turn);
    const apart_t apart = moves_apart(link, bent, moment_n_mm);
    const float across =
        link->across_spread_per_n_mm * brace_fma(turn.z, apart.pulls_n_mm, -(turn.y * apart.twists_n_mm));
    const float sideways =
        link->sideways_spread_per_n_mm * brace_fma(turn.z, apart.twists_n_mm, turn.y * apart.pulls_n_mm);
    drives.y = brace_fma(sideways, apart.pulls_n_mm, brace_fma(-across, apart.twists_n_mm, drives.y));
    drives.z = brace_fma(across, apart.pulls_n_mm, brace_fma(sideways, apart.twists_n_mm, drives.z));
    drives.x = brace_fma(link->twist_share, chord_n_mm.x, moment_n_mm.x);
    drives.x = brace_fma(leans.x, moment_n_mm.y, brace_fma(leans.z, moment_n_mm.z, drives.x));
    drives.y = brace_fma(-bent->across_curl, moment_n_mm.x, drives.y);
    drives.y = brace_fma(bent->by_sideways_mm, f.x, brace_fma(link->twelfth_mm, bent->own_n.z, drives.y));
    drives.z = brace_fma(-bent->sideways_curl, moment_n_mm.x, drives.z);
    drives.z = brace_fma(bent->by_bend_mm.x, f.x, brace_fma(-link->twelfth_mm, bent->own_n.y, drives.z));
    drives.z = brace_fma(bent->by_bend_mm.z, f.y, drives.z);
    return drives;
}

INLINE float curl_of(const brace_space_bent_t *bent, vec3_t turn)
{
    return -brace_fma(bent->across_curl, turn.y, bent->sideways_curl * turn.z);
}

/* Bends a link, passes the moment on to its root's side, and tells what drives its turns. */
INLINE void bend_and_drive(const brace_space_link_t *link, vec3_t turn, brace_space_bent_t *bent, bool is_driven,
                           vec3_t *moment_n_mm, vec3_t *drives)
{
    bend_link(link, turn, moment_n_mm->x, bent);
    const vec3_t chord_n_mm = chord_moment(bent);
    if (is_driven) {
        *drives = drives_of(link, turn, bent, *moment_n_mm, chord_n_mm);
    }
    *moment_n_mm = vec3_plus(*moment_n_mm, chord_n_mm);
}

/* --- the limb ------------------------------------------------------------------------------------------------- */

INLINE vec3_t beyond_knee(vec3_t v, const brace_space_turns_t *turns)
{
    return about_x(about_y(about_z(v, turns->knee), turns->femur_y), turns->femur_x);
}

INLINE vec3_t beyond_hip(vec3_t v, const brace_space_turns_t *turns)
{
    return about_x(about_y(about_z(v, turns->hip), turns->coxa_y), turns->coxa_x);
}

/* Bends the links of a rest whose turns and forces are known. drives: on every coordinate. curls: not changed before
 * all is bent. */
INLINE void bend_limb(const brace_loaded_space_t *loaded, brace_space_rest_t *rest, curls_t *curls, bool is_driven,
                      brace_space_pose_t *drives)
{
    const brace_space_turns_t *turns = &rest->turns;
    vec3_t m = {0.0f, 0.0f, 0.0f};
    bend_and_drive(&loaded->tibia, rest->pose.tibia, &rest->tibia, is_driven, &m, &drives->tibia);
    m = about_y(m, turns->tibia_y);
    drives->knee = m.z;
    m = beyond_knee(m, turns);
    bend_and_drive(&loaded->femur, rest->pose.femur, &rest->femur, is_driven, &m, &drives->femur);
    m = about_y(m, turns->femur_y);
    drives->hip = m.z;
    m = beyond_hip(m, turns);
    bend_and_drive(&loaded->coxa, rest->pose.coxa, &rest->coxa, is_driven, &m, &drives->coxa);
    m = about_z(about_y(m, turns->coxa_y), turns->coxa_z);
    drives->yaw = m.y;
    m = about_y(m, turns->yaw);
    drives->base = brace_fma(-loaded->coxa.length_mm, about_z(rest->whole_n, back(turns->base)).y, m.z);
    *curls = (curls_t){curl_of(&rest->coxa, rest->pose.coxa), curl_of(&rest->femur, rest->pose.femur)};
}

#endif
