/* Sine and cosine of an angle in turns, from a table of 64 entries and an angle sum. */
#ifndef BRACE_CORE_FIXED_SINCOS_H
#define BRACE_CORE_FIXED_SINCOS_H

#include "fixed/fixed_table.h"
#include "fixed/fixed_word.h"

/* The entry of the sine table nearest to an angle: 64 entries to the turn. */
static inline brace_sincos_t nearest(uint32_t angle_turn)
{
    return brace_fixed_sincos[(angle_turn + 0x02000000u) >> 26];
}

/* The angle minus that of the nearest entry; 2^31 stands for half an entry, pi/64. */
static inline int32_t off_nearest(uint32_t angle_turn)
{
    return (int32_t)(angle_turn << 6);
}

/* Sine and cosine of an entry's angle plus d, by the angle sums. cos_d_less_1_q32: the cosine of d, minus one. */
static inline brace_sincos_t add_angle(brace_sincos_t near, int32_t d, int32_t d2, int32_t cos_d_less_1_q32)
{
    const int32_t sin_d_q32 = high(d, SIN_D1 + high(d2, SIN_D3));
    return (brace_sincos_t){near.sin_q31 + high_sum(near.sin_q31, cos_d_less_1_q32, near.cos_q31, sin_d_q32),
                            near.cos_q31 + high_sum(near.cos_q31, cos_d_less_1_q32, near.sin_q31, -sin_d_q32)};
}

/* Sine and cosine within 1e-9. */
static inline brace_sincos_t sincos_of(uint32_t angle_turn)
{
    const int32_t d = off_nearest(angle_turn), d2 = high(d, d);
    return add_angle(nearest(angle_turn), d, d2, high(d2, COS_D2 + high(d2, COS_D4)));
}

/* Sine and cosine for turning a vector, two instructions shorter. The direction is right within 1e-9. The length is one
 * (2^31, not BRACE_FIXED_ONE) within 1.1e-7 and never more, so that the turned vector fits into its word. */
static inline brace_sincos_t direction_of(uint32_t angle_turn)
{
    const int32_t d = off_nearest(angle_turn), d2 = high(d, d);
    return add_angle(nearest(angle_turn), d, d2, high(d2, COS_D2_ALONE) + LENGTHEN);
}

#endif
