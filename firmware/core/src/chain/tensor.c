#include "chain/tensor.h"

#include "base/trig.h"
#include "base/vec.h"

/* det C over mean^2 below which C counts as singular, and below which its accuracy is not promised. */
#define SINGULAR 1e-12f
#define SLENDER 2e-5f

void brace_posture(float theta1_rad, float theta2_rad, brace_posture_t *at)
{
    const uint32_t half_turn = brace_turn(0.5f * theta2_rad);
    at->half = brace_direction(half_turn);
    at->bisector = brace_direction(brace_turn(theta1_rad) - half_turn);
}

static inline float harmonic(const brace_harmonic_t *h, float one_plus_cos, float sin)
{
    return __builtin_fmaf(h->per_cos, one_plus_cos, __builtin_fmaf(h->per_sin, sin, h->at_fold));
}

brace_tensor_t brace_harmonics_at(const brace_harmonics_t *h, brace_vec_t half)
{
    const float one_plus_cos = 2.0f * half.x * half.x, sin = 2.0f * half.x * half.z;
    const float mean = harmonic(&h->mean, one_plus_cos, sin), cross = harmonic(&h->cross, one_plus_cos, sin);
    const float dev_x = harmonic(&h->dev_x, one_plus_cos, sin);
    return (brace_tensor_t){mean + dev_x, harmonic(&h->dev_y, one_plus_cos, sin), mean - dev_x,
                            __builtin_fmaf(cross, cross, harmonic(&h->rest, one_plus_cos, sin))};
}

brace_tensor_t brace_tensor_plus(brace_tensor_t c, brace_vec_t v)
{
    const brace_vec_t adj_v = {__builtin_fmaf(c.zz, v.x, -(c.xz * v.z)),
                               __builtin_fmaf(c.xx, v.z, -(c.xz * v.x))};
    const float forms = __builtin_fmaf(c.det, vec_dot(v, v), vec_dot(adj_v, adj_v));
    return (brace_tensor_t){__builtin_fmaf(v.x, v.x, c.xx), __builtin_fmaf(v.x, v.z, c.xz),
                            __builtin_fmaf(v.z, v.z, c.zz), c.det + forms / (c.xx + c.zz)};
}

brace_tensor_t brace_tensor_to_world(brace_tensor_t c, brace_vec_t bisector)
{
    const brace_vec_t twice = {__builtin_fmaf(-2.0f * bisector.z, bisector.z, 1.0f),
                               2.0f * bisector.z * bisector.x};
    const float mean = 0.5f * (c.xx + c.zz);
    const brace_vec_t dev = brace_turned((brace_vec_t){0.5f * (c.xx - c.zz), c.xz}, twice);
    return (brace_tensor_t){mean + dev.x, dev.z, mean - dev.x, c.det};
}

brace_status_t brace_tensor_inverse(brace_tensor_t c, brace_stiffness_t *stiffness)
{
    const float mean = 0.5f * (c.xx + c.zz), dev_x = 0.5f * (c.zz - c.xx), square = mean * mean;
    if (!(c.det > SINGULAR * square)) {
        return BRACE_E_SINGULAR;
    }
    const float longest = mean + brace_length(dev_x, c.xz);
    const float per_det = 1.0f / c.det;
    *stiffness = (brace_stiffness_t){
        .k_xx_n_per_mm = c.zz * per_det,
        .k_xz_n_per_mm = -c.xz * per_det,
        .k_zz_n_per_mm = c.xx * per_det,
        .lambda_min_n_per_mm = 1.0f / longest,
        .lambda_max_n_per_mm = longest * per_det,
        .stiff_axis_rad = 0.5f * brace_atan2(-c.xz, dev_x),
        .flags = c.det < SLENDER * square ? BRACE_FLAG_NEAR_SINGULAR : 0u,
    };
    return BRACE_OK;
}
