/* Directions, angles and roots for what is not on the tick path: single precision, no libm, the same bits on
 * every target.
 */
#ifndef BRACE_TRIG_H
#define BRACE_TRIG_H

#include "brace/chain.h"

#define BRACE_PI 3.14159265f
#define BRACE_HALF_PI 1.57079633f

/* Fraction of a turn (2^32 = 2 pi) from an angle in [-7.99, 7.99] rad, within 2e-9 rad. Turns add, subtract
 * and wrap as integers, without loss. */
uint32_t brace_turn(float angle_rad);

/* The angle of a turn in [-pi, pi], within 2e-7 rad. */
static inline float brace_turn_angle(uint32_t turn)
{
    return (float)(int32_t)turn * (BRACE_PI / 0x1p31f);
}

/* Cosine and sine of an angle given as a turn, each within 4e-8. About 35 instructions. A complex number, because GCC returns
 * that in registers and a structure by way of memory. */
float _Complex brace_unit(uint32_t turn);

/* The same as a unit vector. */
static inline brace_vec_t brace_direction(uint32_t turn)
{
    const float _Complex unit = brace_unit(turn);
    return (brace_vec_t){__builtin_crealf(unit), __builtin_cimagf(unit)};
}

/* Angle of (x, y) from +x, [-pi, pi], within 3e-7 rad; within half of that unless x is negative, and not negative unless
 * y is; 0 for the zero vector, and less sharp for one shorter than 1e-30. x, y [-1e37, 1e37]. About 50 instructions. */
float brace_atan2(float y, float x);

/* An instruction where there is an FPU, correctly rounded everywhere. value >= 0. */
static inline float brace_sqrt(float value)
{
    return __builtin_sqrtf(value);
}

static inline float brace_length(float x, float z)
{
    return brace_sqrt(x * x + z * z);
}

#endif
