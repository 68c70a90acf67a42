#include "chain/tensor.h"

#include "base/trig.h"

/* det C over mean^2 below which C counts as singular, and below which its accuracy is not promised. */
#define SINGULAR 1e-12f
#define SLENDER 2e-5f

void brace_posture(float theta1_rad, float theta2_rad, brace_posture_t *at)
{
    const uint32_t half_turn = brace_turn(0.5f * theta2_rad);
    at->half = brace_direction(half_turn);
    at->bisector = brace_direction(brace_turn(theta1_rad) - half_turn);
}

brace_status_t brace_tensor_inverse(brace_tensor_t c, brace_vec_t to_world, brace_stiffness_t *stiffness)
{
    const brace_circle_t circle = brace_circle_in_world(c, to_world);
    const float det = c.det, mean = circle.mean, square = mean * mean;
    if (!(det > SINGULAR * square)) {
        return BRACE_E_SINGULAR;
    }
    const float longest = mean + brace_sqrt(vec_dot(circle.dev, circle.dev));
    const float per_det = 1.0f / det;
    stiffness->flags = det < SLENDER * square ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    stiffness->k_xx_n_per_mm = (mean - circle.dev.x) * per_det;
    stiffness->k_xz_n_per_mm = -circle.dev.z * per_det;
    stiffness->k_zz_n_per_mm = (mean + circle.dev.x) * per_det;
    stiffness->lambda_min_n_per_mm = 1.0f / longest;
    stiffness->lambda_max_n_per_mm = longest * per_det;
    stiffness->stiff_axis_rad = 0.5f * brace_atan2(-circle.dev.z, -circle.dev.x);
    return BRACE_OK;
}
