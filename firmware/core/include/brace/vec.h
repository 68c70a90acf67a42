/* A vector in the limb's plane, x outwards, z up. Its user names the frame and the unit. */
#ifndef BRACE_VEC_H
#define BRACE_VEC_H

typedef struct {
    float x, z;
} brace_vec_t;

#endif
