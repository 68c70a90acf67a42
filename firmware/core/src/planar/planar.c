#include "brace/planar.h"

#include <float.h>
#include <math.h>

#include "base/check.h"
#include "base/trig.h"

static inline float harmonic(const brace_harmonic_t *h, float cos2, float sincos)
{
    return brace_fma(h->per_cos2, cos2, brace_fma(h->per_sincos, sincos, h->at_fold));
}

brace_status_t brace_planar_stiffness(const brace_planar_t *planar, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness)
{
    const float reach = brace_fma(theta1_rad, theta1_rad, theta2_rad * theta2_rad);
    if (brace_bits(reach) > brace_bits(BRACE_REACH_RAD2)) { /* NaN, too */
        return brace_refusal_of(reach, 0.0f);
    }

    /* Half the knee angle, and the bisector's angle in the world, each without its whole half turns. A half turn of
     * either changes the sign of every vector in C, and so leaves C as it is. */
    const float half_rad = 0.5f * theta2_rad;
    const float h = brace_less_half_turns(half_rad, brace_half_turns(half_rad));
    const float sin_h = brace_sine(h), cos_h = brace_cosine(h);
    const float cos2 = cos_h * cos_h, sincos = sin_h * cos_h;

    const float bisector_half_turns = brace_half_turns(theta1_rad - half_rad);
    const float bisector = brace_less_half_turns(theta1_rad, bisector_half_turns) - half_rad;
    const float sin_b = brace_sine(bisector), cos_b = brace_cosine_coarse(bisector);
    const float sin_2b = 2.0f * sin_b * cos_b, cos_2b = (cos_b - sin_b) * (cos_b + sin_b);

    /* C in the bisector's frame. */
    const float mean = harmonic(&planar->mean, cos2, sincos);
    const float x = harmonic(&planar->dev_x, cos2, sincos);
    const float z = harmonic(&planar->dev_z, cos2, sincos);
    const float zeros = brace_fma(-planar->zero_tan, cos_h, sin_h) * brace_fma(-planar->zero_cot, sin_h, cos_h);
    const float cross = brace_fma(planar->cross_factor, zeros, planar->cross_least);
    const float det = brace_fma(cross, cross, brace_fma(planar->rest_per_mean, mean, planar->rest_constant));

    /* Its deviator in the world's frame. */
    const float dev_x = brace_fma(x, cos_2b, -(z * sin_2b));
    const float dev_z = brace_fma(x, sin_2b, z * cos_2b);
    const float radius = sqrtf(brace_fma(x, x, brace_fma(z, z, FLT_MIN)));

    const float longest = mean + radius;
    const float inverse = 1.0f / (det * longest);
    const float per_det = inverse * longest;
    stiffness->lambda_min_n_per_mm = inverse * det;
    stiffness->lambda_max_n_per_mm = per_det * longest;
    stiffness->k_xx_n_per_mm = (mean - dev_x) * per_det;
    stiffness->k_xz_n_per_mm = -dev_z * per_det;
    stiffness->k_zz_n_per_mm = (mean + dev_x) * per_det;

    stiffness->stiff_axis_rad = brace_half_angle_of_opposite(dev_x, dev_z, radius);
    stiffness->flags = 0;
    return BRACE_OK;
}
