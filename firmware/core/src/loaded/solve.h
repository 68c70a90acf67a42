/* The limb's equations, eliminated from the tip to the hip: each link's curvatures, then the joint at its root.
 *
 * They are written with compliances, so that a joint or a beam may be rigid. A pivot is 1 at no load, and 0 where the
 * load has softened the limb to nothing.
 */
#ifndef BRACE_CORE_LOADED_SOLVE_H
#define BRACE_CORE_LOADED_SOLVE_H

#include <math.h>
#include <stdbool.h>

#include "loaded/link.h"

/* On the way to the equilibrium a smaller pivot counts as this one. The load may soften the straight limb to nothing
 * and hold the bent one: then a step that went by the straight limb would go the wrong way, or much too far. */
#define PIVOT_LEAST_ON_THE_WAY 0.25f

#define STEP_MOST_RAD 1.2f /* no step turns a link's end further */

INLINE float pivot_on_the_way(float pivot)
{
    return pivot < PIVOT_LEAST_ON_THE_WAY ? PIVOT_LEAST_ON_THE_WAY : pivot;
}

/* A link's matrix with its curvatures eliminated, first a, then b. What is left is its root. */
typedef struct {
    float pivot_a, pivot_b;
    float yields_a, yields_b;           /* compliance of each curvature, load included */
    float b_by_a, root_by_a, root_by_b; /* what eliminating one adds to another */
    float resists;                      /* of the root */
} factors_t;

INLINE factors_t factors_of(const matrix_t *m, float bend_rad_per_n_mm, bool is_on_the_way)
{
    factors_t f;
    const float pivot_a = brace_fma(bend_rad_per_n_mm, m->aa, 1.0f);
    f.pivot_a = is_on_the_way ? pivot_on_the_way(pivot_a) : pivot_a;
    f.yields_a = bend_rad_per_n_mm / f.pivot_a;
    f.b_by_a = m->ab * f.yields_a;
    f.root_by_a = m->ra * f.yields_a;
    const float bb = brace_fma(-m->ab, f.b_by_a, m->bb), rb = brace_fma(-m->ab, f.root_by_a, m->rb);
    const float pivot_b = brace_fma(bend_rad_per_n_mm, bb, 1.0f);
    f.pivot_b = is_on_the_way ? pivot_on_the_way(pivot_b) : pivot_b;
    f.yields_b = bend_rad_per_n_mm / f.pivot_b;
    f.root_by_b = rb * f.yields_b;
    f.resists = brace_fma(-rb, f.root_by_b, brace_fma(-m->ra, f.root_by_a, m->rr));
    return f;
}

/* --- a step towards the equilibrium --------------------------------------------------------------------------- */

/* A link with its curvatures eliminated, and what drives each coordinate then. */
typedef struct {
    factors_t f;
    float a_driven, b_driven, driven;
} solved_t;

/* resists, drives: what all beyond the link does to its end. */
INLINE solved_t solve_in(const pull_t *pull, float bend_rad_per_n_mm, float resists, float drives)
{
    const matrix_t *m = &pull->resists;
    const float end = pull->end_resists + resists, end_drives = pull->end_drives + drives;
    const matrix_t whole = {m->rr + end, m->ra + end, m->rb + end, m->aa + end, m->ab + end, m->bb + end};
    solved_t s = {.f = factors_of(&whole, bend_rad_per_n_mm, true)};
    s.a_driven = pull->drives.a + end_drives;
    s.b_driven = brace_fma(-s.f.b_by_a, s.a_driven, pull->drives.b + end_drives);
    s.driven =
        brace_fma(-s.f.root_by_b, s.b_driven, brace_fma(-s.f.root_by_a, s.a_driven, pull->drives.root + end_drives));
    return s;
}

/* A link's shape from the turn of its root. */
INLINE shape_t solve_out(const solved_t *s, float root)
{
    shape_t shape = {.root = root};
    shape.b = brace_fma(s->f.yields_b, s->b_driven, -(s->f.root_by_b * root));
    shape.a = brace_fma(s->f.yields_a, s->a_driven, -brace_fma(s->f.root_by_a, root, s->f.b_by_a * shape.b));
    return shape;
}

INLINE void shape_goes(shape_t *shape, const shape_t *from, float part)
{
    shape->root = brace_fma(part, shape->root - from->root, from->root);
    shape->a = brace_fma(part, shape->a - from->a, from->a);
    shape->b = brace_fma(part, shape->b - from->b, from->b);
}

/* A step of Newton's method. is_first: nothing is bent yet. */
INLINE void step(brace_loaded_rest_t *limb, bool is_first, float hip_rad_per_n_mm, float knee_rad_per_n_mm)
{
    pull_t pull;
    if (is_first) {
        pull_straight(&limb->tibia, &pull);
    } else {
        pull_bent(&limb->tibia, &limb->tibia_shape, &pull);
    }
    const solved_t tibia = solve_in(&pull, limb->tibia.bend_rad_per_n_mm, 0.0f, 0.0f);
    const float knee = 1.0f / pivot_on_the_way(brace_fma(knee_rad_per_n_mm, tibia.f.resists, 1.0f));
    if (is_first) {
        pull_straight(&limb->femur, &pull);
    } else {
        pull_bent(&limb->femur, &limb->femur_shape, &pull);
    }
    const solved_t femur = solve_in(&pull, limb->femur.bend_rad_per_n_mm, tibia.f.resists * knee, tibia.driven * knee);
    const float hip = 1.0f / pivot_on_the_way(brace_fma(hip_rad_per_n_mm, femur.f.resists, 1.0f));
    limb->femur_shape = solve_out(&femur, hip_rad_per_n_mm * femur.driven * hip);
    limb->tibia_shape =
        solve_out(&tibia, brace_fma(knee_rad_per_n_mm, tibia.driven, end_turn(&limb->femur_shape)) * knee);
}

/* A step that turns no link's end by more than a step may. returns how far it turns them [rad] */
INLINE float bounded_step(brace_loaded_rest_t *limb, bool is_first, float hip_rad_per_n_mm, float knee_rad_per_n_mm)
{
    const shape_t femur = limb->femur_shape, tibia = limb->tibia_shape;
    step(limb, is_first, hip_rad_per_n_mm, knee_rad_per_n_mm);
    const float femur_rad = fabsf(end_turn(&limb->femur_shape) - end_turn(&femur));
    const float tibia_rad = fabsf(end_turn(&limb->tibia_shape) - end_turn(&tibia));
    const float turned_rad = femur_rad > tibia_rad ? femur_rad : tibia_rad;
    if (turned_rad > STEP_MOST_RAD) {
        const float part = STEP_MOST_RAD / turned_rad;
        shape_goes(&limb->femur_shape, &femur, part);
        shape_goes(&limb->tibia_shape, &tibia, part);
    }
    return turned_rad;
}

/* --- at the equilibrium --------------------------------------------------------------------------------------- */

/* A link's matrix with the load taken `times` as large. beyond: what resists the link's end because of all that comes
 * after it. */
INLINE matrix_t loaded_matrix(const rest_t *rest, float times, float beyond)
{
    const matrix_t *r = &rest->resists;
    const float square = times * times;
    const float end = brace_fma(-square, rest->end_softens, brace_fma(times, rest->end_resists, beyond));
    return (matrix_t){brace_fma(-square, rest->root_softens, brace_fma(times, r->rr, end)),
                      brace_fma(times, r->ra, end),
                      brace_fma(times, r->rb, end),
                      brace_fma(times, r->aa, end),
                      brace_fma(times, r->ab, end),
                      brace_fma(times, r->bb, end)};
}

/* The limb at its equilibrium: its links, and how its joints yield there. */
typedef struct {
    const rest_t *femur, *tibia;
    float femur_rad_per_n_mm, tibia_rad_per_n_mm; /* of the curvatures */
    float hip_rad_per_n_mm, knee_rad_per_n_mm;
} stance_t;

/* The whole matrix, eliminated. */
typedef struct {
    factors_t femur, tibia;
    float hip, knee; /* pivots of the joints */
} pivots_t;

INLINE pivots_t pivots_at(const stance_t *limb, float times)
{
    pivots_t p;
    const matrix_t tibia = loaded_matrix(limb->tibia, times, 0.0f);
    p.tibia = factors_of(&tibia, limb->tibia_rad_per_n_mm, false);
    p.knee = brace_fma(limb->knee_rad_per_n_mm, p.tibia.resists, 1.0f);
    const matrix_t femur = loaded_matrix(limb->femur, times, p.tibia.resists / p.knee);
    p.femur = factors_of(&femur, limb->femur_rad_per_n_mm, false);
    p.hip = brace_fma(limb->hip_rad_per_n_mm, p.femur.resists, 1.0f);
    return p;
}

INLINE bool is_stable(const pivots_t *p, float least)
{
    return p->tibia.pivot_a > least && p->tibia.pivot_b > least && p->knee > least && p->femur.pivot_a > least &&
           p->femur.pivot_b > least && p->hip > least;
}

/* The determinant: it falls through zero where the first pivot does. */
INLINE float product(const pivots_t *p)
{
    return p->tibia.pivot_a * p->tibia.pivot_b * p->knee * (p->femur.pivot_a * p->femur.pivot_b * p->hip);
}

#endif
