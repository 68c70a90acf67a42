#include "trig.h"

#include "turn.h"

uint32_t brace_turn(float angle_rad)
{
    return brace_turn_from_q28((int32_t)(angle_rad * 0x1p28f));
}

brace_vec_t brace_direction(uint32_t turn)
{
    const brace_sincos_t at = brace_turn_sincos(turn);
    return (brace_vec_t){(float)at.cos * (1.0f / BRACE_TURN_ONE), (float)at.sin * (1.0f / BRACE_TURN_ONE)};
}

float brace_atan2(float y, float x)
{
    const float across = __builtin_fabsf(y);
    const float along = __builtin_fabsf(x);
    const float larger = across > along ? across : along;
    const float smaller = across > along ? along : across;
    if (!(larger > 0.0f)) {
        return 0.0f;
    }
    /* Above tan(pi/8) the angle is measured from the diagonal. */
    const int from_diagonal = smaller > 0.414213562f * larger;
    const float slope = from_diagonal ? (smaller - larger) / (smaller + larger) : smaller / larger;
    const float square = slope * slope;
    /* minimax, error 5e-9 on [-tan(pi/8), tan(pi/8)] */
    float angle =
        (((7.90006518e-2f * square - 0.138236642f) * square + 0.199718043f) * square - 0.333327532f) *
            (square * slope) +
        slope;
    if (from_diagonal) {
        angle += 0.785398163f;
    }
    if (across > along) {
        angle = BRACE_HALF_PI - angle;
    }
    if (x < 0.0f) {
        angle = BRACE_PI - angle;
    }
    return y < 0.0f ? -angle : angle;
}
