#include "brace/planar_batch.h"

#include <string.h>

#include "brace/kinematics.h"

/* On a host the loop below is compiled for several generations of the processor and the best is taken at run
 * time. Sanitizers run before such a choice can be made. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "fp-contract=fast", "no-trapping-math")
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) &&                           \
    !defined(__SANITIZE_THREAD__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
#endif
#ifndef FOR_EACH_PROCESSOR
#define FOR_EACH_PROCESSOR
#endif

#define ALWAYS static inline __attribute__((always_inline))

/* pi in two floats, the first so short that its small multiples are exact. */
#define PI_FIRST 3.140625f
#define PI_REST 9.67653589793e-4f
#define PER_PI 0.318309886f
#define HALF_PI 1.57079633f
#define HALF_PI_REST -4.37113883e-8f

/* Adding and taking it away rounds to an integer. */
#define ROUNDING 12582912.0f

/* The nearest multiple of pi. */
ALWAYS float half_turns(float angle_rad)
{
    return angle_rad * PER_PI + ROUNDING - ROUNDING;
}

/* What is left of an angle beyond that multiple. */
ALWAYS float off_half_turns(float angle_rad)
{
    const float count = half_turns(angle_rad);
    return (angle_rad - count * PI_FIRST) - count * PI_REST;
}

/* The same of the angle from another, which is given as a float and what the float leaves. */
ALWAYS float off_half_turns_from(float angle_rad, float from_rad, float from_rest_rad)
{
    const float count = half_turns(angle_rad - from_rad);
    return ((angle_rad - count * PI_FIRST) - from_rad) - (count * PI_REST + from_rest_rad);
}

/* |x| <= pi/2, within 6e-9 of the result. */
ALWAYS float sine(float x)
{
    const float u = x * x;
    const float series = -1.66666596e-1f + u * (8.33306625e-3f + u * (-1.98096029e-4f + u * 2.60578056e-6f));
    return x + (x * u) * series;
}

/* |x| <= pi/2, right to the last digits also where it vanishes. */
ALWAYS float cosine(float x)
{
    return sine((HALF_PI - __builtin_fabsf(x)) + HALF_PI_REST);
}

/* |x| <= pi/2, within 1.1e-7. */
ALWAYS float cosine_coarse(float x)
{
    const float u = x * x;
    return 1.0f + u * (-0.499999323f + u * (4.16639895e-2f + u * (-1.38559271e-3f + u * 2.31943856e-5f)));
}

/* |t| <= 1, within 2.6e-7. */
ALWAYS float arctangent(float t)
{
    const float u = t * t;
    const float high = -0.13233341f + u * (0.07962366f + u * (-0.03360421f + u * 0.00681179f));
    return t * (0.99999611f + u * (-0.33317368f + u * (0.19807815f + u * high)));
}

ALWAYS float harmonic(const brace_harmonic_t *h, float half_one_plus_cos, float half_sin)
{
    return h->at_fold + h->per_cos * half_one_plus_cos + h->per_sin * half_sin;
}

ALWAYS int usable(float theta1_rad, float theta2_rad)
{
    return (__builtin_fabsf(theta1_rad) <= BRACE_ANGLE_LIMIT_RAD) &
           (__builtin_fabsf(theta2_rad) <= BRACE_ANGLE_LIMIT_RAD);
}

/* The work goes through the first-level cache in blocks and in three loops: in one, each posture's chain of
 * operations is so long that the processor sees too few postures at a time. */
enum { BLOCK = 256 };

typedef struct {
    float half_sin_knee[BLOCK], half_one_plus_cos_knee[BLOCK];
    float cross[BLOCK];
    float sin_2b[BLOCK], cos_2b[BLOCK]; /* of twice the bisector's angle */
    float dev_x[BLOCK], tangent[BLOCK]; /* of half of dev's angle from the nearer end of the x axis */
} block_t;

/* Returns how many postures are none; their angles become NaN, and so does all that follows. */
ALWAYS size_t take_angles(const brace_planar_batch_t *b, int upright, int n, const float *restrict theta1_rad,
                          const float *restrict theta2_rad, block_t *restrict block)
{
    int refused = 0;
    for (int i = 0; i < n; i++) {
        const int good = usable(theta1_rad[i], theta2_rad[i]);
        refused += !good;
        const float half_knee = good ? 0.5f * theta2_rad[i] : __builtin_nanf("");
        const float h = off_half_turns(half_knee);
        const float cos_h = cosine(h), half_sin = sine(h) * cos_h;
        float cross = b->cross_swing * half_sin;
        if (!upright) {
            const float near_0 = off_half_turns_from(half_knee, b->zero_rad[0], b->zero_rest_rad[0]);
            const float near_1 = off_half_turns_from(half_knee, b->zero_rad[1], b->zero_rest_rad[1]);
            cross = b->cross_least + b->cross_swing * (sine(near_0) * sine(near_1));
        }
        const float bisector = off_half_turns(theta1_rad[i] - half_knee);
        const float sin_b = sine(bisector), cos_b = cosine_coarse(bisector);
        block->half_sin_knee[i] = half_sin;
        block->half_one_plus_cos_knee[i] = cos_h * cos_h;
        block->cross[i] = cross;
        block->sin_2b[i] = 2.0f * sin_b * cos_b;
        block->cos_2b[i] = (cos_b - sin_b) * (cos_b + sin_b);
    }
    return (size_t)refused;
}

ALWAYS void give_stiffness(const brace_planar_batch_t *b, int n, block_t *restrict block,
                           float *restrict k_xx, float *restrict k_xz, float *restrict k_zz,
                           float *restrict lambda_min, float *restrict lambda_max)
{
    for (int i = 0; i < n; i++) {
        const float c = block->half_one_plus_cos_knee[i], s = block->half_sin_knee[i];
        const float cos_2b = block->cos_2b[i], sin_2b = block->sin_2b[i];
        const float x = harmonic(&b->dev_x, c, s), y = harmonic(&b->dev_y, c, s);
        const float dev_x = x * cos_2b - y * sin_2b, dev_y = x * sin_2b + y * cos_2b;
        const float mean = harmonic(&b->mean, c, s);
        const float det = harmonic(&b->rest, c, s) + block->cross[i] * block->cross[i];

        const float radius = __builtin_sqrtf(x * x + y * y);
        const float largest = mean + radius;
        const float inverse = 1.0f / (det * largest);
        const float per_det = inverse * largest;
        k_xx[i] = (mean - dev_x) * per_det;
        k_xz[i] = -dev_y * per_det;
        k_zz[i] = (mean + dev_x) * per_det;
        lambda_min[i] = inverse * det;
        lambda_max[i] = largest * per_det;

        const float lever = radius + __builtin_fabsf(dev_x);
        block->dev_x[i] = dev_x;
        block->tangent[i] = dev_y / (lever > 1e-30f ? lever : 1e-30f);
    }
}

/* Half of atan2(-dev_y, -dev_x). */
ALWAYS void give_axis(int n, const block_t *restrict block, float *restrict axis_rad)
{
    for (int i = 0; i < n; i++) {
        const float half = arctangent(block->tangent[i]);
        const float turned = half - __builtin_copysignf(HALF_PI, half);
        axis_rad[i] = block->dev_x[i] > 0.0f ? turned : -half;
    }
}

FOR_EACH_PROCESSOR
size_t brace_planar_batch(const brace_planar_batch_t *batch, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const brace_stiffness_soa_t *stiffness)
{
    const brace_planar_batch_t b = *batch;
    const brace_stiffness_soa_t out = *stiffness;
    block_t block;
    size_t refused = 0;
    for (size_t at = 0; at < n; at += BLOCK) {
        const int count = n - at < BLOCK ? (int)(n - at) : BLOCK;
        refused += b.upright ? take_angles(&b, 1, count, theta1_rad + at, theta2_rad + at, &block)
                             : take_angles(&b, 0, count, theta1_rad + at, theta2_rad + at, &block);
        give_stiffness(&b, count, &block, out.k_xx_n_per_mm + at, out.k_xz_n_per_mm + at,
                       out.k_zz_n_per_mm + at, out.lambda_min_n_per_mm + at, out.lambda_max_n_per_mm + at);
        give_axis(count, &block, out.stiff_axis_rad + at);
    }
    return refused;
}
