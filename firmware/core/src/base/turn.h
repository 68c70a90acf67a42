/* Angles as 32-bit fractions of a turn (2^32 = 2 pi, so they wrap by themselves) and their sine and cosine.
 *
 * One table of a turn and a quarter of sines, and an angle addition: absolute error 6e-9. Plain integer C: the same bits on every machine.
 */
#ifndef BRACE_TURN_H
#define BRACE_TURN_H

#include <stdint.h>

/* Full scale of sine and cosine: a little under 2^31, so that no rounding can carry +1 over the edge. */
#define BRACE_TURN_ONE 2147481600.0f

/* 32 entries are a turn; a quarter more, so that the cosine lies a fixed way behind the sine. */
enum { BRACE_SINE_TABLE_SIZE = 32, BRACE_SINE_QUARTER = 8 };

typedef struct {
    int32_t sin, cos; /* times BRACE_TURN_ONE */
} brace_sincos_t;

extern const int32_t brace_sine_table[BRACE_SINE_TABLE_SIZE + BRACE_SINE_QUARTER];

/* High word of the product: one instruction (smmul) where the core has it. */
static inline int32_t brace_mulh(int32_t a, int32_t b)
{
    return (int32_t)(((int64_t)a * b) >> 32);
}

/* Fraction of a turn from radians in q28, |theta| < 8. 16 * 2^32 / (2 pi) = 3 * 2^32 - 1947857479. */
static inline uint32_t brace_turn_from_q28(int32_t theta_rad_q28)
{
    return (uint32_t)(3 * (uint32_t)theta_rad_q28 + (uint32_t)brace_mulh(theta_rad_q28, -1947857479));
}

/* Sine and cosine. The remainder d from the nearest table entry is within pi/32: with e = d^2,
 * sin d = d - d e / 6 and 1 - cos d = e/2 - e^2/24 (minimax), in words scaled so that every product is a high word. */
static inline brace_sincos_t brace_turn_sincos(uint32_t turn)
{
    const int32_t *entry = brace_sine_table + ((turn + 0x04000000u) >> 27);
    const int32_t sin = entry[0], cos = entry[BRACE_SINE_QUARTER];
    const int32_t d = (int32_t)(turn << 5);                                    /* 2^31 = pi/32 */
    const int32_t e = brace_mulh(d, d);                                        /* 2^30 = (pi/32)^2 */
    const int32_t sin_d = brace_mulh(d, 843314653 + brace_mulh(e, -5415477));  /* q32 */
    const int32_t versin_d = brace_mulh(e, 82792233 + brace_mulh(e, -265873)); /* q32 */
    const brace_sincos_t at = {sin + brace_mulh(cos, sin_d) - brace_mulh(sin, versin_d),
                               cos - brace_mulh(sin, sin_d) - brace_mulh(cos, versin_d)};
    return at;
}

#endif
