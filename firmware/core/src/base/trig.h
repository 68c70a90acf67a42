/* Sine, cosine and arctangent in single precision: the same bits on every target with an FPU, no table.
 *
 * Each polynomial states its largest error beside it. The rounding of its evaluation comes on top (about 6e-8).
 */
#ifndef BRACE_CORE_TRIG_H
#define BRACE_CORE_TRIG_H

#include <math.h>
#include <stdint.h>

#include "base/exact.h"
#include "base/fma.h"
#include "base/vec.h"

/* pi and pi/2, each as a float and the rest that the float leaves out. */
#define BRACE_PI 3.14159274f
#define BRACE_PI_LOW -8.74227766e-8f
#define BRACE_HALF_PI 1.57079637f
#define BRACE_HALF_PI_LOW -4.37113883e-8f
#define BRACE_QUARTER_PI 0.785398163f
#define BRACE_PER_PI 0.318309886f

/* The whole number of half turns nearest to an angle. Adding 1.5 * 2^23 to a small float and subtracting it again
 * rounds that float to an integer. A compiler that reorders sums would leave both out. */
static inline float brace_half_turns(float angle_rad)
{
    const float to_integer = 12582912.0f;
    return brace_opaque(fmaf(angle_rad, BRACE_PER_PI, to_integer)) - to_integer;
}

/* angle - count pi. The first step is exact, because fmaf() rounds once and the
 * difference of two floats of one size is a float. */
static inline float brace_less_half_turns(float angle_rad, float count)
{
    return fmaf(count, -BRACE_PI_LOW, fmaf(count, -BRACE_PI, angle_rad));
}

/* sin x for |x| <= pi/2; error 6e-9 of the result. */
static inline float brace_sine(float x)
{
    const float u = x * x;
    float sum = 2.60578056e-6f;
    sum = brace_fma(sum, u, -1.98096029e-4f);
    sum = brace_fma(sum, u, 8.33306625e-3f);
    sum = brace_fma(sum, u, -1.66666596e-1f);
    return brace_fma(x * u, sum, x);
}

/* cos x for |x| <= pi/2; error 6e-9 of the result, near pi/2 too, so that levers that vanish at the folded knee keep
 * their digits. */
static inline float brace_cosine(float x)
{
    return brace_sine((BRACE_HALF_PI - fabsf(x)) + BRACE_HALF_PI_LOW);
}

/* cos(high + low) for |high| <= pi/2, where `low` is too small to be added to `high`; error as brace_cosine, also near
 * pi/2 on either side. */
static inline float brace_cosine_of_parts(float high, float low)
{
    const float low_away_from_zero = high < 0.0f ? -low : low;
    return brace_sine((BRACE_HALF_PI - fabsf(high)) + (BRACE_HALF_PI_LOW - low_away_from_zero));
}

/* cos x for |x| <= pi/2, five instructions shorter; error 1.1e-7. */
static inline float brace_cosine_coarse(float x)
{
    const float u = x * x;
    float sum = 2.31943856e-5f;
    sum = brace_fma(sum, u, -1.38559271e-3f);
    sum = brace_fma(sum, u, 4.16639895e-2f);
    sum = brace_fma(sum, u, -0.499999323f);
    return brace_fma(sum, u, 1.0f);
}

/* (cos x, sin x) for |x| <= 1; error 2e-4 of the sine and 1.2e-3 of the cosine at 1 rad, 5e-6 and 4e-5 at 0.6 rad, 2e-8
 * and 2e-7 up to 0.35; exact at 0. About half the instructions of the two above. */
static inline brace_vec_t brace_small_turn(float x)
{
    const float u = x * x;
    const float sine = brace_fma(brace_fma(8.32e-3f, u, -1.66666e-1f), u * x, x);
    return (brace_vec_t){brace_fma(brace_fma(4.14288e-2f, u, -0.499991f), u, 1.0f), sine};
}

/* atan(t)/t for u = t^2, |t| <= 1; error 2.6e-7. */
static inline float brace_arctangent_per_tangent(float u)
{
    float sum = 0.00681179f;
    sum = brace_fma(sum, u, -0.03360421f);
    sum = brace_fma(sum, u, 0.07962366f);
    sum = brace_fma(sum, u, -0.13233341f);
    sum = brace_fma(sum, u, 0.19807815f);
    sum = brace_fma(sum, u, -0.33317368f);
    return brace_fma(sum, u, 0.99999611f);
}

/* Half the angle of -(x, z), in [-pi/2, pi/2]: the axis of the least eigenvalue of a tensor with that deviator. length:
 * that of (x, z), not zero. With t = x / (length + |z|), |t| <= 1, it is pi/4 + atan t, with the sign of -z. The
 * tangent stays within [-1, 1], and nothing has to be halved or wrapped. */
static inline float brace_half_angle_of_opposite(float x, float z, float length)
{
    const float tangent = x / (length + fabsf(z));
    const float angle_rad = brace_fma(tangent, brace_arctangent_per_tangent(tangent * tangent), BRACE_QUARTER_PI);
    return z > 0.0f ? -angle_rad : angle_rad;
}

/* (cos, sin) of an angle in [-16, 16] rad, each within 1e-7. About 40 instructions. */
static inline brace_vec_t brace_direction(float angle_rad)
{
    const float half_turns = brace_half_turns(angle_rad);
    const float x = brace_less_half_turns(angle_rad, half_turns);
    const float sign = ((int32_t)half_turns & 1) != 0 ? -1.0f : 1.0f; /* half a turn points the other way */
    return (brace_vec_t){sign * brace_cosine(x), sign * brace_sine(x)};
}

/* Angle of (x, y) from +x, [-pi, pi], within 3e-7 rad, and within 1.5e-7 rad where x is not negative. It is negative
 * only if y is negative. 0 for the zero vector; less exact for a vector shorter than 1e-30. x, y [-1e37, 1e37]. About
 * 50 instructions. */
float brace_atan2(float y, float x);

/* An angle in [-3 pi, 3 pi] less a whole turn if it lies beyond half a turn: [-pi, pi]. */
static inline float brace_wrapped(float angle_rad)
{
    const float turn_rad = 2.0f * BRACE_PI, turn_low_rad = 2.0f * BRACE_PI_LOW;
    if (angle_rad > BRACE_PI) {
        return (angle_rad - turn_rad) - turn_low_rad;
    }
    return angle_rad < -BRACE_PI ? (angle_rad + turn_rad) + turn_low_rad : angle_rad;
}

#endif
