#include "brace/planar_batch.h"

#include <math.h>

#include "base/exact.h"

/* The compiler may fuse products and sums here: the loops are written with * and + instead of fmaf(), which would be
 * a call on processors without that instruction. On a host they are compiled for several generations of the
 * processor, and the best is taken at run time. Sanitizers run before such a choice can be made. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "fp-contract=fast", "no-trapping-math")
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
#endif
#ifndef FOR_EACH_PROCESSOR
#define FOR_EACH_PROCESSOR
#endif

/* Each processor's version needs its own copy of the functions it calls. */
#define INLINE static inline __attribute__((always_inline))

/* pi in two floats. The first has so few digits that its small multiples are exact without a fused product. */
#define PI_SHORT 3.140625f
#define PI_REST 9.67653589793e-4f
#define PER_PI 0.318309886f
#define HALF_PI 1.57079633f
#define HALF_PI_REST -4.37113883e-8f

/* Adding 1.5 * 2^23 to a small float and taking it away again rounds the float to an integer. */
#define TO_INTEGER 12582912.0f

/* The angle minus the nearest multiple of pi. */
INLINE float less_half_turns(float angle_rad)
{
    const float count = angle_rad * PER_PI + TO_INTEGER - TO_INTEGER;
    return (angle_rad - count * PI_SHORT) - count * PI_REST;
}

/* The polynomials of base/trig.h. */

/* sin x for |x| <= pi/2, within 6e-9 of the result. */
INLINE float sine(float x)
{
    const float u = x * x;
    const float series = -1.66666596e-1f + u * (8.33306625e-3f + u * (-1.98096029e-4f + u * 2.60578056e-6f));
    return x + (x * u) * series;
}

/* cos x for |x| <= pi/2, right to the last digits also near its zeros. */
INLINE float cosine(float x)
{
    return sine((HALF_PI - fabsf(x)) + HALF_PI_REST);
}

/* cos x for |x| <= pi/2, within 1.1e-7. */
INLINE float cosine_coarse(float x)
{
    const float u = x * x;
    return 1.0f + u * (-0.499999323f + u * (4.16639895e-2f + u * (-1.38559271e-3f + u * 2.31943856e-5f)));
}

/* atan(t)/t for |t| <= 1, within 2.6e-7. */
INLINE float arctangent(float t)
{
    const float u = t * t;
    const float high = -0.13233341f + u * (0.07962366f + u * (-0.03360421f + u * 0.00681179f));
    return t * (0.99999611f + u * (-0.33317368f + u * (0.19807815f + u * high)));
}

INLINE float harmonic(const brace_harmonic_t *h, float cos2, float sincos)
{
    return h->at_fold + h->per_cos2 * cos2 + h->per_sincos * sincos;
}

INLINE int usable(float angle_rad)
{
    return fabsf(angle_rad) <= BRACE_ANGLE_LIMIT_RAD;
}

/* The work goes through the first-level cache in blocks, in three loops. In a single loop each posture's chain of
 * operations would be so long that the processor could work on too few postures at a time. */
enum { BLOCK = 256 };

typedef struct {
    float cos2[BLOCK], sincos[BLOCK], cross[BLOCK]; /* of half the knee angle */
    float sin_2b[BLOCK], cos_2b[BLOCK];             /* of twice the bisector's angle */
    float dev_x[BLOCK], tangent[BLOCK];             /* tangent: of half of dev's angle from the x axis */
} block_t;

/* Returns how many postures are out of range or NaN. Their angles become NaN, and so do their results. */
INLINE size_t take_angles(const brace_planar_t *p, int n, const float *restrict theta1_rad,
                          const float *restrict theta2_rad, block_t *restrict block)
{
    int refused = 0;
    for (int i = 0; i < n; i++) {
        const int good = usable(theta1_rad[i]) & usable(theta2_rad[i]);
        refused += !good;
        const float half_knee = good ? 0.5f * theta2_rad[i] : __builtin_nanf("");
        const float h = less_half_turns(half_knee);
        const float sin_h = sine(h), cos_h = cosine(h);
        block->cos2[i] = cos_h * cos_h;
        block->sincos[i] = sin_h * cos_h;
        const float zeros = (sin_h - p->zero_tan * cos_h) * (cos_h - p->zero_cot * sin_h);
        block->cross[i] = p->cross_least + p->cross_factor * zeros;
        const float bisector = less_half_turns(theta1_rad[i] - half_knee);
        const float sin_b = sine(bisector), cos_b = cosine_coarse(bisector);
        block->sin_2b[i] = 2.0f * sin_b * cos_b;
        block->cos_2b[i] = (cos_b - sin_b) * (cos_b + sin_b);
    }
    return (size_t)refused;
}

INLINE void give_stiffness(const brace_planar_t *p, int n, block_t *restrict block, float *restrict k_xx,
                           float *restrict k_xz, float *restrict k_zz, float *restrict lambda_min,
                           float *restrict lambda_max)
{
    for (int i = 0; i < n; i++) {
        const float cos2 = block->cos2[i], sincos = block->sincos[i];
        const float cos_2b = block->cos_2b[i], sin_2b = block->sin_2b[i];
        const float x = harmonic(&p->dev_x, cos2, sincos), z = harmonic(&p->dev_z, cos2, sincos);
        const float dev_x = x * cos_2b - z * sin_2b, dev_z = x * sin_2b + z * cos_2b;
        const float mean = harmonic(&p->mean, cos2, sincos);
        const float det = p->rest_constant + p->rest_per_mean * mean + block->cross[i] * block->cross[i];

        const float radius = sqrtf(x * x + z * z);
        const float longest = mean + radius;
        const float inverse = 1.0f / (det * longest);
        const float per_det = inverse * longest;
        k_xx[i] = (mean - dev_x) * per_det;
        k_xz[i] = -dev_z * per_det;
        k_zz[i] = (mean + dev_x) * per_det;
        lambda_min[i] = inverse * det;
        lambda_max[i] = longest * per_det;

        const float lever = radius + fabsf(dev_x);
        block->dev_x[i] = dev_x;
        block->tangent[i] = dev_z / (lever > 1e-30f ? lever : 1e-30f);
    }
}

/* Half of atan2(-dev_z, -dev_x). */
INLINE void give_axis(int n, const block_t *restrict block, float *restrict axis_rad)
{
    for (int i = 0; i < n; i++) {
        const float half = arctangent(block->tangent[i]);
        const float turned = half - copysignf(HALF_PI, half);
        axis_rad[i] = block->dev_x[i] > 0.0f ? turned : -half;
    }
}

FOR_EACH_PROCESSOR
size_t brace_planar_batch(const brace_planar_t *planar, size_t n, const float *theta1_rad, const float *theta2_rad,
                          const brace_stiffness_soa_t *stiffness)
{
    const brace_planar_t p = *planar;
    const brace_stiffness_soa_t out = *stiffness;
    block_t block;
    size_t refused = 0;
    for (size_t at = 0; at < n; at += BLOCK) {
        const int count = n - at < BLOCK ? (int)(n - at) : BLOCK;
        refused += take_angles(&p, count, theta1_rad + at, theta2_rad + at, &block);
        give_stiffness(&p, count, &block, out.k_xx_n_per_mm + at, out.k_xz_n_per_mm + at, out.k_zz_n_per_mm + at,
                       out.lambda_min_n_per_mm + at, out.lambda_max_n_per_mm + at);
        give_axis(count, &block, out.stiff_axis_rad + at);
    }
    return refused;
}
