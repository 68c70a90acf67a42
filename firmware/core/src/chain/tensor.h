/* From C at a posture to K. */
#ifndef BRACE_CHAIN_TENSOR_H
#define BRACE_CHAIN_TENSOR_H

#include "brace/chain.h"
#include "base/trig.h"

/* det C over mean^2 below which C counts as singular, and below which its accuracy is not promised. */
#define BRACE_SINGULAR 1e-12f
#define BRACE_SLENDER 2e-5f

/* C at a posture: half its trace, its deviator, its determinant. */
typedef struct {
    float mean, dev_x, dev_y, det;
} brace_tensor_t;

static inline brace_vec_t brace_turned(brace_vec_t v, brace_vec_t by)
{
    return (brace_vec_t){__builtin_fmaf(v.x, by.x, -(v.z * by.z)), __builtin_fmaf(v.x, by.z, v.z * by.x)};
}

/* BRACE_OK or BRACE_E_SINGULAR: then stiffness is untouched. */
static inline brace_status_t brace_tensor_inverse(brace_tensor_t c, brace_stiffness_t *stiffness)
{
    const float square = c.mean * c.mean;
    if (!(c.det > BRACE_SINGULAR * square)) {
        return BRACE_E_SINGULAR;
    }
    const float radius = __builtin_sqrtf(__builtin_fmaf(c.dev_x, c.dev_x, c.dev_y * c.dev_y));
    const float per_det = 1.0f / c.det;
    *stiffness = (brace_stiffness_t){
        .k_xx_n_per_mm = (c.mean - c.dev_x) * per_det,
        .k_xz_n_per_mm = -c.dev_y * per_det,
        .k_zz_n_per_mm = (c.mean + c.dev_x) * per_det,
        .lambda_min_n_per_mm = 1.0f / (c.mean + radius),
        .lambda_max_n_per_mm = (c.mean + radius) * per_det,
        .stiff_axis_rad = 0.5f * brace_atan2(-c.dev_y, -c.dev_x),
        .flags = c.det < BRACE_SLENDER * square ? BRACE_FLAG_NEAR_SINGULAR : 0u,
    };
    return BRACE_OK;
}

#endif
