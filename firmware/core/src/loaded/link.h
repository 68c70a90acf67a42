/* One link of a loaded limb: what it tells of itself at a shape.
 *
 * Everything here is seen from the commanded direction of the femur. Each part of a link that turns has a lever r and a
 * force F. It drives its turn by r x F, and resists it by r . F. A spring of compliance v v' moves its end by
 * v (v . F). Its turn changes that movement: it drives by -p q and resists by p^2 - q^2, where p = v . F, q = v . F',
 * and F' is F turned by a quarter.
 */
#ifndef BRACE_CORE_LOADED_LINK_H
#define BRACE_CORE_LOADED_LINK_H

#include "base/fma.h"
#include "base/inline.h"
#include "base/trig.h"
#include "base/vec.h"
#include "brace/loaded_types.h"

typedef brace_loaded_shape_t shape_t;
typedef brace_loaded_seen_t link_t;

/* A symmetric matrix of a link's coordinates. */
typedef struct {
    float rr, ra, rb, aa, ab, bb;
} matrix_t;

/* A point at which a beam's shape is summed: its share of the beam, the share of the beam beyond it, and how far each
 * curvature has turned the link there, 2 int_0^x (s - xb)/(xa - xb) ds for a. Gauss' points and shares. */
typedef struct {
    float share, beyond, a, b;
} point_t;

INLINE float end_turn(const shape_t *shape)
{
    return shape->root + shape->a + shape->b;
}

/* Up to half a turn to either side; beyond it no direction, and no shape that is_bent_within() of loaded.c takes. */
INLINE brace_vec_t turn_by(float angle_rad)
{
    const float cosine = brace_cosine_coarse(0.5f * angle_rad), sine = brace_sine(0.5f * angle_rad);
    return (brace_vec_t){brace_fma(-2.0f * sine, sine, 1.0f), 2.0f * sine * cosine};
}

INLINE float turn_at(const shape_t *shape, const point_t *point)
{
    return brace_fma(point->b, shape->b, brace_fma(point->a, shape->a, shape->root));
}

/* The turn at a point of the beam from that at the point before it. */
INLINE brace_vec_t turned_on(brace_vec_t turn, const shape_t *shape, float a, float b)
{
    return vec_turned(turn, brace_small_turn(brace_fma(b, shape->b, a * shape->a)));
}

INLINE void add_at_point(matrix_t *m, const point_t *point, float resists)
{
    const float a = point->share * point->a, b = point->share * point->b;
    m->rr = brace_fma(point->share, resists, m->rr);
    m->ra = brace_fma(a, resists, m->ra);
    m->rb = brace_fma(b, resists, m->rb);
    m->aa = brace_fma(a * point->a, resists, m->aa);
    m->ab = brace_fma(a * point->b, resists, m->ab);
    m->bb = brace_fma(b * point->b, resists, m->bb);
}

/* --- on the way to the equilibrium ---------------------------------------------------------------------------- */

/* A link's share in Newton's equations. They are written for the new shape itself, so what resists the present shape is
 * added to what drives it. The link's end turns by the sum of the coordinates. */
typedef struct {
    matrix_t resists; /* except at the link's end */
    shape_t drives;
    float end_resists, end_drives;
} pull_t;

/* Of a link that nothing has turned, without its end's spring, its weight half at its end: good enough for a first
 * step. The constants are sums over the straight beam: for each coordinate and pair of coordinates
 * int_0^1 of their turns. */
INLINE void pull_straight(const link_t *link, pull_t *pull)
{
    const brace_vec_t lever = vec_plus(link->rigid_mm, link->beam_mm);
    const float resists = vec_dot(link->beam_mm, link->on_rigid_n), drives = vec_cross(link->beam_mm, link->on_rigid_n);
    *pull = (pull_t){.resists = {vec_dot(lever, link->on_rigid_n), 0.788675135f * resists, 0.211324865f * resists,
                                 0.722008468f * resists, 0.233333333f * resists, 0.144658199f * resists},
                     .drives = {vec_cross(lever, link->on_rigid_n), 0.788675135f * drives, 0.211324865f * drives}};
}

INLINE void pull_at_point(const link_t *link, brace_vec_t turn, float turn_rad, const point_t *point, pull_t *pull)
{
    const brace_vec_t lever = vec_turned(link->beam_mm, turn);
    const brace_vec_t force = vec_plus_scaled(link->beyond_n, link->own_n, point->beyond);
    const float resists = vec_dot(lever, force), drives = brace_fma(resists, turn_rad, vec_cross(lever, force));
    add_at_point(&pull->resists, point, resists);
    pull->drives.root = brace_fma(point->share, drives, pull->drives.root);
    pull->drives.a = brace_fma(point->share * point->a, drives, pull->drives.a);
    pull->drives.b = brace_fma(point->share * point->b, drives, pull->drives.b);
}

/* Of a bent link. Two points are enough here. */
INLINE void pull_bent(const link_t *link, const shape_t *shape, pull_t *pull)
{
    static const point_t first = {0.5f, 0.788675135f, 0.5f, -0.0773502692f};
    static const point_t second = {0.5f, 0.211324865f, 1.07735027f, 0.5f};
    brace_vec_t turn = turn_by(shape->root);
    const brace_vec_t rigid = vec_turned(link->rigid_mm, turn);
    const float root_resists = vec_dot(rigid, link->on_rigid_n);
    *pull = (pull_t){.resists = {root_resists, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f},
                     .drives = {brace_fma(root_resists, shape->root, vec_cross(rigid, link->on_rigid_n)), 0.0f, 0.0f}};
    const float first_rad = turn_at(shape, &first), second_rad = turn_at(shape, &second), end_rad = end_turn(shape);
    turn = vec_turned(turn, brace_small_turn(first_rad - shape->root));
    pull_at_point(link, turn, first_rad, &first, pull);
    turn = vec_turned(turn, brace_small_turn(second_rad - first_rad));
    pull_at_point(link, turn, second_rad, &second, pull);
    turn = vec_turned(turn, brace_small_turn(end_rad - second_rad));
    const brace_vec_t spring = vec_turned(link->end_root, turn);
    const float along = vec_dot(spring, link->beyond_n), across = vec_cross(link->beyond_n, spring);
    pull->end_resists = brace_fma(along, along, -(across * across));
    pull->end_drives = brace_fma(pull->end_resists, end_rad, -(along * across));
}

/* --- at the equilibrium --------------------------------------------------------------------------------------- */

/* What a link tells there: how it moves the tip by each coordinate, its springs as vectors of C, and what resists its
 * turns. The springs' part that grows with the square of the load is apart, because the buckling factor needs it so. */
typedef struct {
    matrix_t resists; /* what grows with the load, except at the link's end */
    float end_resists;
    float root_softens, end_softens; /* what grows with the square of the load */
    brace_vec_t tip_mm; /* from the link's root to its end */
    brace_vec_t a, b, end; /* how the tip moves: quarters of these levers */
    brace_vec_t aside; /* less by this: what the springs move changes as they turn */
    brace_vec_t root_spring, end_spring;
} rest_t;

INLINE void rest_at_point(const link_t *link, brace_vec_t turn, const point_t *point, rest_t *rest)
{
    const brace_vec_t lever = vec_turned(link->beam_mm, turn);
    add_at_point(&rest->resists, point, vec_dot(lever, vec_plus_scaled(link->beyond_n, link->own_n, point->beyond)));
    rest->tip_mm = vec_plus_scaled(rest->tip_mm, lever, point->share);
    rest->a = vec_plus_scaled(rest->a, lever, point->share * point->a);
    rest->b = vec_plus_scaled(rest->b, lever, point->share * point->b);
}

INLINE void rest_of(const link_t *link, const shape_t *shape, rest_t *rest)
{
    static const point_t first = {0.277777778f, 0.887298335f, 0.285906746f, -0.0605034154f};
    static const point_t second = {0.444444444f, 0.5f, 0.933012702f, 0.0669872981f};
    static const point_t third = {0.277777778f, 0.112701665f, 1.06050342f, 0.714093254f};
    brace_vec_t turn = turn_by(shape->root);
    const brace_vec_t whole_n = vec_plus(link->beyond_n, link->own_n);
    const brace_vec_t root_spring = vec_turned(link->root_root, turn), rigid = vec_turned(link->to_beam_mm, turn);
    const float root_along = vec_dot(root_spring, whole_n), root_across = vec_cross(whole_n, root_spring);
    *rest = (rest_t){
        .resists = {brace_fma(root_along, root_along, vec_dot(rigid, link->on_rigid_n)), 0.0f, 0.0f, 0.0f, 0.0f, 0.0f},
        .root_softens = root_across * root_across,
        .tip_mm = vec_plus_scaled(rigid, root_spring, root_along),
        .root_spring = root_spring};
    turn = turned_on(turn, shape, first.a, first.b);
    rest_at_point(link, turn, &first, rest);
    turn = turned_on(turn, shape, second.a - first.a, second.b - first.b);
    rest_at_point(link, turn, &second, rest);
    turn = turned_on(turn, shape, third.a - second.a, third.b - second.b);
    rest_at_point(link, turn, &third, rest);
    turn = turned_on(turn, shape, 1.0f - third.a, 1.0f - third.b);
    const brace_vec_t spring = vec_turned(link->end_root, turn);
    const float along = vec_dot(spring, link->beyond_n), across = vec_cross(link->beyond_n, spring);
    const float even = link->end_mm_per_n * vec_dot(link->beyond_n, link->beyond_n);
    const brace_vec_t moved = vec_plus_scaled(vec_scaled(link->beyond_n, link->end_mm_per_n), spring, along);
    const brace_vec_t aside =
        vec_plus_scaled(vec_scaled(vec_quarter(link->beyond_n), link->end_mm_per_n), spring, across);
    rest->end_resists = brace_fma(along, along, even);
    rest->end_softens = brace_fma(across, across, even);
    rest->tip_mm = vec_plus(rest->tip_mm, moved);
    rest->end = vec_minus(vec_quarter(moved), aside);
    rest->aside = vec_plus_scaled(aside, root_spring, root_across);
    rest->a = vec_quarter(rest->a);
    rest->b = vec_quarter(rest->b);
    rest->end_spring = spring;
}

#endif
