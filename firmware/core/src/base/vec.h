/* Vectors in the limb's plane. */
#ifndef BRACE_VEC_H
#define BRACE_VEC_H

#include "brace/chain.h"

/* Turned a quarter counter-clockwise: a link's bending direction from its axis, a lever from an arm. */
static inline brace_vec_t vec_quarter(brace_vec_t v)
{
    return (brace_vec_t){-v.z, v.x};
}

static inline brace_vec_t vec_scaled(brace_vec_t v, float by)
{
    return (brace_vec_t){v.x * by, v.z * by};
}

static inline brace_vec_t vec_minus(brace_vec_t a, brace_vec_t b)
{
    return (brace_vec_t){a.x - b.x, a.z - b.z};
}

static inline float vec_dot(brace_vec_t a, brace_vec_t b)
{
    return __builtin_fmaf(a.x, b.x, a.z * b.z);
}

static inline float vec_cross(brace_vec_t a, brace_vec_t b)
{
    return __builtin_fmaf(a.x, b.z, -(a.z * b.x));
}

#endif
