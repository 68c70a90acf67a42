/* Vectors, turns and symmetric matrices in space, in the frames of a loaded limb's links.
 *
 * A link's frame: x along the link, y across it in the limb's plane, counter-clockwise of x, z = x cross y out of that
 * plane. So a joint of the plane turns about z.
 */
#ifndef BRACE_CORE_SPACE_FRAME_H
#define BRACE_CORE_SPACE_FRAME_H

#include "base/fma.h"
#include "base/inline.h"
#include "base/vec.h"
#include "brace/vec.h"

typedef brace_vec3_t vec3_t;
typedef brace_sym3_t sym3_t;

typedef brace_axes_t axes_t;

INLINE vec3_t vec3(float x, float y, float z)
{
    return (vec3_t){x, y, z};
}

INLINE vec3_t vec3_plus(vec3_t a, vec3_t b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}

INLINE vec3_t vec3_scaled(vec3_t a, float by)
{
    return vec3(a.x * by, a.y * by, a.z * by);
}

/* a + by b */
INLINE vec3_t vec3_plus_scaled(vec3_t a, vec3_t b, float by)
{
    return vec3(brace_fma(by, b.x, a.x), brace_fma(by, b.y, a.y), brace_fma(by, b.z, a.z));
}

INLINE float vec3_dot(vec3_t a, vec3_t b)
{
    return brace_fma(a.x, b.x, brace_fma(a.y, b.y, a.z * b.z));
}

INLINE vec3_t vec3_cross(vec3_t a, vec3_t b)
{
    return vec3(brace_fma(a.y, b.z, -(a.z * b.y)), brace_fma(a.z, b.x, -(a.x * b.z)),
                brace_fma(a.x, b.y, -(a.y * b.x)));
}

/* sum of the axes, each times the vector's part along it */
INLINE vec3_t axes_times(const axes_t *e, vec3_t v)
{
    return vec3_plus_scaled(vec3_plus_scaled(vec3_scaled(e->x, v.x), e->y, v.y), e->z, v.z);
}

/* --- turns ---------------------------------------------------------------------------------------------------- */

INLINE brace_vec_t back(brace_vec_t turn)
{
    return (brace_vec_t){turn.x, -turn.z};
}

INLINE void pair_turned(float *a, float *b, brace_vec_t by)
{
    const float first = *a;
    *a = brace_fma(by.x, first, -(by.z * *b));
    *b = brace_fma(by.z, first, by.x * *b);
}

/* v as the frame sees it that holds v's own frame, turned about an axis. */
INLINE vec3_t about_x(vec3_t v, brace_vec_t by)
{
    pair_turned(&v.y, &v.z, by);
    return v;
}

INLINE vec3_t about_y(vec3_t v, brace_vec_t by)
{
    pair_turned(&v.z, &v.x, by);
    return v;
}

INLINE vec3_t about_z(vec3_t v, brace_vec_t by)
{
    pair_turned(&v.x, &v.y, by);
    return v;
}

INLINE void axis_pair_turned(vec3_t *a, vec3_t *b, brace_vec_t by)
{
    pair_turned(&a->x, &b->x, by);
    pair_turned(&a->y, &b->y, by);
    pair_turned(&a->z, &b->z, by);
}

INLINE void axes_about_x(axes_t *axes, brace_vec_t by)
{
    axis_pair_turned(&axes->y, &axes->z, by);
}

INLINE void axes_about_y(axes_t *axes, brace_vec_t by)
{
    axis_pair_turned(&axes->z, &axes->x, by);
}

INLINE void axes_about_z(axes_t *axes, brace_vec_t by)
{
    axis_pair_turned(&axes->x, &axes->y, by);
}

/* --- symmetric matrices --------------------------------------------------------------------------------------- */

INLINE void block_turned(float *aa, float *ab, float *bb, brace_vec_t by)
{
    const float mean = 0.5f * (*aa + *bb), dev = *aa - mean;
    const float twice_c = brace_fma(-2.0f * by.z, by.z, 1.0f), twice_s = (by.z + by.z) * by.x;
    const float turned = brace_fma(twice_c, dev, -(twice_s * *ab));
    *ab = brace_fma(twice_s, dev, twice_c * *ab);
    *aa = mean + turned;
    *bb = mean - turned;
}

INLINE void sym3_about_x(sym3_t *m, brace_vec_t by)
{
    block_turned(&m->yy, &m->yz, &m->zz, by);
    pair_turned(&m->xy, &m->xz, by);
}

INLINE void sym3_about_y(sym3_t *m, brace_vec_t by)
{
    block_turned(&m->zz, &m->xz, &m->xx, by);
    pair_turned(&m->yz, &m->xy, by);
}

INLINE void sym3_about_z(sym3_t *m, brace_vec_t by)
{
    block_turned(&m->xx, &m->xy, &m->yy, by);
    pair_turned(&m->xz, &m->yz, by);
}

/* m += a b', b a multiple of a */
INLINE void sym3_add(sym3_t *m, vec3_t a, vec3_t b)
{
    m->xx = brace_fma(a.x, b.x, m->xx);
    m->xy = brace_fma(a.x, b.y, m->xy);
    m->xz = brace_fma(a.x, b.z, m->xz);
    m->yy = brace_fma(a.y, b.y, m->yy);
    m->yz = brace_fma(a.y, b.z, m->yz);
    m->zz = brace_fma(a.z, b.z, m->zz);
}

INLINE sym3_t sym3_plus_scaled(sym3_t a, sym3_t b, float by)
{
    return (sym3_t){brace_fma(by, b.xx, a.xx), brace_fma(by, b.xy, a.xy), brace_fma(by, b.xz, a.xz),
                    brace_fma(by, b.yy, a.yy), brace_fma(by, b.yz, a.yz), brace_fma(by, b.zz, a.zz)};
}

#endif
