/* C at a posture, added up vector by vector, and K from it. Every float path uses this, except planar/planar.c. */
#ifndef BRACE_CORE_TENSOR_H
#define BRACE_CORE_TENSOR_H

#include <float.h>
#include <math.h>
#include <stdint.h>

#include "base/trig.h"
#include "base/vec.h"
#include "brace/element.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* Limits of det C over the squared half trace: below the first C counts as singular, below the second its accuracy is
 * not promised. */
#define BRACE_SINGULAR 1e-12f
#define BRACE_SLENDER 2e-5f

/* C is stored as its entries xx and xz and a third number, second: det C = xx second, zz = second + xz^2/xx. So the
 * determinant is a product, and nothing cancels in it however slender C is. */
typedef struct {
    float xx, xz, second;
} brace_tensor_t;

/* iso I + v v'. xx is never quite zero, because brace_tensor_add divides by it. */
static inline brace_tensor_t brace_tensor_of(float iso_mm_per_n, brace_vec_t v)
{
    const float nearly_nothing = 1e-18f;
    const float iso = iso_mm_per_n + nearly_nothing, xx = brace_fma(v.x, v.x, iso);
    return (brace_tensor_t){xx, v.x * v.z, brace_fma(v.z * v.z, iso / xx, iso)};
}

/* c += by v v', by >= 0: the rank-one update of a Cholesky factor (Gill, Golub, Murray and Saunders, 1974). xx and
 * second grow by squares only. */
static inline void brace_tensor_add_scaled(brace_tensor_t *c, brace_vec_t v, float by)
{
    const float x = by * v.x, xx = brace_fma(x, v.x, c->xx);
    const float beyond = brace_fma(c->xx, v.z, -(c->xz * v.x)); /* xx times v's part beyond c's first column */
    const float per_both = by / (c->xx * xx);
    c->second = brace_fma(beyond * per_both, beyond, c->second);
    c->xz = brace_fma(x, v.z, c->xz);
    c->xx = xx;
}

static inline void brace_tensor_add(brace_tensor_t *c, brace_vec_t v)
{
    brace_tensor_add_scaled(c, v, 1.0f);
}

static inline float brace_tensor_det(const brace_tensor_t *c)
{
    return c->xx * c->second;
}

/* Half the trace of C, and its deviator: C = mean I + [[dev.x, dev.z], [dev.z, -dev.x]]. */
typedef struct {
    float mean;
    brace_vec_t dev;
} brace_circle_t;

static inline brace_circle_t brace_tensor_circle(const brace_tensor_t *c)
{
    const float zz = brace_fma(c->xz / c->xx, c->xz, c->second);
    return (brace_circle_t){0.5f * (c->xx + zz), {0.5f * (c->xx - zz), c->xz}};
}

/* Half the knee angle and the bisector of femur and tibia in the world, as directions. Both together may have the
 * opposite sign. That leaves the tip where it is, and changes the sign of every v, so C stays the same. */
typedef struct {
    brace_vec_t half, bisector;
} brace_posture_t;

/* theta1_rad, theta2_rad: [-7.9, 7.9]. */
static inline brace_posture_t brace_posture(float theta1_rad, float theta2_rad)
{
    const float half_rad = 0.5f * theta2_rad;
    const float knee_half_turns = brace_half_turns(half_rad);
    const float bisector_half_turns = brace_half_turns(theta1_rad - half_rad);
    const float h_high = brace_fma(knee_half_turns, -BRACE_PI, half_rad), h_low = knee_half_turns * -BRACE_PI_LOW;
    const float b = brace_less_half_turns(theta1_rad, bisector_half_turns) - half_rad;
    const float sign = ((int32_t)(knee_half_turns + bisector_half_turns) & 1) != 0 ? -1.0f : 1.0f;
    return (brace_posture_t){.half = {sign * brace_cosine_of_parts(h_high, h_low), sign * brace_sine(h_high + h_low)},
                             .bisector = {brace_cosine_coarse(b), brace_sine(b)}};
}

/* An element's vector at half a knee angle, seen from the bisector. */
static inline brace_vec_t brace_element_at(const brace_element_t *element, brace_vec_t half)
{
    return vec_plus_scaled(vec_scaled(element->folded, half.z), element->straight, half.x);
}

/* K in the world's frame, from C seen from the bisector. bisector_twice: the direction of twice the bisector's angle.
 * returns BRACE_OK or BRACE_E_SINGULAR; stiffness is written on success only, flags as brace_general_stiffness says. */
static inline brace_status_t brace_tensor_inverse(const brace_tensor_t *c, brace_vec_t bisector_twice,
                                                  brace_stiffness_t *stiffness)
{
    const brace_circle_t circle = brace_tensor_circle(c);
    const float mean = circle.mean, det = brace_tensor_det(c), slenderness = det / (mean * mean);
    if (!(slenderness > BRACE_SINGULAR)) {
        return BRACE_E_SINGULAR;
    }
    const brace_vec_t dev = vec_turned(circle.dev, bisector_twice);
    const float radius = sqrtf(brace_fma(dev.x, dev.x, brace_fma(dev.z, dev.z, FLT_MIN)));
    const float per_det = 1.0f / det;
    stiffness->k_xx_n_per_mm = (mean - dev.x) * per_det;
    stiffness->k_xz_n_per_mm = -dev.z * per_det;
    stiffness->k_zz_n_per_mm = (mean + dev.x) * per_det;
    stiffness->lambda_min_n_per_mm = 1.0f / (mean + radius); /* not (mean - radius)/det, which would cancel */
    stiffness->lambda_max_n_per_mm = (mean + radius) * per_det;
    stiffness->stiff_axis_rad = brace_half_angle_of_opposite(dev.x, dev.z, radius);
    stiffness->flags = slenderness < BRACE_SLENDER ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}

#endif
