/* Vectors, turns and symmetric matrices of the limb in space, in fixed point: loaded/space_frame.h in integers. */
#ifndef BRACE_CORE_FIXED_SPACE_FRAME_H
#define BRACE_CORE_FIXED_SPACE_FRAME_H

#include "fixed_space/number.h"

typedef brace_fixed_vec3_t fixed3_t;

typedef struct {
    int32_t xx, xy, xz, yy, yz, zz;
} fixed_sym3_t;

/* Three vectors, one for each axis of a frame. */
typedef struct {
    fixed3_t x, y, z;
} fixed_axes_t;

INLINE fixed3_t fixed3(int32_t x, int32_t y, int32_t z)
{
    return (fixed3_t){x, y, z};
}

INLINE fixed3_t fixed3_plus(fixed3_t a, fixed3_t b)
{
    return fixed3(plus(a.x, b.x), plus(a.y, b.y), plus(a.z, b.z));
}

/* Divided by 2^bits. */
INLINE fixed3_t fixed3_halved(fixed3_t a, uint32_t bits)
{
    return fixed3(a.x >> bits, a.y >> bits, a.z >> bits);
}

/* Times 2^bits. */
INLINE fixed3_t fixed3_doubled(fixed3_t a, uint32_t bits)
{
    return fixed3((int32_t)((uint32_t)a.x << bits), (int32_t)((uint32_t)a.y << bits), (int32_t)((uint32_t)a.z << bits));
}

/* a by, by a number of q30. */
INLINE fixed3_t fixed3_scaled_q30(fixed3_t a, int32_t by)
{
    return fixed3(by_q30(a.x, by), by_q30(a.y, by), by_q30(a.z, by));
}

/* a + b by, by a number of q30; by a ratio. */
INLINE fixed3_t fixed3_plus_q30(fixed3_t a, fixed3_t b, int32_t by)
{
    return fixed3(plus(a.x, by_q30(b.x, by)), plus(a.y, by_q30(b.y, by)), plus(a.z, by_q30(b.z, by)));
}

INLINE fixed3_t fixed3_plus_q29(fixed3_t a, fixed3_t b, int32_t by)
{
    return fixed3(plus(a.x, by_q29(b.x, by)), plus(a.y, by_q29(b.y, by)), plus(a.z, by_q29(b.z, by)));
}

INLINE fixed3_t fixed3_plus_ratio(fixed3_t a, fixed3_t b, int32_t ratio, ranges_t ranges)
{
    return fixed3(plus(a.x, by_ratio(b.x, ratio, ranges)), plus(a.y, by_ratio(b.y, ratio, ranges)),
                  plus(a.z, by_ratio(b.z, ratio, ranges)));
}

INLINE int64_t fixed3_dot(fixed3_t a, fixed3_t b)
{
    return sum3(a.x, b.x, a.y, b.y, a.z, b.z);
}

/* The cross product, its sums' high words shifted up. */
INLINE fixed3_t fixed3_cross(fixed3_t a, fixed3_t b, int bits)
{
    return fixed3(coarse(sum2(a.y, b.z, minus(a.z), b.y), bits), coarse(sum2(a.z, b.x, minus(a.x), b.z), bits),
                  coarse(sum2(a.x, b.y, minus(a.y), b.x), bits));
}

/* Sum of the axes (q30), each times the vector's part along it; the sums' high words. */
INLINE fixed3_t fixed_axes_times(const fixed_axes_t *e, fixed3_t v)
{
    return fixed3(brace_high_word(sum3(e->x.x, v.x, e->y.x, v.y, e->z.x, v.z)),
                  brace_high_word(sum3(e->x.y, v.x, e->y.y, v.y, e->z.y, v.z)),
                  brace_high_word(sum3(e->x.z, v.x, e->y.z, v.y, e->z.z, v.z)));
}

/* --- turns ---------------------------------------------------------------------------------------------------- */

INLINE fixed_vec_t fixed_back(fixed_vec_t turn)
{
    return (fixed_vec_t){turn.x, minus(turn.z)};
}

INLINE void fixed_pair_turned(int32_t *a, int32_t *b, fixed_vec_t by)
{
    const int32_t first = *a;
    *a = coarse(sum2(by.x, first, minus(by.z), *b), 30);
    *b = coarse(sum2(by.z, first, by.x, *b), 30);
}

/* v in any format, as the frame sees it that holds v's own frame, turned about an axis. */
INLINE fixed3_t fixed_about_x(fixed3_t v, fixed_vec_t by)
{
    fixed_pair_turned(&v.y, &v.z, by);
    return v;
}

INLINE fixed3_t fixed_about_y(fixed3_t v, fixed_vec_t by)
{
    fixed_pair_turned(&v.z, &v.x, by);
    return v;
}

INLINE fixed3_t fixed_about_z(fixed3_t v, fixed_vec_t by)
{
    fixed_pair_turned(&v.x, &v.y, by);
    return v;
}

INLINE void fixed_axis_pair_turned(fixed3_t *a, fixed3_t *b, fixed_vec_t by)
{
    fixed_pair_turned(&a->x, &b->x, by);
    fixed_pair_turned(&a->y, &b->y, by);
    fixed_pair_turned(&a->z, &b->z, by);
}

INLINE void fixed_axes_about_x(fixed_axes_t *axes, fixed_vec_t by)
{
    fixed_axis_pair_turned(&axes->y, &axes->z, by);
}

INLINE void fixed_axes_about_y(fixed_axes_t *axes, fixed_vec_t by)
{
    fixed_axis_pair_turned(&axes->z, &axes->x, by);
}

INLINE void fixed_axes_about_z(fixed_axes_t *axes, fixed_vec_t by)
{
    fixed_axis_pair_turned(&axes->x, &axes->y, by);
}

/* The direction of an angle (q29) below 1.1 rad, as brace_small_turn of base/trig.h. A larger one gives any word. */
INLINE fixed_vec_t fixed_small_turn_of(int32_t angle_q29)
{
    const int32_t x_q30 = twice(angle_q29), u_q30 = coarse_times(x_q30, x_q30, 30);
    const int32_t sine = less(coarse_times(Q31(8.32e-3), u_q30, 30), Q31(1.66666e-1));
    const int32_t cosine = less(coarse_times(Q31(4.14288e-2), u_q30, 30), Q31(0.499991));
    return (fixed_vec_t){plus(1 << 30, coarse_times(cosine, u_q30, 31)),
                         plus(x_q30, coarse_times(coarse_times(sine, u_q30, 31), x_q30, 30))};
}

/* --- symmetric matrices --------------------------------------------------------------------------------------- */

INLINE void fixed_block_turned(int32_t *aa, int32_t *ab, int32_t *bb, fixed_vec_t by)
{
    const int32_t mean = plus(*aa, *bb) >> 1, dev = less(*aa, mean);
    const int32_t twice_c = less(1 << 30, coarse_times(by.z, by.z, 29)), twice_s = coarse_times(by.z, by.x, 29);
    const int32_t turned = coarse(sum2(twice_c, dev, minus(twice_s), *ab), 30);
    *ab = coarse(sum2(twice_s, dev, twice_c, *ab), 30);
    *aa = plus(mean, turned);
    *bb = less(mean, turned);
}

INLINE void fixed_sym3_about_x(fixed_sym3_t *m, fixed_vec_t by)
{
    fixed_block_turned(&m->yy, &m->yz, &m->zz, by);
    fixed_pair_turned(&m->xy, &m->xz, by);
}

INLINE void fixed_sym3_about_y(fixed_sym3_t *m, fixed_vec_t by)
{
    fixed_block_turned(&m->zz, &m->xz, &m->xx, by);
    fixed_pair_turned(&m->yz, &m->xy, by);
}

INLINE void fixed_sym3_about_z(fixed_sym3_t *m, fixed_vec_t by)
{
    fixed_block_turned(&m->xx, &m->xy, &m->yy, by);
    fixed_pair_turned(&m->xz, &m->yz, by);
}

#define ENTRY_MOST_BITS 26 /* 4 */

INLINE void fixed_entry_add(int32_t *entry_q24, int32_t a, int32_t b, ranges_t ranges, noted_t *noted)
{
    *entry_q24 = plus(*entry_q24, by_ratio(a, b, ranges));
    note(noted, *entry_q24, ENTRY_MOST_BITS);
}

/* m (q24) += a b', b a ratio times a; each entry at most 4. */
INLINE void fixed_sym3_add(fixed_sym3_t *m, fixed3_t a, fixed3_t b, ranges_t ranges, noted_t *noted)
{
    fixed_entry_add(&m->xx, a.x, b.x, ranges, noted);
    fixed_entry_add(&m->xy, a.x, b.y, ranges, noted);
    fixed_entry_add(&m->xz, a.x, b.z, ranges, noted);
    fixed_entry_add(&m->yy, a.y, b.y, ranges, noted);
    fixed_entry_add(&m->yz, a.y, b.z, ranges, noted);
    fixed_entry_add(&m->zz, a.z, b.z, ranges, noted);
}

/* a + b / 2^bits */
INLINE fixed_sym3_t fixed_sym3_plus(fixed_sym3_t a, fixed_sym3_t b, int bits)
{
    return (fixed_sym3_t){plus(a.xx, b.xx >> bits), plus(a.xy, b.xy >> bits), plus(a.xz, b.xz >> bits),
                          plus(a.yy, b.yy >> bits), plus(a.yz, b.yz >> bits), plus(a.zz, b.zz >> bits)};
}

#endif
