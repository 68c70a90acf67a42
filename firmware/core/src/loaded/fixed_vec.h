/* Numbers of the loaded limb in fixed point.
 *
 * Units: of length, a power of two above the reach; of force, one above the sum of the loads. Formats: _q28 is a number
 * times 2^28 in 32 bits. Without a suffix, each kind of number has one format, which all files of this path share:
 *
 *   lengths, levers                              q28   (-8 to 8)
 *   directions, forces, springs' vectors         q30   (-2 to 2)
 *   angles                                       q29   (-4 to 4)
 *   compliances per angle                        q29   (0 to 4)
 *   moments and entries of the matrix, pivots,
 *   one over a pivot, ratios of entries          q27   (-16 to 16)
 *
 * A sum of products is added up in 64 bits and shifted once.
 */
#ifndef BRACE_CORE_LOADED_FIXED_VEC_H
#define BRACE_CORE_LOADED_FIXED_VEC_H

#include "base/inline.h"
#include "brace/fixed_vec.h"
#include "fixed/fixed_sincos.h"
#include "fixed/fixed_word.h"

typedef brace_fixed_vec_t fixed_vec_t;

/* A constant below 1, rounded: above zero, truncation rounds down. */
#define Q31(number) ((int32_t)((int64_t)((number)*0x1p31 + 0x1p31 + 0.5) - 2147483648))
#define ONE_Q27 (1 << 27)

/* Sums of products, whole. Sums that leave 64 bits wrap. */
INLINE int64_t sum2(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return (int64_t)((uint64_t)((int64_t)a * b) + (uint64_t)((int64_t)c * d));
}

INLINE int64_t sum3(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    return (int64_t)((uint64_t)sum2(a, b, c, d) + (uint64_t)((int64_t)e * f));
}

/* A sum, shifted. */
INLINE int32_t shifted(int64_t sum, int bits)
{
    return bits >= 32 ? brace_high_word(sum) >> (bits - 32) : (int32_t)(uint32_t)((uint64_t)sum >> bits);
}

/* The same by its high word alone, one instruction shorter: its last 32 - bits bits are zero. */
INLINE int32_t coarse(int64_t sum, int bits)
{
    return (int32_t)((uint32_t)brace_high_word(sum) << (32 - bits));
}

INLINE int32_t times(int32_t a, int32_t b, int bits)
{
    return shifted((int64_t)a * b, bits);
}

INLINE int32_t coarse_times(int32_t a, int32_t b, int bits)
{
    return coarse((int64_t)a * b, bits);
}

/* Sums that wrap, for what may have left its range and is refused for that. */
INLINE int32_t wrapped_plus(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}

INLINE int32_t wrapped_less(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

/* --- numbers that a load may drive out of their range --------------------------------------------------------- */

/* Collects the magnitudes of sums of products. Where one is too large, the limb is refused. */
typedef uint32_t lost_t;
#define LOST (1u << 24)

/* A sum, shifted; noted as lost where its magnitude reaches 2^(56 + room). */
INLINE int32_t kept(int64_t sum, int bits, int room, lost_t *lost)
{
    *lost |= magnitude_of(brace_high_word(sum)) >> room;
    return shifted(sum, bits);
}

/* Rooms: 4 in the result of an entry (q27) times a ratio (q27), of a lever (q28) times a ratio, and of a compliance
 * (q29) times an entry; 8 in what is left of a lever, and 8 rad (q27) in
 * where a step leads. */
enum { ROOM_RATIO = 0, ROOM_LEVER = 1, ROOM_COMPLIANCE = 2, ROOM_LEVER_LESS = 2, ROOM_FAR_TURN = 1 };

#define LEAST_PIVOT_Q27 (ONE_Q27 / 16 + 1) /* one over a sixteenth would be 16, which q27 does not hold */

/* One over a pivot that is at least LEAST_PIVOT_Q27: 16 bits by division, the rest by a step of Newton's method. */
INLINE int32_t inverse_q27(int32_t pivot_q27)
{
    const uint32_t zeros = leading_zeros((uint32_t)pivot_q27), leading = (uint32_t)pivot_q27 << zeros;
    const uint32_t guess = (0x80000000u / (leading >> 16)) << 15;
    const uint32_t inverse = high_unsigned(guess, (0x80000000u - high_unsigned(leading, guess)) << 1);
    return (int32_t)((inverse << 1) >> (8u - zeros));
}

/* --- vectors -------------------------------------------------------------------------------------------------- */

INLINE fixed_vec_t fixed_plus(fixed_vec_t a, fixed_vec_t b)
{
    return (fixed_vec_t){a.x + b.x, a.z + b.z};
}

INLINE fixed_vec_t fixed_minus(fixed_vec_t a, fixed_vec_t b)
{
    return (fixed_vec_t){a.x - b.x, a.z - b.z};
}

/* Turned a quarter, counter-clockwise. */
INLINE fixed_vec_t fixed_quarter(fixed_vec_t v)
{
    return (fixed_vec_t){-v.z, v.x};
}

INLINE fixed_vec_t fixed_right(fixed_vec_t v, uint32_t bits)
{
    return (fixed_vec_t){v.x >> bits, v.z >> bits};
}

/* v times a number, its product shifted. */
INLINE fixed_vec_t fixed_scaled(fixed_vec_t v, int32_t by, int bits)
{
    return (fixed_vec_t){times(v.x, by, bits), times(v.z, by, bits)};
}

INLINE fixed_vec_t fixed_coarsely_scaled(fixed_vec_t v, int32_t by, int bits)
{
    return (fixed_vec_t){coarse_times(v.x, by, bits), coarse_times(v.z, by, bits)};
}

/* a by + b to, shifted. */
INLINE fixed_vec_t fixed_sum2(fixed_vec_t a, int32_t by, fixed_vec_t b, int32_t to, int bits)
{
    return (fixed_vec_t){shifted(sum2(a.x, by, b.x, to), bits), shifted(sum2(a.z, by, b.z, to), bits)};
}

INLINE fixed_vec_t fixed_sum3(const fixed_vec_t v[3], int32_t a, int32_t b, int32_t c, int bits)
{
    return (fixed_vec_t){coarse(sum3(v[0].x, a, v[1].x, b, v[2].x, c), bits),
                         coarse(sum3(v[0].z, a, v[1].z, b, v[2].z, c), bits)};
}

INLINE int32_t fixed_dot(fixed_vec_t a, fixed_vec_t b, int bits)
{
    return coarse(sum2(a.x, b.x, a.z, b.z), bits);
}

INLINE int32_t fixed_cross(fixed_vec_t a, fixed_vec_t b, int bits)
{
    return coarse(sum2(a.x, b.z, -a.z, b.x), bits);
}

/* v in any format, turned by a direction. */
INLINE fixed_vec_t fixed_turned(fixed_vec_t v, fixed_vec_t by)
{
    return (fixed_vec_t){coarse(sum2(v.x, by.x, -v.z, by.z), 30), coarse(sum2(v.x, by.z, v.z, by.x), 30)};
}

INLINE fixed_vec_t fixed_turned_back(fixed_vec_t v, fixed_vec_t by)
{
    return (fixed_vec_t){coarse(sum2(v.x, by.x, v.z, by.z), 30), coarse(sum2(v.z, by.x, -v.x, by.z), 30)};
}

/* The direction of an angle in turns. */
INLINE fixed_vec_t fixed_direction(uint32_t angle_turn)
{
    const brace_sincos_t at = direction_of(angle_turn);
    return (fixed_vec_t){at.cos_q31 >> 1, at.sin_q31 >> 1};
}

INLINE fixed_vec_t fixed_turn_by(int32_t angle_q29)
{
    return fixed_direction(brace_turn_from_q28(angle_q29 >> 1));
}

/* As brace_small_turn of base/trig.h. */
INLINE fixed_vec_t fixed_small_turn(int32_t angle_q29)
{
    const int32_t x_q30 = 2 * angle_q29, u_q30 = coarse_times(x_q30, x_q30, 30);
    const int32_t sine = coarse_times(Q31(8.32e-3), u_q30, 30) - Q31(1.66666e-1);
    const int32_t cosine = coarse_times(Q31(4.14288e-2), u_q30, 30) - Q31(0.499991);
    return (fixed_vec_t){(1 << 30) + coarse_times(cosine, u_q30, 31),
                         x_q30 + coarse_times(coarse_times(sine, u_q30, 31), x_q30, 30)};
}

/* --- from and to IEEE floats ---------------------------------------------------------------------------------- */

/* A float below 2^31/2^format as an integer, truncated. Its magnitude has to be finite. */
INLINE int32_t fixed_of(uint32_t bits, int32_t format)
{
    const int32_t right = 157 - (int32_t)((bits >> 23) & 255u) - format, sign = (int32_t)bits >> 31;
    const uint32_t half_mantissa = ((bits << 7) & 0x3fffffffu) | 0x40000000u;
    return (int32_t)(half_mantissa >> (right > 31 ? 31 : right)) * (1 | sign);
}

/* Least power of two above a magnitude that is a normal number: its exponent. */
INLINE int32_t exponent_above(uint32_t bits)
{
    return (int32_t)((bits >> 23) & 255u) - 126;
}

/* number 2^-format as a float, without a branch. */
INLINE float float_from(int32_t number, int32_t format)
{
    const uint32_t is_none = (uint32_t)(number == 0);
    const uint32_t bits = float_bits(magnitude_of(number) | 1u, (uint32_t)(157 - format) << 23) | sign_of(number);
    return float_of(bits & (is_none - 1u));
}

#endif
