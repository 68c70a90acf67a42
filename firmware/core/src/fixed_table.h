/* Tables and constants of the fixed-point K. */
#ifndef BRACE_FIXED_TABLE_H
#define BRACE_FIXED_TABLE_H

#include <stdint.h>

/* With u = d/(pi/64), |u| <= 1: sin d = u (s1 - s3 u^2) within 2e-10, cos d = 1 - c2 u^2 within 4.2e-8 (of the
 * sum's length: it turns no angle). */
enum {
    SIN_D1 = 210828711, /* s1 q32 */
    SIN_D3 = 338620,    /* s3 q34 */
    COS_D0 = 2147483647, /* 1 q31 */
    COS_D2 = 10347349   /* c2 q33 */
};

/* asin(s) = a1 s + a3 s^3 within 6.5e-8 for |s| <= 0.107, in turns, negated. */
enum { ASIN_1 = -683563198, ASIN_3 = 114659455 };

/* 1/sqrt: Newton's 3, less what makes the root smaller by BRACE_TURN_ONE/2^31. q26 */
#define RSQRT_THREE 201326464u

#define PI_Q30 3373259426u

/* Half a turn in 2^32, times pi in q30: the exponent field of float_bits for the axis. */
#define AXIS_EXPONENT ((157u - 30u) << 23)

/* First guess of 1/sqrt(z), z in [i/64, (i + 1)/64): (at - slope u)/2^13, u in [0, 1) across the cell. */
typedef struct {
    uint16_t at, slope;
} brace_fixed_seed_t;

extern const brace_fixed_seed_t brace_fixed_seed[64];

/* Where a unit vector (-c, s) points, in 64ths of a turn and turned by half a turn: the four highest bits of s and
 * of c (two's complement) give the cell of a 16 by 16 grid. Within 0.107 rad of what the cell holds. */
extern const uint8_t brace_fixed_cell[256];

#endif
