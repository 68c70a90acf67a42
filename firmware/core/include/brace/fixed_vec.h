/* Vectors in fixed point. */
#ifndef BRACE_FIXED_VEC_H
#define BRACE_FIXED_VEC_H

#include <stdint.h>

/* A vector in the limb's plane; its user names the format. */
typedef struct {
    int32_t x, z;
} brace_fixed_vec_t;

#endif
