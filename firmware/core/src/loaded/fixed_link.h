/* One link of a loaded limb in fixed point: what it tells of itself at a shape. loaded/link.h, where the sums and their
 * constants are explained, in the formats of loaded/fixed_vec.h. */
#ifndef BRACE_CORE_LOADED_FIXED_LINK_H
#define BRACE_CORE_LOADED_FIXED_LINK_H

#include "brace/loaded_fixed_types.h"
#include "loaded/fixed_vec.h"

typedef brace_loaded_fixed_shape_t fixed_shape_t; /* angles */

/* Moments. */
typedef struct {
    int32_t root, a, b;
} fixed_drive_t;

typedef struct {
    int32_t rr, ra, rb, aa, ab, bb;
} fixed_matrix_t;

typedef struct {
    fixed_vec_t to_beam, beam, rigid; /* lengths */
    fixed_vec_t root_root, end_root;
    int32_t end_q30, bend;
    fixed_vec_t beyond, own, on_rigid; /* forces */
} fixed_link_t;

INLINE int32_t fixed_end_turn(const fixed_shape_t *shape)
{
    return shape->root + shape->a + shape->b;
}

INLINE int32_t fixed_turn_at(const fixed_shape_t *shape, int32_t a_q30, int32_t b_q30)
{
    return shape->root + coarse(sum2(shape->a, a_q30, shape->b, b_q30), 30);
}

#define Q30(number) (Q31((number) / 2.0))

/* --- on the way to the equilibrium ---------------------------------------------------------------------------- */

typedef struct {
    fixed_matrix_t resists; /* except at the link's end */
    fixed_drive_t drives;
    int32_t end_resists, end_drives;
} fixed_pull_t;

INLINE void fixed_pull_straight(const fixed_link_t *link, fixed_pull_t *pull)
{
    const fixed_vec_t lever = fixed_plus(link->rigid, link->beam);
    const int32_t resists = fixed_dot(link->beam, link->on_rigid, 31);
    const int32_t drives = fixed_cross(link->beam, link->on_rigid, 31);
    *pull = (fixed_pull_t){
        .resists = {fixed_dot(lever, link->on_rigid, 31), coarse_times(resists, Q31(0.788675135), 31),
                    coarse_times(resists, Q31(0.211324865), 31), coarse_times(resists, Q31(0.722008468), 31),
                    coarse_times(resists, Q31(0.233333333), 31), coarse_times(resists, Q31(0.144658199), 31)},
        .drives = {fixed_cross(lever, link->on_rigid, 31), coarse_times(drives, Q31(0.788675135), 31),
                   coarse_times(drives, Q31(0.211324865), 31)}};
}

/* What a point of the beam resists, and what drives there. */
typedef struct {
    int32_t resists, drives;
} fixed_point_t;

INLINE fixed_point_t fixed_pull_at(const fixed_link_t *link, fixed_vec_t turn, int32_t turn_rad, int32_t beyond_q31)
{
    const fixed_vec_t lever = fixed_turned(link->beam, turn);
    const fixed_vec_t force = fixed_plus(link->beyond, fixed_coarsely_scaled(link->own, beyond_q31, 31));
    const int32_t resists = fixed_dot(lever, force, 31);
    return (fixed_point_t){resists, fixed_cross(lever, force, 31) + coarse_times(resists, turn_rad, 29)};
}

INLINE void fixed_pull_bent(const fixed_link_t *link, const fixed_shape_t *shape, fixed_pull_t *pull)
{
    /* Each point's share is a half; a_1, b_1 and a_2, b_2 tell how far each curvature has turned the link there. */
    const double a1 = 0.5, b1 = -0.0773502692, a2 = 1.07735027, b2 = 0.5;
    const int32_t first_rad = fixed_turn_at(shape, Q30(a1), Q30(b1));
    const int32_t second_rad = fixed_turn_at(shape, Q30(a2), Q30(b2)), end_rad = fixed_end_turn(shape);
    fixed_vec_t turn = fixed_turn_by(shape->root);
    const fixed_vec_t rigid = fixed_turned(link->rigid, turn);
    const int32_t root_resists = fixed_dot(rigid, link->on_rigid, 31);
    const int32_t root_drives = fixed_cross(rigid, link->on_rigid, 31) + coarse_times(root_resists, shape->root, 29);
    turn = fixed_turned(turn, fixed_small_turn(first_rad - shape->root));
    const fixed_point_t p = fixed_pull_at(link, turn, first_rad, Q31(0.788675135));
    turn = fixed_turned(turn, fixed_small_turn(second_rad - first_rad));
    const fixed_point_t q = fixed_pull_at(link, turn, second_rad, Q31(0.211324865));
    turn = fixed_turned(turn, fixed_small_turn(end_rad - second_rad));
    const fixed_vec_t spring = fixed_turned(link->end_root, turn);
    const int32_t along = fixed_dot(spring, link->beyond, 30), across = fixed_cross(link->beyond, spring, 30);
    pull->resists = (fixed_matrix_t){root_resists + (p.resists >> 1) + (q.resists >> 1),
                                     coarse(sum2(p.resists, Q31(0.5 * a1), q.resists, Q31(0.5 * a2)), 31),
                                     coarse(sum2(p.resists, Q31(0.5 * b1), q.resists, Q31(0.5 * b2)), 31),
                                     coarse(sum2(p.resists, Q31(0.5 * a1 * a1), q.resists, Q31(0.5 * a2 * a2)), 31),
                                     coarse(sum2(p.resists, Q31(0.5 * a1 * b1), q.resists, Q31(0.5 * a2 * b2)), 31),
                                     coarse(sum2(p.resists, Q31(0.5 * b1 * b1), q.resists, Q31(0.5 * b2 * b2)), 31)};
    pull->drives = (fixed_drive_t){root_drives + (p.drives >> 1) + (q.drives >> 1),
                                   coarse(sum2(p.drives, Q31(0.5 * a1), q.drives, Q31(0.5 * a2)), 31),
                                   coarse(sum2(p.drives, Q31(0.5 * b1), q.drives, Q31(0.5 * b2)), 31)};
    pull->end_resists = shifted(sum2(along, along, -across, across), 33);
    pull->end_drives = coarse_times(pull->end_resists, end_rad, 29) - times(along, across, 33);
}

/* --- at the equilibrium --------------------------------------------------------------------------------------- */

typedef struct {
    fixed_matrix_t resists;
    int32_t end_resists;
    int32_t root_softens, end_softens;
    fixed_vec_t tip;
    fixed_vec_t a, b, end, aside; /* levers */
    fixed_vec_t root_spring, end_spring;
} fixed_rest_t;

INLINE fixed_vec_t fixed_turned_on(fixed_vec_t turn, const fixed_shape_t *shape, int32_t a_q31, int32_t b_q31)
{
    return fixed_turned(turn, fixed_small_turn(coarse(sum2(shape->a, a_q31, shape->b, b_q31), 31)));
}

INLINE int32_t fixed_rest_at(const fixed_link_t *link, fixed_vec_t lever, int32_t beyond_q31)
{
    return fixed_dot(lever, fixed_plus(link->beyond, fixed_coarsely_scaled(link->own, beyond_q31, 31)), 31);
}

/* sum over three points of a moment times a constant at each */
#define OVER_POINTS(a, b, c) coarse(sum3(m[0], Q31(a), m[1], Q31(b), m[2], Q31(c)), 31)

INLINE void fixed_rest_of(const fixed_link_t *link, const fixed_shape_t *shape, fixed_rest_t *rest)
{
    /* shares, and how far each curvature has turned the link at a point */
    const double s1 = 0.277777778, s2 = 0.444444444, s3 = 0.277777778;
    const double a1 = 0.285906746, a2 = 0.933012702, a3 = 1.06050342;
    const double b1 = -0.0605034154, b2 = 0.0669872981, b3 = 0.714093254;
    fixed_vec_t turn = fixed_turn_by(shape->root), lever[3];
    const fixed_vec_t whole = fixed_plus(link->beyond, link->own);
    const fixed_vec_t root_spring = fixed_turned(link->root_root, turn), rigid = fixed_turned(link->to_beam, turn);
    const int32_t root_along = fixed_dot(root_spring, whole, 30), root_across = fixed_cross(whole, root_spring, 30);
    turn = fixed_turned_on(turn, shape, Q31(a1), Q31(b1));
    lever[0] = fixed_turned(link->beam, turn);
    turn = fixed_turned_on(turn, shape, Q31(a2 - a1), Q31(b2 - b1));
    lever[1] = fixed_turned(link->beam, turn);
    turn = fixed_turned_on(turn, shape, Q31(a3 - a2), Q31(b3 - b2));
    lever[2] = fixed_turned(link->beam, turn);
    turn = fixed_turned_on(turn, shape, Q31(1.0 - a3), Q31(1.0 - b3));
    const int32_t m[3] = {fixed_rest_at(link, lever[0], Q31(0.887298335)), fixed_rest_at(link, lever[1], Q31(0.5)),
                          fixed_rest_at(link, lever[2], Q31(0.112701665))};
    const int32_t root_resists = times(root_along, root_along, 33) + fixed_dot(rigid, link->on_rigid, 31);
    rest->resists = (fixed_matrix_t){root_resists + OVER_POINTS(s1, s2, s3),
                                     OVER_POINTS(s1 * a1, s2 * a2, s3 * a3),
                                     OVER_POINTS(s1 * b1, s2 * b2, s3 * b3),
                                     OVER_POINTS(s1 * a1 * a1, s2 * a2 * a2, s3 * a3 * a3),
                                     OVER_POINTS(s1 * a1 * b1, s2 * a2 * b2, s3 * a3 * b3),
                                     OVER_POINTS(s1 * b1 * b1, s2 * b2 * b2, s3 * b3 * b3)};
    rest->root_softens = times(root_across, root_across, 33);
    const fixed_vec_t spring = fixed_turned(link->end_root, turn);
    const int32_t along = fixed_dot(spring, link->beyond, 30), across = fixed_cross(link->beyond, spring, 30);
    const int32_t even = times(fixed_dot(link->beyond, link->beyond, 30), link->end_q30, 33);
    const fixed_vec_t moved = fixed_sum2(link->beyond, link->end_q30, spring, along, 32);
    const fixed_vec_t aside = fixed_sum2(fixed_quarter(link->beyond), link->end_q30, spring, across, 32);
    rest->end_resists = even + times(along, along, 33);
    rest->end_softens = even + times(across, across, 33);
    rest->tip = fixed_plus(fixed_plus(rigid, fixed_scaled(root_spring, root_along, 32)),
                           fixed_plus(fixed_sum3(lever, Q31(s1), Q31(s2), Q31(s3), 31), moved));
    rest->end = fixed_minus(fixed_quarter(moved), aside);
    rest->aside = fixed_plus(aside, fixed_scaled(root_spring, root_across, 32));
    rest->a = fixed_quarter(fixed_sum3(lever, Q31(s1 * a1), Q31(s2 * a2), Q31(s3 * a3), 31));
    rest->b = fixed_quarter(fixed_sum3(lever, Q31(s1 * b1), Q31(s2 * b2), Q31(s3 * b3), 31));
    rest->root_spring = root_spring;
    rest->end_spring = spring;
}

#endif
