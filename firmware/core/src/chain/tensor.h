/* C in the limb's plane at a posture, and from it K. What every float path but the planar tick (planar/planar.c) is made
 * of.
 */
#ifndef BRACE_CHAIN_TENSOR_H
#define BRACE_CHAIN_TENSOR_H

#include <float.h>

#include "brace/chain.h"
#include "brace/planar.h"
#include "base/check.h"
#include "base/trig.h"
#include "base/vec.h"

/* det C over mean^2 below which C counts as singular, and below which its accuracy is not promised. */
#define BRACE_SINGULAR 1e-12f
#define BRACE_SLENDER 2e-5f

/* C and its determinant. */
typedef struct {
    float xx, xz, zz, det;
} brace_tensor_t;

/* Mohr's circle of a tensor: half its trace, and its deviator [[dev.x, dev.z], [dev.z, -dev.x]]. */
typedef struct {
    float mean;
    brace_vec_t dev;
} brace_circle_t;

/* Directions of half the knee angle, and of the bisector of femur and tibia in the world; together they may be the
 * opposite ones, which leaves where the tip is and changes only the signs of what is squared. */
typedef struct {
    brace_vec_t half, bisector;
} brace_posture_t;

/* Angles in [-7.9, 7.9]; small numbers at the straight and at the folded knee stay exact. */
void brace_posture(float theta1_rad, float theta2_rad, brace_posture_t *at);

/* BRACE_OK, BRACE_E_RANGE beyond BRACE_PLANAR_REACH_RAD2, BRACE_E_NOT_FINITE. */
static inline brace_status_t brace_check_reach(float theta1_rad, float theta2_rad)
{
    const uint32_t reach = brace_magnitude_bits(theta1_rad * theta1_rad + theta2_rad * theta2_rad);
    if (reach <= brace_magnitude_bits(BRACE_PLANAR_REACH_RAD2)) {
        return BRACE_OK;
    }
    return reach < BRACE_INFINITE_BITS ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
}

static inline brace_vec_t brace_turned(brace_vec_t v, brace_vec_t by)
{
    return (brace_vec_t){__builtin_fmaf(v.x, by.x, -(v.z * by.z)), __builtin_fmaf(v.x, by.z, v.z * by.x)};
}

/* Turned back: a vector of the world, seen from a direction. */
static inline brace_vec_t brace_seen_from(brace_vec_t v, brace_vec_t from)
{
    return (brace_vec_t){__builtin_fmaf(v.x, from.x, v.z * from.z),
                         __builtin_fmaf(v.z, from.x, -(v.x * from.z))};
}

/* The direction of twice the angle. */
static inline brace_vec_t brace_doubled(brace_vec_t direction)
{
    const float twice = 2.0f * direction.z;
    return (brace_vec_t){__builtin_fmaf(-twice, direction.z, 1.0f), twice * direction.x};
}

/* What halved elements come to at half a knee angle, in the bisector's frame. */
static inline brace_vec_t brace_swing_at(const brace_swing_t *halved, brace_vec_t half)
{
    return (brace_vec_t){__builtin_fmaf(halved->straight.x, half.x, halved->folded.x * half.z),
                         __builtin_fmaf(halved->straight.z, half.x, halved->folded.z * half.z)};
}

/* c + v v'; c's trace is not zero (FLT_MIN does). Its determinant is det + v' adj(c) v, and v' adj(c) v times the trace is
 * |adj(c) v|^2 + det |v|^2: positive terms only, so nothing cancels however slender c is. */
static inline brace_tensor_t brace_tensor_plus(brace_tensor_t c, brace_vec_t v)
{
    const brace_vec_t adj_v = {__builtin_fmaf(c.zz, v.x, -(c.xz * v.z)),
                               __builtin_fmaf(c.xx, v.z, -(c.xz * v.x))};
    const float forms = __builtin_fmaf(c.det, vec_dot(v, v), vec_dot(adj_v, adj_v));
    return (brace_tensor_t){__builtin_fmaf(v.x, v.x, c.xx), __builtin_fmaf(v.x, v.z, c.xz),
                            __builtin_fmaf(v.z, v.z, c.zz), c.det + forms / (c.xx + c.zz)};
}

/* The circle of a tensor seen from the bisector, in the world's frame. */
static inline brace_circle_t brace_circle_in_world(brace_tensor_t c, brace_vec_t to_world)
{
    return (brace_circle_t){0.5f * (c.xx + c.zz), brace_turned((brace_vec_t){0.5f * (c.xx - c.zz), c.xz}, to_world)};
}

/* All of a K but its flags, from its circle (brace_circle_t, the deviator first: it comes to where its angle is asked for). */
void brace_stiffness_of_circle(float dev_z, float dev_x, float mean, brace_stiffness_t *stiffness);

/* K in the world's frame of C seen from the bisector, as brace_chain_stiffness says. to_world: direction of twice the
 * bisector's angle. BRACE_OK or BRACE_E_SINGULAR: then stiffness is untouched. */
static inline brace_status_t brace_tensor_inverse(brace_tensor_t c, brace_vec_t to_world, brace_stiffness_t *stiffness)
{
    const brace_tensor_t adjugate = {c.zz, -c.xz, c.xx, c.det}; /* K times det C */
    const brace_circle_t circle = brace_circle_in_world(adjugate, to_world);
    const float mean = circle.mean, slenderness = c.det / (mean * mean);
    if (!(slenderness > BRACE_SINGULAR)) {
        return BRACE_E_SINGULAR;
    }
    stiffness->flags = brace_bits(slenderness) < brace_bits(BRACE_SLENDER) ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    brace_stiffness_of_circle(circle.dev.z / c.det, circle.dev.x / c.det, mean / c.det, stiffness);
    stiffness->lambda_min_n_per_mm = 1.0f / (c.det * stiffness->lambda_max_n_per_mm); /* no difference: nothing cancels */
    return BRACE_OK;
}

#endif
