#include "trig.h"

#include "turn.h"

#define TAN_PI_8 0.414213562f
#define TAN_3_PI_8 2.41421356f

uint32_t brace_turn(float angle_rad)
{
    return brace_turn_from_q28((int32_t)(angle_rad * 0x1p28f));
}

brace_vec_t brace_direction(uint32_t turn)
{
    const brace_sincos_t at = brace_turn_sincos(turn);
    return (brace_vec_t){(float)at.cos * (1.0f / BRACE_TURN_ONE), (float)at.sin * (1.0f / BRACE_TURN_ONE)};
}

/* The angle of (|x|, |y|) from whichever of +x, the diagonal and +y is nearest, then mirrored. */
float brace_atan2(float y, float x)
{
    const float up = __builtin_fabsf(y);
    float along = __builtin_fabsf(x);
    float across = up;
    float angle = 0.0f;
    if (up > TAN_3_PI_8 * along) {
        across = -along;
        along = up;
        angle = BRACE_HALF_PI;
    } else if (up > TAN_PI_8 * along) {
        across = up - along;
        along = up + along;
        angle = 0.5f * BRACE_HALF_PI;
    }
    if (!(along > 0.0f)) {
        return 0.0f;
    }
    const float slope = across / along;
    const float square = slope * slope;
    /* minimax, error 5e-9 on [-tan(pi/8), tan(pi/8)] */
    angle += (((7.90006518e-2f * square - 0.138236642f) * square + 0.199718043f) * square - 0.333327532f) *
                 (square * slope) +
             slope;
    if (x < 0.0f) {
        angle = BRACE_PI - angle;
    }
    return y < 0.0f ? -angle : angle;
}
