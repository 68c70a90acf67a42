/* A bent limb in space, in fixed point: loaded/space_bent.h in integers. */
#ifndef BRACE_CORE_FIXED_SPACE_BENT_H
#define BRACE_CORE_FIXED_SPACE_BENT_H

#include "fixed_space/straight.h"

/* Twists of coxa and femur that bending and springs together make. */
typedef struct {
    int32_t coxa, femur;
} fixed_curls_t;

INLINE fixed_vec_t fixed_joint_turn(uint32_t commanded_turn, int32_t more)
{
    return fixed_direction(commanded_turn + brace_turn_from_q28(more >> 1));
}

/* How far a joint's links and the joint itself turn what lies beyond. */
INLINE int32_t turned_at_joint(fixed3_t before, int32_t joint, fixed3_t after)
{
    return plus(plus(before.z >> 1, after.z >> 1), joint);
}

/* A link's twist about itself, its curl included; at most 1 rad. */
INLINE fixed_vec_t fixed_twist_of(int32_t turn, int32_t curl, noted_t *noted)
{
    const int32_t twist = plus(turn, curl);
    note(noted, twist, TURN_MOST_BITS);
    return fixed_small_turn_of(twist);
}

static void fixed_turns_of(const fixed_rest3_t *rest, fixed_curls_t curls, fixed_turns3_t *turns, noted_t *noted)
{
    const brace_space_fixed_pose_t *pose = &rest->pose;
    turns->base = fixed_small_turn_of(pose->base);
    turns->yaw = fixed_small_turn_of(pose->yaw);
    turns->coxa_z = fixed_small_turn_of(pose->coxa.z >> 1);
    turns->coxa_y = fixed_small_turn_of(pose->coxa.y >> 1);
    turns->coxa_x = fixed_twist_of(pose->coxa.x, curls.coxa, noted);
    turns->hip = fixed_joint_turn(rest->theta1_turn, turned_at_joint(pose->coxa, pose->hip, pose->femur));
    turns->femur_y = fixed_small_turn_of(pose->femur.y >> 1);
    turns->femur_x = fixed_twist_of(pose->femur.x, curls.femur, noted);
    turns->knee = fixed_joint_turn(0u - rest->theta2_turn, turned_at_joint(pose->femur, pose->knee, pose->tibia));
    turns->tibia_y = fixed_small_turn_of(pose->tibia.y >> 1);
}

/* --- frames --------------------------------------------------------------------------------------------------- */

/* A link's axes, seen from the limb's plane. */
typedef struct {
    fixed_axes_t coxa, femur, tibia;
} fixed_frames_t;

static void fixed_frames_of(const fixed_turns3_t *turns, fixed_frames_t *frames)
{
    fixed_axes_t axes = {{turns->base.x, turns->base.z, 0}, {minus(turns->base.z), turns->base.x, 0}, {0, 0, 1 << 30}};
    fixed_axes_about_y(&axes, fixed_back(turns->yaw));
    fixed_axes_about_z(&axes, fixed_back(turns->coxa_z));
    fixed_axes_about_y(&axes, fixed_back(turns->coxa_y));
    frames->coxa = axes;
    fixed_axes_about_x(&axes, fixed_back(turns->coxa_x));
    fixed_axes_about_y(&axes, fixed_back(turns->coxa_y));
    fixed_axes_about_z(&axes, fixed_back(turns->hip));
    fixed_axes_about_y(&axes, fixed_back(turns->femur_y));
    frames->femur = axes;
    fixed_axes_about_x(&axes, fixed_back(turns->femur_x));
    fixed_axes_about_y(&axes, fixed_back(turns->femur_y));
    fixed_axes_about_z(&axes, fixed_back(turns->knee));
    fixed_axes_about_y(&axes, fixed_back(turns->tibia_y));
    frames->tibia = axes;
}

/* A vector of the limb's plane's frame as each link sees it. */
typedef struct {
    fixed3_t coxa, femur, tibia;
} fixed_seen_t;

INLINE fixed_seen_t fixed_seen(const fixed_turns3_t *turns, fixed3_t v)
{
    fixed_seen_t by;
    v = fixed_about_y(fixed_about_z(v, fixed_back(turns->base)), fixed_back(turns->yaw));
    by.coxa = fixed_about_y(fixed_about_z(v, fixed_back(turns->coxa_z)), fixed_back(turns->coxa_y));
    v = fixed_about_y(fixed_about_x(by.coxa, fixed_back(turns->coxa_x)), fixed_back(turns->coxa_y));
    by.femur = fixed_about_y(fixed_about_z(v, fixed_back(turns->hip)), fixed_back(turns->femur_y));
    v = fixed_about_y(fixed_about_x(by.femur, fixed_back(turns->femur_x)), fixed_back(turns->femur_y));
    by.tibia = fixed_about_y(fixed_about_z(v, fixed_back(turns->knee)), fixed_back(turns->tibia_y));
    return by;
}

/* Weights of the limb's parts, in this load's unit of force. */
typedef struct {
    int32_t beyond_coxa_q30, beyond_femur_q30, femur_q30, tibia_q30;
} fixed_weights_t;

static void fixed_see_forces(const fixed_weights_t *weights, fixed3_t tip_q30, fixed3_t down_q30, fixed_rest3_t *rest)
{
    const fixed_seen_t tip = fixed_seen(&rest->turns, tip_q30), weight = fixed_seen(&rest->turns, down_q30);
    rest->coxa.beyond_q30 = fixed3_plus_q30(tip.coxa, weight.coxa, weights->beyond_coxa_q30);
    rest->coxa.own_q30 = fixed3(0, 0, 0);
    rest->femur.beyond_q30 = fixed3_plus_q30(tip.femur, weight.femur, weights->beyond_femur_q30);
    rest->femur.own_q30 = fixed3_scaled_q30(weight.femur, weights->femur_q30);
    rest->tibia.beyond_q30 = tip.tibia;
    rest->tibia.own_q30 = fixed3_scaled_q30(weight.tibia, weights->tibia_q30);
}

/* --- a link --------------------------------------------------------------------------------------------------- */

#define SPRING_TURN_MOST_BITS 19 /* a quarter of the arm */
#define STRETCH_MOST_BITS 26     /* a quarter of the unit of length */

/* twists_q27: the moment about x of all beyond the end. */
INLINE void fixed_bend_link(const fixed_link3_t *link, const fixed_rest3_t *rest, fixed3_t turn, int32_t twists_q27,
                            fixed_bent3_t *bent, noted_t *noted)
{
    const fixed3_t f = fixed3_plus_q30(bent->beyond_q30, bent->own_q30, link->own_share_q30);
    const fixed_vec_t along = link->along_q30;
    const uint32_t arm = link->arm_shift;
    const int32_t share_y = by_q29(link->end_share_q30, turn.y), share_z = by_q29(link->end_share_q30, turn.z);
    const int32_t curled_q27 = by_q30(twists_q27, link->curl_q30);
    const fixed3_t across = fixed3(less(minus(along.z), by_q30(share_z, along.x)),
                                   less(along.x, by_q30(share_z, along.z)), by_q30(share_y, along.z));
    const int32_t across_n_q27 = less((brace_high_word(fixed3_dot(across, f)) >> 1) >> arm,
                                      by_q29(curled_q27, turn.y));
    const int32_t sideways_q30 = plus(f.z, by_q30(share_y, f.x));
    const int32_t sideways_n_q27 = less((sideways_q30 >> 3) >> arm, by_q29(curled_q27, turn.z));
    const int64_t across_turn = (int64_t)(link->across_arm_q31 >> rest->turn_shift) * across_n_q27;
    const int64_t sideways_turn = (int64_t)(link->sideways_arm_q31 >> rest->turn_shift) * sideways_n_q27;
    note(noted, brace_high_word(across_turn), SPRING_TURN_MOST_BITS);
    note(noted, brace_high_word(sideways_turn), SPRING_TURN_MOST_BITS);
    const int32_t across_turn_q29 = shifted(across_turn, 24), sideways_turn_q29 = shifted(sideways_turn, 24);
    const int32_t across_q28 = (across_turn_q29 >> 1) >> arm, sideways_q28 = (sideways_turn_q29 >> 1) >> arm;
    const int32_t stretched_q28 = brace_high_word(sum2(along.x, f.x, along.z, f.y));
    const int32_t stretch_q28 = high_of(link->stretch_q31 >> rest->spring_shift, stretched_q28) >> 1;
    note(noted, stretch_q28, STRETCH_MOST_BITS);
    const int32_t across_shortens = by_q29(link->shortens_q30, across_turn_q29);
    const int32_t sideways_shortens = by_q29(link->shortens_q30, sideways_turn_q29);
    const int32_t half_bow_q28 = minus(by_q29(link->twelfth_q28, turn.y) >> 1);
    const fixed_vec_t bows = {by_q29(link->bow_q28.x, turn.z), by_q29(link->bow_q28.z, turn.z)};
    const fixed_vec_t bow = {plus(link->tilt_q28.x, bows.x), plus(link->tilt_q28.z, bows.z)};
    const int64_t turned_x = sum2(half_bow_q28, turn.y, bow.x, turn.z);
    const int64_t moved_x = sum3(stretch_q28, along.x, less(across.x, across_shortens), across_q28,
                                 less(share_y, sideways_shortens), sideways_q28);
    bent->chord_q28 = fixed3(plus(plus(link->length_q28, coarse(turned_x, 29)), coarse(moved_x, 30)),
                             plus(by_q29(bow.z, turn.z),
                                  coarse(sum2(stretch_q28, along.z, across.y, across_q28), 30)),
                             plus(sideways_q28, by_q30(across_q28, across.z)));
    bent->across_q30 = fixed3(less(across.x, twice(across_shortens)), across.y, across.z);
    bent->sideways_x_q30 = less(share_y, twice(sideways_shortens));
    bent->by_sideways_q28 = plus(by_q30(sideways_q28, link->end_share_q30), twice(half_bow_q28));
    const int32_t shared_q28 = by_q30(across_q28, link->end_share_q30);
    bent->by_bend_q28 = (fixed_vec_t){less(plus(bow.x, bows.x), by_q30(shared_q28, along.x)),
                                      less(plus(bow.z, bows.z), by_q30(shared_q28, along.z))};
    bent->across_curl_q30 = by_q29(link->curl_q30, across_turn_q29);
    bent->sideways_curl_q30 = by_q29(link->curl_q30, sideways_turn_q29);
}

/* Moments (q27) of the link's loads about its root. */
INLINE fixed3_t fixed_chord_moment(const fixed_bent3_t *bent)
{
    return fixed3_cross(bent->chord_q28, fixed3_plus(bent->beyond_q30, fixed3_halved(bent->own_q30, 1)), 31);
}

INLINE fixed3_t fixed_drives_of(const fixed_link3_t *link, const fixed_bent3_t *bent, fixed3_t moment_q27,
                                fixed3_t chord_q27)
{
    const fixed3_t f = bent->beyond_q30, own = bent->own_q30;
    const int32_t by_y = coarse(sum2(bent->by_sideways_q28, f.x, link->twelfth_q28, own.z), 31);
    const int32_t by_z = coarse(sum3(bent->by_bend_q28.x, f.x, bent->by_bend_q28.z, f.y, minus(link->twelfth_q28),
                                     own.y), 31);
    fixed3_t drives = fixed3_plus(moment_q27, fixed3_halved(chord_q27, 1));
    drives.y = plus(less(drives.y, by_q30(moment_q27.x, bent->across_curl_q30)), by_y);
    drives.z = plus(less(drives.z, by_q30(moment_q27.x, bent->sideways_curl_q30)), by_z);
    return drives;
}

INLINE int32_t fixed_curl_of(const fixed_bent3_t *bent, fixed3_t turn)
{
    return minus(coarse(sum2(bent->across_curl_q30, turn.y, bent->sideways_curl_q30, turn.z), 30));
}

/* Bends a link, passes the moment on to its root's side, and tells what drives its turns. */
INLINE void fixed_bend_and_drive(const fixed_link3_t *link, const fixed_rest3_t *rest, fixed3_t turn,
                                 fixed_bent3_t *bent, bool is_driven, fixed3_t *moment_q27, fixed3_t *drives,
                                 noted_t *noted)
{
    fixed_bend_link(link, rest, turn, moment_q27->x, bent, noted);
    const fixed3_t chord_q27 = fixed_chord_moment(bent);
    if (is_driven) {
        *drives = fixed_drives_of(link, bent, *moment_q27, chord_q27);
    }
    *moment_q27 = fixed3_plus(*moment_q27, chord_q27);
}

/* --- the limb ------------------------------------------------------------------------------------------------- */

INLINE fixed3_t fixed_beyond_knee(fixed3_t v, const fixed_turns3_t *turns)
{
    return fixed_about_x(fixed_about_y(fixed_about_z(v, turns->knee), turns->femur_y), turns->femur_x);
}

INLINE fixed3_t fixed_beyond_hip(fixed3_t v, const fixed_turns3_t *turns)
{
    return fixed_about_x(fixed_about_y(fixed_about_z(v, turns->hip), turns->coxa_y), turns->coxa_x);
}

/* Bends the links of a rest whose turns and forces are known. drives (q27): on every coordinate. curls: not changed
 * before all is bent. */
INLINE void fixed_bend_limb(const brace_loaded_space_fixed_t *limb, fixed_rest3_t *rest, fixed_curls_t *curls,
                           bool is_driven, brace_space_fixed_pose_t *drives, noted_t *noted)
{
    const fixed_turns3_t *turns = &rest->turns;
    fixed3_t m = {0, 0, 0};
    fixed_bend_and_drive(&limb->tibia, rest, rest->pose.tibia, &rest->tibia, is_driven, &m, &drives->tibia, noted);
    m = fixed_about_y(m, turns->tibia_y);
    drives->knee = m.z;
    m = fixed_beyond_knee(m, turns);
    fixed_bend_and_drive(&limb->femur, rest, rest->pose.femur, &rest->femur, is_driven, &m, &drives->femur, noted);
    m = fixed_about_y(m, turns->femur_y);
    drives->hip = m.z;
    m = fixed_beyond_hip(m, turns);
    fixed_bend_and_drive(&limb->coxa, rest, rest->pose.coxa, &rest->coxa, is_driven, &m, &drives->coxa, noted);
    if (is_driven) {
        m = fixed_about_z(fixed_about_y(m, turns->coxa_y), turns->coxa_z);
        drives->yaw = m.y;
        m = fixed_about_y(m, turns->yaw);
        const int32_t whole_y = fixed_about_z(rest->whole_q30, fixed_back(turns->base)).y;
        drives->base = less(m.z, coarse_times(limb->coxa.length_q28, whole_y, 31));
    }
    curls->coxa = fixed_curl_of(&rest->coxa, rest->pose.coxa);
    curls->femur = fixed_curl_of(&rest->femur, rest->pose.femur);
}

#endif
