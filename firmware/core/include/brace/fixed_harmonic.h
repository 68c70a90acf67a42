/* One harmonic of the knee angle in integers, of which brace/planar_fixed.h makes C. */
#ifndef BRACE_FIXED_HARMONIC_H
#define BRACE_FIXED_HARMONIC_H

#include <stdint.h>

/* A function of the knee angle, constant + per_cos cos theta2 + per_sin sin theta2, scaled to integers. */
typedef struct {
    int64_t constant_q32;     /* in the result's unit; holds half a unit more, so that truncation rounds */
    int32_t per_cos, per_sin; /* in twice the result's unit: their products with a q31 number are q32 */
} brace_fixed_harmonic_t;

#endif
