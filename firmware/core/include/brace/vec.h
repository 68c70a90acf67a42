/* Vectors and symmetric matrices. Their user names frame and unit. */
#ifndef BRACE_VEC_H
#define BRACE_VEC_H

/* In the limb's plane: x outwards, z up. */
typedef struct {
    float x, z;
} brace_vec_t;

/* In space. */
typedef struct {
    float x, y, z;
} brace_vec3_t;

/* Three vectors, one for each axis of a frame. */
typedef struct {
    brace_vec3_t x, y, z;
} brace_axes_t;

typedef struct {
    float xx, xy, xz, yy, yz, zz;
} brace_sym3_t;

#endif
