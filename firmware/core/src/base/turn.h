/* Angles as 32-bit fractions of a turn (2^32 = 2 pi, so they wrap by themselves) and their sine and cosine.
 *
 * One table of 64 {sine, cosine} pairs and an angle addition: absolute error 2e-9, 14 instructions with the
 * multiply-high of ARMv7E-M. Plain integer C: the same bits on every machine.
 */
#ifndef BRACE_TURN_H
#define BRACE_TURN_H

#include <stdint.h>



/* Full scale of sine and cosine: a little under 2^31, so that no rounding can carry +1 over the edge. */
#define BRACE_TURN_ONE 2147481600.0f

enum { BRACE_TURN_TABLE_SIZE = 64 };

typedef struct {
    int32_t sin, cos; /* times BRACE_TURN_ONE */
} brace_sincos_t;

extern const brace_sincos_t brace_turn_table[BRACE_TURN_TABLE_SIZE];

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

/* Sine and cosine. The remainder d from the nearest table entry is within pi/64: with e = d^2,
 * sin d = d - d e / 6 and 1 - cos d = e/2 - e^2/24, in words scaled so that every product is a high word. */
static inline brace_sincos_t brace_turn_sincos(uint32_t turn)
{
    const brace_sincos_t near = brace_turn_table[(turn + 0x02000000u) >> 26];
    const int32_t d = (int32_t)(turn << 6);                                            /* 2^31 = pi/64 */
    const int32_t e = brace_mulh(d, d);                                                /* 2^30 = (pi/64)^2 */
    const int32_t sin_d = brace_mulh(d, 421657428 + brace_mulh(e, -677342));           /* q32 */
    const int32_t versin_d = brace_mulh(e, 20698061 + brace_mulh(e, -16624));          /* q32 */
    const brace_sincos_t at = {near.sin + brace_mulh(near.cos, sin_d) - brace_mulh(near.sin, versin_d),
                               near.cos - brace_mulh(near.sin, sin_d) - brace_mulh(near.cos, versin_d)};
    return at;
}

#endif
