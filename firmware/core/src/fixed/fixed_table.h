/* Tables and constants of the fixed-point K. */
#ifndef BRACE_FIXED_TABLE_H
#define BRACE_FIXED_TABLE_H

#include <stdint.h>

/* Full scale of sine and cosine: a little under 2^31, so that rounding cannot carry +1 past the largest int32. */
#define BRACE_FIXED_ONE 2147481600

typedef struct {
    int32_t sin_q31, cos_q31; /* as fractions of BRACE_FIXED_ONE */
} brace_sincos_t;

/* With u = d/(pi/64), |u| <= 1: sin d = u (s1 - s3 u^2) within 2e-10; cos d - 1 = u^2 (c2 + c4 u^2) within
 * 1e-12, or c2_alone u^2 within 4.2e-8. */
enum {
    SIN_D1 = 421657422,       /* s1 q33 */
    SIN_D3 = -677240,         /* -s3 q35 */
    COS_D2 = -20698061,       /* c2 q34 */
    COS_D4 = 16623,           /* c4 q36 */
    COS_D2_ALONE = -20694699, /* q34 */
    LENGTHEN = 3840           /* 2^31 / BRACE_FIXED_ONE - 1, q32, minus what rounding could carry over 1 */
};

/* asin(s) = a1 s + a3 s^3 within 6.5e-8 for |s| <= 0.107, in turns, negated. */
enum { ASIN_1 = -683563198, ASIN_3 = -114659455 };

/* The 3 of Newton's step for 1/sqrt, a little less so that no component of a unit vector reaches 1. q26 */
#define RSQRT_THREE_Q26 201326590u

#define PI_Q30 3373259426u

/* Half a turn in 2^32, times pi in q30: the exponent field that float_bits gets for the axis. */
#define AXIS_EXPONENT ((157u - 30u) << 23)

/* A turn in 64 steps, times BRACE_FIXED_ONE. */
extern const brace_sincos_t brace_fixed_sincos[64];

/* First guess of 1/sqrt(z) for z in [i/64, (i + 1)/64): at - slope u, with u in [0, 1) across the cell. */
typedef struct {
    uint16_t at_q13, slope_q13;
} brace_fixed_seed_t;

extern const brace_fixed_seed_t brace_fixed_seed[64];

/* Direction of a unit vector (-c, s), in 64ths of a turn and turned by half a turn. The four highest bits of s and of c
 * (two's complement) choose the cell of a 16 by 16 grid. Each entry is right within 0.107 rad. */
extern const uint8_t brace_fixed_cell[16][16];

#endif
