#include "base/trig.h"

#include "base/off_tick.h"
#include "base/turn.h"

/* Where the nearest axis changes: about the tangents of pi/8 and 3 pi/8, so the slope stays within 27/64. */
#define LOW 0.421875f
#define HIGH 2.375f

uint32_t brace_turn(float angle_rad)
{
    return brace_turn_from_q28((int32_t)(angle_rad * 0x1p28f));
}

float _Complex brace_unit(uint32_t turn)
{
    const brace_sincos_t at = brace_turn_sincos(turn);
    return __builtin_complex((float)at.cos * (1.0f / BRACE_TURN_ONE), (float)at.sin * (1.0f / BRACE_TURN_ONE));
}

/* The angle of (|x|, |y|) from whichever of +x, the diagonal and +y is nearest, then mirrored. */
BRACE_OFF_TICK
float brace_atan2(float y, float x)
{
    const float up = __builtin_fabsf(y);
    float along = __builtin_fabsf(x);
    float across = up;
    float angle = 0.0f;
    if (up > HIGH * along) {
        across = -along;
        along = up;
        angle = BRACE_HALF_PI;
    } else if (up > LOW * along) {
        across = up - along;
        along = up + along;
        angle = 0.5f * BRACE_HALF_PI;
    }
    if (!(along > 0.0f)) {
        return 0.0f;
    }
    const float slope = across / along;
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
