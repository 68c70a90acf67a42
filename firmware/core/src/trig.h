/* Sine, cosine, angle and root for the core's own use: single precision, no libm, the same bits on every
 * target (plain multiplications and additions, no fusing). Not for the tick paths, which carry their own.
 */
#ifndef BRACE_CORE_TRIG_H
#define BRACE_CORE_TRIG_H

#define BRACE_PI 3.14159265f
#define BRACE_HALF_PI 1.57079633f

typedef struct {
    float sine;
    float cosine;
} brace_sincos_t;

/* angle_rad [-30, 30]; each within 1.0e-7. About 45 instructions on a Cortex-M4F. */
brace_sincos_t brace_sincos(float angle_rad);

/* Angle of (x, y) from +x, [-pi, pi], within 3e-7 rad; 0 for the zero vector. x, y [-1e37, 1e37].
 * About 50 instructions. */
float brace_atan2(float y, float x);

/* An instruction where there is an FPU, correctly rounded everywhere. value >= 0. */
static inline float brace_sqrt(float value)
{
    return __builtin_sqrtf(value);
}

#endif
