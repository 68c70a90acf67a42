/* On the way to the equilibrium in space, in fixed point: loaded/space_straight.h in integers. */
#ifndef BRACE_CORE_FIXED_SPACE_STRAIGHT_H
#define BRACE_CORE_FIXED_SPACE_STRAIGHT_H

#include "fixed_space/held.h"

/* The joints' commanded directions, each seen from the link before. */
typedef struct {
    fixed_vec_t hip, knee;
} fixed_commanded_t;

/* How the joints yield, and how far a collapsed limb's words are shifted. */
typedef struct {
    int32_t base_q26, yaw_q26, hip_q26, knee_q26;
    uint32_t turn_shift;
} fixed_yields_t;

/* The force that a link's end carries, and the link's own weight, in the link's frame. */
typedef struct {
    fixed3_t beyond_q30, own_q30;
} fixed_forces_t;

/* An eliminated coordinate: its row, its compliance with the load included, and one over its pivot. */
typedef struct {
    fixed3_t row_q24;
    int32_t yields_q26, per_pivot_q27;
} fixed_factor_t;

/* The turns of a link about y and z, in this order; between: the matrix's entry for both. */
typedef struct {
    fixed_factor_t y, z;
    int32_t between_q24, twist_q26;
} fixed_link_factor_t;

typedef struct {
    fixed_link_factor_t coxa, femur, tibia;
    fixed_factor_t yaw, hip, knee;
    int32_t base_yields_q26, base_per_pivot_q27;
} fixed_factors_t;

INLINE fixed_factor_t fixed_eliminated(fixed_sym3_t *resists_q24, fixed3_t row_q24, int32_t entry_q24,
                                       int32_t yields_q26, noted_t *noted)
{
    const int32_t per_pivot = inverse_q27(pivot_of(yields_q26, entry_q24, noted));
    const int32_t yields = softened_of(yields_q26, per_pivot, noted);
    note_row(row_q24, RANGES, noted);
    fixed_sym3_add(resists_q24, row_q24, follow_row(row_q24, yields, RANGES, noted), RANGES, noted);
    return (fixed_factor_t){row_q24, yields, per_pivot};
}

/* drives (q27): on the link's own turns. */
INLINE void fixed_straight_link(const brace_space_fixed_link_t *link, const fixed_yields_t *yields, fixed_forces_t at,
                                fixed_held_t *held, fixed_link_factor_t *factor, fixed3_t *drives, noted_t *noted)
{
    const fixed3_t f = fixed3_plus(at.beyond_q30, fixed3_halved(at.own_q30, 1)), m = held->moment_q27;
    const fixed3_t whole = fixed3(coarse_times(f.x, link->length_q28, 31), coarse_times(f.y, link->length_q28, 31),
                                  coarse_times(f.z, link->length_q28, 31));
    const fixed_sym3_t r = held->resists_q24;
    const int32_t whole_x = whole.x >> 3, half_x = whole.x >> 4, half_y = whole.y >> 4, half_z = whole.z >> 4;
    const int32_t third = coarse_times(whole_x, Q31(1.0 / 3.0), 31);
    const int32_t bend = coarse(sum3(link->tilt_q28.x, at.beyond_q30.x, link->tilt_q28.z, at.beyond_q30.y,
                                     minus(link->twelfth_q28), at.own_q30.y), 31);
    *drives = fixed3(m.x, plus(less(m.y, whole.z >> 1), coarse_times(link->twelfth_q28, at.own_q30.z, 31)),
                     plus(plus(m.z, whole.y >> 1), bend));
    held->moment_q27 = fixed3(m.x, less(m.y, whole.z), plus(m.z, whole.y));
    held->resists_q24 = (fixed_sym3_t){r.xx, less(r.xy, half_y), less(r.xz, half_z), plus(r.yy, whole_x), r.yz,
                                       plus(r.zz, whole_x)};
    factor->twist_q26 = link->twist_q31 >> yields->turn_shift;
    factor->between_q24 = r.yz;
    factor->y = fixed_eliminated(&held->resists_q24, fixed3(less(r.xy, half_y), plus(r.yy, half_x), r.yz),
                                 plus(r.yy, third), link->sideways_q31 >> yields->turn_shift, noted);
    const int32_t by = follow(r.yz, factor->y.yields_q26, RANGES, noted);
    const fixed3_t row = fixed3_plus_q29(fixed3(less(r.xz, half_z), r.yz, plus(r.zz, half_x)), factor->y.row_q24, by);
    factor->z = fixed_eliminated(&held->resists_q24, row, plus(plus(r.zz, third), by_q29(r.yz, by)),
                                 link->bend_q31 >> yields->turn_shift, noted);
}

INLINE fixed_factor_t fixed_straight_joint(fixed_held_t *held, int32_t yields_q26, noted_t *noted)
{
    const fixed_sym3_t r = held->resists_q24;
    return fixed_eliminated(&held->resists_q24, fixed3(r.xz, r.yz, r.zz), r.zz, yields_q26, noted);
}

/* at: coxa, femur, tibia. */
INLINE void fixed_straight_limb(const brace_loaded_space_fixed_t *limb, const fixed_forces_t at[3],
                                const fixed_commanded_t *commanded, const fixed_yields_t *yields, fixed3_t whole_q30,
                                fixed_factors_t *factors, brace_space_fixed_pose_t *drives, noted_t *noted)
{
    fixed_held_t held = {{0, 0, 0, 0, 0, 0}, {0, 0, 0}};
    fixed_straight_link(&limb->tibia, yields, at[2], &held, &factors->tibia, &drives->tibia, noted);
    drives->knee = held.moment_q27.z;
    factors->knee = fixed_straight_joint(&held, yields->knee_q26, noted);
    fixed_held_about_z(&held, commanded->knee);
    fixed_straight_link(&limb->femur, yields, at[1], &held, &factors->femur, &drives->femur, noted);
    drives->hip = held.moment_q27.z;
    factors->hip = fixed_straight_joint(&held, yields->hip_q26, noted);
    fixed_held_about_z(&held, commanded->hip);
    fixed_straight_link(&limb->coxa, yields, at[0], &held, &factors->coxa, &drives->coxa, noted);
    drives->yaw = held.moment_q27.y;
    const fixed_sym3_t r = held.resists_q24;
    factors->yaw = fixed_eliminated(&held.resists_q24, fixed3(r.xy, r.yy, r.yz), r.yy, yields->yaw_q26, noted);
    const int32_t coxa = limb->coxa.length_q28;
    drives->base = less(held.moment_q27.z, coarse_times(coxa, whole_q30.y, 31));
    const int32_t entry = less(held.resists_q24.zz, high_of(coxa, whole_q30.x) >> 2);
    factors->base_per_pivot_q27 = inverse_q27(pivot_of(yields->base_q26, entry, noted));
    factors->base_yields_q26 = softened_of(yields->base_q26, factors->base_per_pivot_q27, noted);
}

/* --- solving with it ------------------------------------------------------------------------------------------ */

#define TURN_MOST_BITS 29 /* 1 rad */

/* How far a coordinate goes if all before it stays, from where it is now. driven: q24 */
INLINE int32_t fixed_alone(int32_t yields_q26, int32_t per_pivot_q27, int32_t driven_q24, int32_t now,
                           noted_t *noted)
{
    const int64_t back = (int64_t)per_pivot_q27 * now;
    note(noted, brace_high_word(back), 25);
    return less(angle_of(yields_q26, driven_q24, noted), shifted(back, 27));
}

/* drives (q24): also what this leaves for the coordinates before. */
INLINE int32_t fixed_inwards(const fixed_factor_t *factor, int32_t driven_q24, int32_t now, fixed3_t *drives,
                             noted_t *noted)
{
    const int32_t by = fixed_alone(factor->yields_q26, factor->per_pivot_q27, driven_q24, now, noted);
    note(noted, by, TURN_MOST_BITS);
    const fixed3_t row = factor->row_q24;
    *drives = fixed3(less(drives->x, times(row.x, by, 29)), less(drives->y, times(row.y, by, 29)),
                     less(drives->z, times(row.z, by, 29)));
    return by;
}

INLINE fixed3_t fixed_link_inwards(const fixed_link_factor_t *factor, fixed3_t driven_q27, fixed3_t now,
                                   fixed3_t *drives, noted_t *noted)
{
    const fixed3_t beyond = *drives;
    const int32_t x = less(angle_of(factor->twist_q26, plus(driven_q27.x >> 3, beyond.x), noted), now.x);
    const int32_t y = fixed_inwards(&factor->y, plus(driven_q27.y >> 3, beyond.y), now.y, drives, noted);
    const int32_t left = less(plus(driven_q27.z >> 3, beyond.z), times(factor->between_q24, y, 29));
    const int32_t z = fixed_inwards(&factor->z, left, now.z, drives, noted);
    return fixed3(x, y, z);
}

/* On the way to the tip: turned by all before it. */
INLINE int32_t fixed_outwards(const fixed_factor_t *factor, int32_t alone, fixed3_t turned, noted_t *noted)
{
    const int32_t row = shifted(fixed3_dot(factor->row_q24, turned), 29);
    const int32_t by = less(alone, angle_of(factor->yields_q26, row, noted));
    note(noted, by, TURN_MOST_BITS);
    return by;
}

INLINE fixed3_t fixed_link_outwards(const fixed_link_factor_t *factor, fixed3_t alone, fixed3_t turned, noted_t *noted)
{
    const int32_t z = fixed_outwards(&factor->z, alone.z, turned, noted);
    const int32_t by_z = times(factor->between_q24, z, 29);
    const int32_t y = less(fixed_outwards(&factor->y, alone.y, turned, noted),
                           angle_of(factor->y.yields_q26, by_z, noted));
    note(noted, alone.x, TURN_MOST_BITS);
    note(noted, y, TURN_MOST_BITS);
    return fixed3(alone.x, y, z);
}

INLINE void note_turned(fixed3_t turned, noted_t *noted)
{
    note(noted, turned.x, TURN_MOST_BITS);
    note(noted, turned.y, TURN_MOST_BITS);
    note(noted, turned.z, TURN_MOST_BITS);
}

/* by: how far each coordinate has to go from `now` under these drives (q27); none beyond 1 rad. */
static void fixed_solve_straight(const fixed_factors_t *factors, const brace_space_fixed_pose_t *drives,
                                 const brace_space_fixed_pose_t *now, const fixed_commanded_t *commanded,
                                 brace_space_fixed_pose_t *by, noted_t *noted)
{
    fixed3_t d = {0, 0, 0};
    const fixed3_t tibia = fixed_link_inwards(&factors->tibia, drives->tibia, now->tibia, &d, noted);
    const int32_t knee = fixed_inwards(&factors->knee, plus(drives->knee >> 3, d.z), now->knee, &d, noted);
    d = fixed_about_z(d, commanded->knee);
    const fixed3_t femur = fixed_link_inwards(&factors->femur, drives->femur, now->femur, &d, noted);
    const int32_t hip = fixed_inwards(&factors->hip, plus(drives->hip >> 3, d.z), now->hip, &d, noted);
    d = fixed_about_z(d, commanded->hip);
    const fixed3_t coxa = fixed_link_inwards(&factors->coxa, drives->coxa, now->coxa, &d, noted);
    const int32_t yaw = fixed_inwards(&factors->yaw, plus(drives->yaw >> 3, d.y), now->yaw, &d, noted);

    by->base = fixed_alone(factors->base_yields_q26, factors->base_per_pivot_q27, plus(drives->base >> 3, d.z),
                           now->base, noted);
    note(noted, by->base, TURN_MOST_BITS);
    fixed3_t turned = {0, 0, by->base};
    by->yaw = fixed_outwards(&factors->yaw, yaw, turned, noted);
    turned.y = plus(turned.y, by->yaw);
    by->coxa = fixed_link_outwards(&factors->coxa, coxa, turned, noted);
    turned = fixed_about_z(fixed3_plus(turned, by->coxa), fixed_back(commanded->hip));
    note_turned(turned, noted);
    by->hip = fixed_outwards(&factors->hip, hip, turned, noted);
    turned.z = plus(turned.z, by->hip);
    by->femur = fixed_link_outwards(&factors->femur, femur, turned, noted);
    turned = fixed_about_z(fixed3_plus(turned, by->femur), fixed_back(commanded->knee));
    note_turned(turned, noted);
    by->knee = fixed_outwards(&factors->knee, knee, turned, noted);
    turned.z = plus(turned.z, by->knee);
    by->tibia = fixed_link_outwards(&factors->tibia, tibia, turned, noted);
}

#endif
