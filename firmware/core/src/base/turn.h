/* Angles as 32-bit fractions of a turn (2^32 = 2 pi, so they wrap by themselves) and their sine and cosine.
 *
 * One table of a turn and a quarter of sines, and an angle addition. Plain integer C: the same bits on every machine.
 */
#ifndef BRACE_TURN_H
#define BRACE_TURN_H

#include <stdint.h>

/* 32 entries are a turn; a quarter more, so that the cosine lies a fixed way behind the sine. Of the sine, 0x7fffffff is
 * one. */
enum { BRACE_SINE_TABLE_SIZE = 32, BRACE_SINE_QUARTER = 8 };

extern const int32_t brace_sine_table[BRACE_SINE_TABLE_SIZE + BRACE_SINE_QUARTER];

/* A 64-bit product, which GCC adds to a sum in one instruction (smlal), and the high word of either (smmul). */
#define BRACE_PRODUCT(a, b) ((int64_t)(int32_t)(a) * (int32_t)(b))
#define BRACE_HIGH(sum) ((int32_t)(uint32_t)((uint64_t)(sum) >> 32))

/* Sums of such products: only their high words count, where 2^30 is one. */
typedef struct {
    int64_t sin, cos;
} brace_sum_sincos_t;

static inline int32_t brace_mulh(int32_t a, int32_t b)
{
    return BRACE_HIGH(BRACE_PRODUCT(a, b));
}

/* Fraction of a turn from radians in q28, |theta| < 8. 16 * 2^32 / (2 pi) = 3 * 2^32 - 1947857479. */
static inline uint32_t brace_turn_from_q28(int32_t theta_rad_q28)
{
    return (uint32_t)(3 * (uint32_t)theta_rad_q28 + (uint32_t)brace_mulh(theta_rad_q28, -1947857479));
}

/* Sine and minus cosine of what lies off a table entry, q31. */
typedef struct {
    int32_t sin, minus_cos;
} brace_off_entry_t;

/* Of d q31, where 1 is half an entry, pi/32. With e = d^2 q30, sin d = d (421657315 - 2707609 e) q31;
 * 1 - cos d = sin^2 d/2 + sin^4 d/8, error 6e-8 at half an entry, falling with the sixth power of d: nearly all of it is
 * length, the direction is right within 6e-9. Straight-line code, in an order of operations that GCC turns into few
 * instructions. */
static inline brace_off_entry_t brace_off_entry(int32_t d)
{
    const int32_t e = brace_mulh(d, d);
    const int32_t sin = brace_mulh(d, 421657315 - brace_mulh(e, 2707609));
    const int32_t half_square = brace_mulh(sin, sin); /* q31 */
    const uint32_t less_one = (uint32_t)half_square - 0x80000000u;
    return (brace_off_entry_t){sin, (int32_t)(less_one + (uint32_t)brace_mulh(half_square, half_square))};
}

/* Minus sine and minus cosine of the sum of an entry's angle and that off it. */
static inline brace_sum_sincos_t brace_opposite(int32_t sin, int32_t cos, brace_off_entry_t off)
{
    return (brace_sum_sincos_t){BRACE_PRODUCT(sin, off.minus_cos) + BRACE_PRODUCT(cos, -off.sin),
                                BRACE_PRODUCT(cos, off.minus_cos) + BRACE_PRODUCT(sin, off.sin)};
}

/* The entry half a turn from the one nearest: what is opposite to that is nearest. */
static inline const int32_t *brace_opposite_entry(uint32_t turn)
{
    return brace_sine_table + ((turn + 0x84000000u) >> 27);
}

/* Sine and cosine, error 7e-9: what the tick leaves out, sin^6 d/16, is in. */
static inline brace_sum_sincos_t brace_turn_sincos(uint32_t turn)
{
    const int32_t *entry = brace_opposite_entry(turn);
    brace_off_entry_t off = brace_off_entry((int32_t)(turn << 5));
    const int32_t half_square = brace_mulh(off.sin, off.sin);
    const int32_t sixth = brace_mulh(half_square, brace_mulh(half_square, half_square)); /* q30 */
    off.minus_cos = (int32_t)((uint32_t)off.minus_cos + 2u * (uint32_t)sixth);
    return brace_opposite(entry[0], entry[BRACE_SINE_QUARTER], off);
}

#endif
