/* The limb's equations in fixed point, eliminated from the tip to the hip: loaded/solve.h in the formats of
 * loaded/fixed_vec.h. Each function that can be asked of a limb beyond its range says so, and its caller ends there. */
#ifndef BRACE_CORE_LOADED_FIXED_SOLVE_H
#define BRACE_CORE_LOADED_FIXED_SOLVE_H

#include <stdbool.h>

#include "loaded/fixed_link.h"

typedef struct {
    int32_t pivot_a, pivot_b;
    int32_t yields_a, yields_b;
    int32_t b_by_a, root_by_a, root_by_b;
    int32_t resists;
} fixed_factors_t;

/* As pivot_on_the_way of loaded/solve.h. */
#define PIVOT_LEAST_ON_THE_WAY_Q27 (ONE_Q27 / 4)

INLINE int32_t pivot_taken(int32_t pivot, bool is_on_the_way)
{
    return is_on_the_way && pivot < PIVOT_LEAST_ON_THE_WAY_Q27 ? PIVOT_LEAST_ON_THE_WAY_Q27 : pivot;
}

/* returns false where a pivot is too small or a number leaves its range */
INLINE bool fixed_factors_of(const fixed_matrix_t *m, int32_t bend, bool is_on_the_way, fixed_factors_t *f)
{
    lost_t lost = 0u;
    const int32_t on_a = kept((int64_t)bend * m->aa, 29, ROOM_COMPLIANCE, &lost);
    f->pivot_a = pivot_taken(wrapped_plus(ONE_Q27, on_a), is_on_the_way);
    if (lost >= LOST || f->pivot_a < LEAST_PIVOT_Q27) {
        return false;
    }
    f->yields_a = kept((int64_t)bend * inverse_q27(f->pivot_a), 27, ROOM_COMPLIANCE, &lost);
    f->b_by_a = kept((int64_t)m->ab * f->yields_a, 29, ROOM_COMPLIANCE, &lost);
    f->root_by_a = kept((int64_t)m->ra * f->yields_a, 29, ROOM_COMPLIANCE, &lost);
    const int32_t bb = wrapped_less(m->bb, kept((int64_t)m->ab * f->b_by_a, 27, ROOM_RATIO, &lost));
    const int32_t rb = wrapped_less(m->rb, kept((int64_t)m->ab * f->root_by_a, 27, ROOM_RATIO, &lost));
    const int32_t on_b = kept((int64_t)bend * bb, 29, ROOM_COMPLIANCE, &lost);
    f->pivot_b = pivot_taken(wrapped_plus(ONE_Q27, on_b), is_on_the_way);
    if (lost >= LOST || f->pivot_b < LEAST_PIVOT_Q27) {
        return false;
    }
    f->yields_b = kept((int64_t)bend * inverse_q27(f->pivot_b), 27, ROOM_COMPLIANCE, &lost);
    f->root_by_b = kept((int64_t)rb * f->yields_b, 29, ROOM_COMPLIANCE, &lost);
    f->resists = wrapped_less(m->rr, kept(sum2(rb, f->root_by_b, m->ra, f->root_by_a), 27, ROOM_RATIO, &lost));
    return lost < LOST;
}

/* A joint's pivot, and what is left of a moment beyond it. */
INLINE bool fixed_joint_of(int32_t yields, int32_t resists, bool is_on_the_way, int32_t *pivot)
{
    lost_t lost = 0u;
    const int32_t on_joint = kept((int64_t)yields * resists, 29, ROOM_COMPLIANCE, &lost);
    *pivot = pivot_taken(wrapped_plus(ONE_Q27, on_joint), is_on_the_way);
    return lost < LOST && *pivot >= LEAST_PIVOT_Q27;
}

/* --- a step towards the equilibrium --------------------------------------------------------------------------- */

typedef struct {
    fixed_factors_t f;
    int32_t a_driven, b_driven, driven;
} fixed_solved_t;

#define LESS_MOST (4u * ONE_Q27) /* an entry times a ratio, at most */

INLINE bool fixed_solve_in(const fixed_pull_t *pull, int32_t bend, int32_t resists, int32_t drives, fixed_solved_t *s)
{
    lost_t lost = 0u;
    const fixed_matrix_t *m = &pull->resists;
    const int32_t end = pull->end_resists + resists, end_drives = pull->end_drives + drives;
    const fixed_matrix_t whole = {m->rr + end, m->ra + end, m->rb + end, m->aa + end, m->ab + end, m->bb + end};
    if (!fixed_factors_of(&whole, bend, true, &s->f)) {
        return false;
    }
    s->a_driven = pull->drives.a + end_drives;
    s->b_driven =
        wrapped_less(pull->drives.b + end_drives, kept((int64_t)s->f.b_by_a * s->a_driven, 27, ROOM_RATIO, &lost));
    const int32_t root_driven = pull->drives.root + end_drives;
    lost |= (magnitude_of(root_driven) + LESS_MOST) >> 7; /* LOST where the sum leaves its word */
    s->driven = wrapped_less(
        root_driven, kept(sum2(s->f.root_by_a, s->a_driven, s->f.root_by_b, s->b_driven), 27, ROOM_RATIO, &lost));
    return lost < LOST;
}

/* A solved shape, in q27: a step may lead further than a shape may be. */
typedef fixed_shape_t fixed_far_shape_t;

/* Where a link's end stands after a step, in q27: each of the three may be 8 rad, so the sum needs more than a word. */
INLINE int64_t far_end_turn(const fixed_far_shape_t *to)
{
    return (int64_t)to->root + to->a + to->b;
}

/* How far a step turns a link's end, in q27. */
INLINE uint32_t end_turned(const fixed_far_shape_t *to, const fixed_shape_t *from)
{
    const int64_t turned = far_end_turn(to) - (fixed_end_turn(from) >> 2);
    return (uint32_t)(turned < 0 ? -turned : turned);
}

#define FAR_TURN_TO_LOST 6 /* 8 rad in q27 make LOST */

/* A turn in q27: what a compliance (q29) and a moment make, less what a ratio (q27) and a turn in q27 make. Noted as
 * lost from 8 rad on. */
INLINE int32_t far_turn(int32_t yields, int32_t driven, int64_t less_q54, lost_t *lost)
{
    const int64_t own_q54 = ((int64_t)yields * driven) >> 2;
    return kept((int64_t)((uint64_t)own_q54 - (uint64_t)less_q54), 27, ROOM_FAR_TURN, lost);
}

INLINE void fixed_solve_out(const fixed_solved_t *s, int32_t root, fixed_far_shape_t *shape, lost_t *lost)
{
    shape->root = root;
    shape->b = far_turn(s->f.yields_b, s->b_driven, (int64_t)s->f.root_by_b * root, lost);
    shape->a = far_turn(s->f.yields_a, s->a_driven, sum2(s->f.root_by_a, root, s->f.b_by_a, shape->b), lost);
}

typedef struct {
    fixed_link_t femur, tibia;
    fixed_shape_t femur_shape, tibia_shape;
} fixed_limb_t;

#define ANGLE_Q29(rad) ((int32_t)((rad)*0x1p29))
#define ANGLE_Q27(rad) ((int32_t)((rad)*0x1p27))

INLINE bool is_within(int32_t angle, int32_t most)
{
    return angle <= most && angle >= -most;
}

/* femur_to, tibia_to (out): where the step leads
 * returns false where the limb yields too much for the formats */
INLINE bool fixed_step(const fixed_limb_t *limb, bool is_first, int32_t hip, int32_t knee, fixed_far_shape_t *femur_to,
                       fixed_far_shape_t *tibia_to)
{
    fixed_pull_t pull;
    fixed_solved_t tibia, femur;
    int32_t pivot;
    lost_t lost = 0u;
    if (is_first) {
        fixed_pull_straight(&limb->tibia, &pull);
    } else {
        fixed_pull_bent(&limb->tibia, &limb->tibia_shape, &pull);
    }
    if (!fixed_solve_in(&pull, limb->tibia.bend, 0, 0, &tibia) ||
        !fixed_joint_of(knee, tibia.f.resists, true, &pivot)) {
        return false;
    }
    const int32_t per_knee = inverse_q27(pivot);
    const int32_t beyond = kept((int64_t)tibia.f.resists * per_knee, 27, ROOM_RATIO, &lost);
    const int32_t beyond_drives = kept((int64_t)tibia.driven * per_knee, 27, ROOM_RATIO, &lost);
    if (lost >= LOST) {
        return false;
    }
    if (is_first) {
        fixed_pull_straight(&limb->femur, &pull);
    } else {
        fixed_pull_bent(&limb->femur, &limb->femur_shape, &pull);
    }
    if (!fixed_solve_in(&pull, limb->femur.bend, beyond, beyond_drives, &femur) ||
        !fixed_joint_of(hip, femur.f.resists, true, &pivot)) {
        return false;
    }
    const int32_t hip_moment = kept((int64_t)femur.driven * inverse_q27(pivot), 27, ROOM_RATIO, &lost);
    fixed_solve_out(&femur, far_turn(hip, hip_moment, 0, &lost), femur_to, &lost);
    if (lost >= LOST) {
        return false;
    }
    const int32_t by_end = kept(far_end_turn(femur_to) * per_knee, 27, ROOM_FAR_TURN, &lost);
    const int32_t by_knee = far_turn(knee, beyond_drives, 0, &lost);
    if (lost >= LOST) {
        return false;
    }
    const int32_t root = by_end + by_knee;
    lost |= magnitude_of(root) >> FAR_TURN_TO_LOST;
    fixed_solve_out(&tibia, root, tibia_to, &lost);
    return lost < LOST;
}

#define FIXED_STEP_MOST ANGLE_Q27(1.2) /* as STEP_MOST_RAD of loaded/solve.h */
#define FIXED_ROOT_MOST ANGLE_Q27(3.1) /* as loaded.c */
#define FIXED_BEND_MOST ANGLE_Q27(1.2) /* turns between the points of a link stay below 1.41 rad */
#define FIXED_TURNS_MOST ANGLE_Q27(3.9) /* of a root and both curvatures together, the first by a tenth more */

/* Every angle along a link stays below 4 rad. */
INLINE bool is_shape(const fixed_far_shape_t *shape)
{
    const uint32_t root = magnitude_of(shape->root), a = magnitude_of(shape->a), b = magnitude_of(shape->b);
    return root <= (uint32_t)FIXED_ROOT_MOST && a <= (uint32_t)FIXED_BEND_MOST && b <= (uint32_t)FIXED_BEND_MOST &&
           root + a + (a >> 3) + b <= (uint32_t)FIXED_TURNS_MOST;
}

INLINE int32_t far_less(int32_t far, int32_t from_q29)
{
    return far - (from_q29 >> 2);
}

/* Where a step that turns a link's end too far ends. turned_q27: how far it does */
INLINE fixed_far_shape_t part_of_the_way(const fixed_shape_t *from, const fixed_far_shape_t *to, uint32_t turned_q27)
{
    const int32_t part_q30 = (int32_t)(((uint64_t)FIXED_STEP_MOST << 30) / turned_q27);
    return (fixed_far_shape_t){(from->root >> 2) + times(far_less(to->root, from->root), part_q30, 30),
                               (from->a >> 2) + times(far_less(to->a, from->a), part_q30, 30),
                               (from->b >> 2) + times(far_less(to->b, from->b), part_q30, 30)};
}

/* returns false where no shape lies there, as is_shape */
INLINE bool fixed_shape_goes(fixed_shape_t *shape, const fixed_far_shape_t *there)
{
    if (!is_shape(there)) {
        return false;
    }
    *shape = (fixed_shape_t){4 * there->root, 4 * there->a, 4 * there->b};
    return true;
}

/* As bounded_step of loaded/solve.h. turned_q27: what it returns; returns as fixed_step, and false where no shape that
 * the formats hold lies there */
INLINE bool fixed_bounded_step(fixed_limb_t *limb, bool is_first, int32_t hip, int32_t knee, int32_t *turned_q27)
{
    fixed_far_shape_t femur, tibia;
    if (!fixed_step(limb, is_first, hip, knee, &femur, &tibia)) {
        return false;
    }
    const uint32_t by_femur = end_turned(&femur, &limb->femur_shape);
    const uint32_t by_tibia = end_turned(&tibia, &limb->tibia_shape);
    const uint32_t turned = by_femur > by_tibia ? by_femur : by_tibia;
    if (turned > (uint32_t)FIXED_STEP_MOST) {
        femur = part_of_the_way(&limb->femur_shape, &femur, turned);
        tibia = part_of_the_way(&limb->tibia_shape, &tibia, turned);
    }
    *turned_q27 = turned <= (uint32_t)INT32_MAX ? (int32_t)turned : INT32_MAX;
    return fixed_shape_goes(&limb->femur_shape, &femur) && fixed_shape_goes(&limb->tibia_shape, &tibia);
}

/* --- at the equilibrium --------------------------------------------------------------------------------------- */

typedef struct {
    const fixed_rest_t *femur, *tibia;
    int32_t femur_bend, tibia_bend, hip, knee; /* compliances */
} fixed_stance_t;

typedef struct {
    fixed_factors_t femur, tibia;
    int32_t hip, knee; /* pivots of the joints */
    int32_t per_hip, per_knee; /* one over them */
} fixed_pivots_t;

/* The matrix at the present load; returns false where it is too soft, or leaves its range */
INLINE bool fixed_pivots_of(const fixed_stance_t *limb, fixed_pivots_t *p)
{
    fixed_matrix_t m;
    lost_t lost = 0u;
    const fixed_rest_t *rest = limb->tibia;
    int32_t end = rest->end_resists - rest->end_softens;
    m = (fixed_matrix_t){rest->resists.rr + end - rest->root_softens,
                         rest->resists.ra + end,
                         rest->resists.rb + end,
                         rest->resists.aa + end,
                         rest->resists.ab + end,
                         rest->resists.bb + end};
    if (!fixed_factors_of(&m, limb->tibia_bend, false, &p->tibia) ||
        !fixed_joint_of(limb->knee, p->tibia.resists, false, &p->knee)) {
        return false;
    }
    p->per_knee = inverse_q27(p->knee);
    rest = limb->femur;
    end = wrapped_plus(rest->end_resists - rest->end_softens,
                       kept((int64_t)p->tibia.resists * p->per_knee, 27, ROOM_RATIO, &lost));
    if (lost >= LOST) {
        return false;
    }
    m = (fixed_matrix_t){rest->resists.rr + end - rest->root_softens,
                         rest->resists.ra + end,
                         rest->resists.rb + end,
                         rest->resists.aa + end,
                         rest->resists.ab + end,
                         rest->resists.bb + end};
    if (!fixed_factors_of(&m, limb->femur_bend, false, &p->femur) ||
        !fixed_joint_of(limb->hip, p->femur.resists, false, &p->hip)) {
        return false;
    }
    p->per_hip = inverse_q27(p->hip);
    return true;
}

/* A number of any size: mantissa 2^exponent. The mantissa is 0 or at least 2^30. */
typedef struct {
    int32_t mantissa_q31, exponent;
} fixed_wide_t;

/* A number that is not negative, times another. */
INLINE fixed_wide_t wide_times(fixed_wide_t a, int32_t b_q27)
{
    const int32_t product = times(a.mantissa_q31, b_q27, 27 + 4); /* b is below 16 */
    const uint32_t zeros = leading_zeros((uint32_t)product | 1u) - 1u;
    return (fixed_wide_t){(int32_t)((uint32_t)product << zeros), a.exponent + 4 - (int32_t)zeros};
}

/* The determinant: the product of the pivots. */
INLINE fixed_wide_t fixed_product(const fixed_pivots_t *p)
{
    fixed_wide_t product = {1 << 30, 1};
    product = wide_times(product, p->tibia.pivot_a);
    product = wide_times(product, p->tibia.pivot_b);
    product = wide_times(product, p->knee);
    product = wide_times(product, p->femur.pivot_a);
    product = wide_times(product, p->femur.pivot_b);
    return wide_times(product, p->hip);
}

#endif
