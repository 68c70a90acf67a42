#include "base/trig.h"

#include <float.h>

#include "base/off_tick.h"
#include "base/turn.h"

/* About the tangent of pi/8: the slope stays within 27/64. */
#define NEAR 0.421875f

uint32_t brace_turn(float angle_rad)
{
    return brace_turn_from_q28((int32_t)(angle_rad * 0x1p28f));
}

float _Complex brace_unit(uint32_t turn)
{
    const brace_sum_sincos_t at = brace_turn_sincos(turn);
    /* One of them doubled, because GCC converts from fixed point for nothing only where it meets a scale once. */
    const int32_t cos = BRACE_HIGH(at.cos), twice_sin = (int32_t)((uint32_t)BRACE_HIGH(at.sin) << 1);
    return __builtin_complex((float)cos * 0x1p-30f, (float)twice_sin * 0x1p-31f);
}

/* The angle of (|x|, |y|): turned back by pi/4 as often as it takes to come near +x, then mirrored. */
BRACE_OFF_TICK
float brace_atan2(float y, float x)
{
    float across = __builtin_fabsf(y), along = __builtin_fabsf(x), angle = 0.0f;
    while (across > NEAR * along) { /* at most twice */
        const float less = across - along;
        along += across;
        across = less;
        angle += 0.5f * BRACE_HALF_PI;
    }
    const float slope = across / (along + FLT_MIN);
    const float square = slope * slope;
    /* minimax, error 6e-9 on [-27/64, 27/64] */
    angle += (((7.80888081e-2f * square - 0.13794738f) * square + 0.19969f) * square - 0.33332675f) *
                 (square * slope) +
             slope;
    if (x < 0.0f) {
        angle = BRACE_PI - angle;
    }
    return y < 0.0f ? -angle : angle;
}
