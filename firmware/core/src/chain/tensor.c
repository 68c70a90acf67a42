#include "chain/tensor.h"

#include "base/off_tick.h"
#include "base/trig.h"

void brace_posture(float theta1_rad, float theta2_rad, brace_posture_t *at)
{
    const uint32_t half_turn = brace_turn(theta2_rad) / 2u;
    at->half = brace_direction(half_turn);
    at->bisector = brace_direction(brace_turn(theta1_rad) - half_turn);
}

BRACE_OFF_TICK void brace_stiffness_of_circle(float dev_z, float dev_x, float mean, brace_stiffness_t *stiffness)
{
    const float radius = brace_length(dev_x, dev_z);
    stiffness->k_xx_n_per_mm = mean + dev_x;
    stiffness->k_xz_n_per_mm = dev_z;
    stiffness->k_zz_n_per_mm = mean - dev_x;
    stiffness->lambda_min_n_per_mm = mean - radius;
    stiffness->lambda_max_n_per_mm = mean + radius;
    stiffness->stiff_axis_rad = 0.5f * brace_atan2(dev_z, dev_x);
}
