#include "chain/tensor.h"

#include "base/trig.h"

void brace_posture(float theta1_rad, float theta2_rad, brace_posture_t *at)
{
    const uint32_t half_turn = brace_turn(theta2_rad) / 2u;
    at->half = brace_direction(half_turn);
    at->bisector = brace_direction(brace_turn(theta1_rad) - half_turn);
}
