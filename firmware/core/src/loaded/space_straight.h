/* On the way to the equilibrium in space: the limb's equations with straight links.
 *
 * Their matrix is eliminated from the tip to the base: first at the commanded angles, and where two steps are not
 * enough, at the angles and under the forces that the steps have come to. A step solves with it for what the bent limb
 * is still driven by. It may be rough, because it decides only how fast the steps approach the equilibrium: twists
 * stand alone in it, and turns out of the plane are left out.
 */
#ifndef BRACE_CORE_SPACE_STRAIGHT_H
#define BRACE_CORE_SPACE_STRAIGHT_H

#include "brace/loaded_space_types.h"
#include "loaded/space_frame.h"

/* The joints' directions, each seen from the link before. */
typedef struct {
    brace_vec_t hip, knee;
} commanded_t;

/* The force that a link's end carries, and the link's own weight, in the link's frame. */
typedef struct {
    vec3_t beyond_n, own_n;
} forces_t;

typedef brace_space_joint_factor_t joint_factor_t;
typedef brace_space_link_factor_t link_factor_t;
typedef brace_space_factors_t factors_t;
typedef brace_space_held_t held_t;

/* A smaller pivot counts as this one, as in loaded/solve.h. */
#define PIVOT_LEAST_ON_THE_WAY 0.25f

INLINE float pivot_on_the_way(float pivot)
{
    return pivot < PIVOT_LEAST_ON_THE_WAY ? PIVOT_LEAST_ON_THE_WAY : pivot;
}

INLINE joint_factor_t eliminated(sym3_t *resists, vec3_t row, float entry, float rad_per_n_mm)
{
    const float per_pivot = 1.0f / pivot_on_the_way(brace_fma(rad_per_n_mm, entry, 1.0f));
    const float yields = rad_per_n_mm * per_pivot;
    sym3_add(resists, row, vec3_scaled(row, -yields));
    return (joint_factor_t){row, yields, per_pivot};
}

/* drives: on the link's own turns. */
INLINE void straight_link(const brace_space_link_t *link, forces_t at, held_t *held, link_factor_t *factor,
                          vec3_t *drives)
{
    const vec3_t f = vec3_plus_scaled(at.beyond_n, at.own_n, 0.5f), m = held->moment_n_mm;
    const vec3_t whole = vec3_scaled(f, link->length_mm), half = vec3_scaled(whole, 0.5f);
    const sym3_t r = held->resists;
    const float third = whole.x * (1.0f / 3.0f),
                by_bend = brace_fma(link->tilt_mm.x, at.beyond_n.x, link->tilt_mm.z * at.beyond_n.y);
    *drives = vec3(m.x, brace_fma(link->twelfth_mm, at.own_n.z, m.y - half.z),
                   brace_fma(-link->twelfth_mm, at.own_n.y, m.z + half.y) + by_bend);
    held->moment_n_mm = vec3(m.x, m.y - whole.z, m.z + whole.y);
    held->resists = (sym3_t){r.xx, r.xy - half.y, r.xz - half.z, r.yy + whole.x, r.yz, r.zz + whole.x};
    factor->twist_rad_per_n_mm = link->twist_rad_per_n_mm;
    factor->between = r.yz;
    factor->y =
        eliminated(&held->resists, vec3(r.xy - half.y, r.yy + half.x, r.yz), r.yy + third, link->sideways_rad_per_n_mm);
    const float by = factor->y.yields * r.yz;
    const vec3_t row = vec3_plus_scaled(vec3(r.xz - half.z, r.yz, r.zz + half.x), factor->y.row, -by);
    factor->z = eliminated(&held->resists, row, brace_fma(-by, r.yz, r.zz + third), link->bend_rad_per_n_mm);
}

INLINE joint_factor_t straight_joint(held_t *held, float rad_per_n_mm)
{
    const sym3_t r = held->resists;
    return eliminated(&held->resists, vec3(r.xz, r.yz, r.zz), r.zz, rad_per_n_mm);
}

INLINE void held_about_z(held_t *held, brace_vec_t turn)
{
    sym3_about_z(&held->resists, turn);
    held->moment_n_mm = about_z(held->moment_n_mm, turn);
}

/* at: coxa, femur, tibia. rest: its joints, and the force on the base. */
INLINE void straight_limb(const brace_loaded_space_t *loaded, const forces_t at[3], const commanded_t *commanded,
                          const brace_space_rest_t *rest, factors_t *factors, brace_space_pose_t *drives)
{
    held_t held = {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    straight_link(&loaded->tibia, at[2], &held, &factors->tibia, &drives->tibia);
    drives->knee = held.moment_n_mm.z;
    factors->knee = straight_joint(&held, rest->knee.yields_by_rad_per_n_mm);
    held_about_z(&held, commanded->knee);
    straight_link(&loaded->femur, at[1], &held, &factors->femur, &drives->femur);
    drives->hip = held.moment_n_mm.z;
    factors->hip = straight_joint(&held, rest->hip.yields_by_rad_per_n_mm);
    held_about_z(&held, commanded->hip);
    straight_link(&loaded->coxa, at[0], &held, &factors->coxa, &drives->coxa);
    drives->yaw = held.moment_n_mm.y;
    const sym3_t r = held.resists;
    factors->yaw = eliminated(&held.resists, vec3(r.xy, r.yy, r.yz), r.yy, rest->yaw.yields_by_rad_per_n_mm);
    const float coxa_mm = loaded->coxa.length_mm, base = loaded->base_rotation_rad_per_n_mm;
    drives->base = brace_fma(-coxa_mm, rest->whole_n.y, held.moment_n_mm.z);
    const float base_pivot = brace_fma(base, brace_fma(-coxa_mm, rest->whole_n.x, held.resists.zz), 1.0f);
    factors->base_per_pivot = 1.0f / pivot_on_the_way(base_pivot);
    factors->base_yields = base * factors->base_per_pivot;
}

/* --- solving with it ------------------------------------------------------------------------------------------ */

/* On the way to the base: how far a coordinate goes if all before it stays. drives: also what this leaves for those. */
INLINE float inwards(const joint_factor_t *factor, float driven, float now, vec3_t *drives)
{
    const float by = brace_fma(factor->yields, driven, -(factor->per_pivot * now));
    *drives = vec3_plus_scaled(*drives, factor->row, -by);
    return by;
}

INLINE vec3_t link_inwards(const link_factor_t *factor, vec3_t driven, vec3_t now, vec3_t *drives)
{
    const vec3_t beyond = *drives;
    const float x = brace_fma(factor->twist_rad_per_n_mm, driven.x, -now.x);
    const float y = inwards(&factor->y, driven.y + beyond.y, now.y, drives);
    const float z = inwards(&factor->z, brace_fma(-factor->between, y, driven.z + beyond.z), now.z, drives);
    return vec3(x, y, z);
}

/* On the way to the tip: turned by all before it. */
INLINE float outwards(const joint_factor_t *factor, float alone, vec3_t turned)
{
    return brace_fma(-factor->yields, vec3_dot(factor->row, turned), alone);
}

INLINE vec3_t link_outwards(const link_factor_t *factor, vec3_t alone, vec3_t turned)
{
    const float z = outwards(&factor->z, alone.z, turned);
    return vec3(alone.x, brace_fma(-(factor->y.yields * factor->between), z, outwards(&factor->y, alone.y, turned)), z);
}

/* by: how far each coordinate has to go from `now` under these drives. */
static void solve_straight(const factors_t *factors, const brace_space_pose_t *drives, const brace_space_pose_t *now,
                           const commanded_t *commanded, brace_space_pose_t *by)
{
    vec3_t d = {0.0f, 0.0f, 0.0f};
    const vec3_t tibia = link_inwards(&factors->tibia, drives->tibia, now->tibia, &d);
    const float knee = inwards(&factors->knee, drives->knee + d.z, now->knee, &d);
    d = about_z(d, commanded->knee);
    const vec3_t femur = link_inwards(&factors->femur, drives->femur, now->femur, &d);
    const float hip = inwards(&factors->hip, drives->hip + d.z, now->hip, &d);
    d = about_z(d, commanded->hip);
    const vec3_t coxa = link_inwards(&factors->coxa, drives->coxa, now->coxa, &d);
    const float yaw = inwards(&factors->yaw, drives->yaw + d.y, now->yaw, &d);

    by->base = brace_fma(factors->base_yields, drives->base + d.z, -(factors->base_per_pivot * now->base));
    vec3_t turned = {0.0f, 0.0f, by->base};
    by->yaw = outwards(&factors->yaw, yaw, turned);
    turned.y += by->yaw;
    by->coxa = link_outwards(&factors->coxa, coxa, turned);
    turned = about_z(vec3_plus(turned, by->coxa), back(commanded->hip));
    by->hip = outwards(&factors->hip, hip, turned);
    turned.z += by->hip;
    by->femur = link_outwards(&factors->femur, femur, turned);
    turned = about_z(vec3_plus(turned, by->femur), back(commanded->knee));
    by->knee = outwards(&factors->knee, knee, turned);
    turned.z += by->knee;
    by->tibia = link_outwards(&factors->tibia, tibia, turned);
}

#endif
