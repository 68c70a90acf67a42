/* Arithmetic of vectors in the limb's plane. */
#ifndef BRACE_CORE_VEC_H
#define BRACE_CORE_VEC_H

#include <math.h>

#include "base/fma.h"
#include "brace/vec.h"

/* v turned a quarter counter-clockwise: makes a link's bending direction from its axis, and a lever from an arm. */
static inline brace_vec_t vec_quarter(brace_vec_t v)
{
    return (brace_vec_t){-v.z, v.x};
}

static inline brace_vec_t vec_scaled(brace_vec_t v, float by)
{
    return (brace_vec_t){v.x * by, v.z * by};
}

static inline brace_vec_t vec_plus(brace_vec_t a, brace_vec_t b)
{
    return (brace_vec_t){a.x + b.x, a.z + b.z};
}

static inline brace_vec_t vec_minus(brace_vec_t a, brace_vec_t b)
{
    return (brace_vec_t){a.x - b.x, a.z - b.z};
}

/* a + by b */
static inline brace_vec_t vec_plus_scaled(brace_vec_t a, brace_vec_t b, float by)
{
    return (brace_vec_t){brace_fma(by, b.x, a.x), brace_fma(by, b.z, a.z)};
}

static inline float vec_dot(brace_vec_t a, brace_vec_t b)
{
    return brace_fma(a.x, b.x, a.z * b.z);
}

static inline float vec_cross(brace_vec_t a, brace_vec_t b)
{
    return brace_fma(a.x, b.z, -(a.z * b.x));
}

static inline float vec_length(brace_vec_t v)
{
    return sqrtf(vec_dot(v, v));
}

/* v turned by a direction's angle: from the frame whose x axis is that direction into the frame that holds it. */
static inline brace_vec_t vec_turned(brace_vec_t v, brace_vec_t by)
{
    return (brace_vec_t){brace_fma(v.x, by.x, -(v.z * by.z)), brace_fma(v.x, by.z, v.z * by.x)};
}

/* v turned back by a direction's angle: v as seen in the frame whose x axis is that direction. */
static inline brace_vec_t vec_turned_back(brace_vec_t v, brace_vec_t by)
{
    return (brace_vec_t){brace_fma(v.x, by.x, v.z * by.z), brace_fma(v.z, by.x, -(v.x * by.z))};
}

/* The direction of twice a direction's angle. */
static inline brace_vec_t vec_doubled(brace_vec_t direction)
{
    const float x = direction.x, z = direction.z;
    return (brace_vec_t){(x - z) * (x + z), 2.0f * x * z};
}

#endif
