/* Types of K in the limb's plane under a load in fixed point; brace/loaded_fixed.h says what they are for. */
#ifndef BRACE_LOADED_FIXED_TYPES_H
#define BRACE_LOADED_FIXED_TYPES_H

#include <stdint.h>

#include "brace/fixed_vec.h"

/* One link in its own frame. A spring's vector is there twice: for an even and for an odd power of two of the units. */
typedef struct {
    int32_t length_q28;
    brace_fixed_vec_t to_beam_q28, beam_q28;
    brace_fixed_vec_t root_root_q31[2], end_root_q31[2];
    int32_t bend_q31, end_q31, weight_q31;
} brace_loaded_fixed_link_t;

/* A collapsed limb. brace_loaded_fixed_collapse writes it; other code must not read its members. Compliances per angle
 * are in units of 2^bend_exponent / N (their turn times the unit of length), springs in units of 2^spring_exponent / N,
 * weights in units of 2^weight_exponent N. */
typedef struct {
    brace_loaded_fixed_link_t femur, tibia;
    int32_t knee_q31, weight_q31;
    int32_t base_q31;
    brace_fixed_vec_t base_root_q31[2];
    int32_t base_rotation_q31;
    uint32_t weight_q8; /* one and a half times all weights [N], for the unit of force */
    int32_t length_exponent, bend_exponent, spring_exponent, weight_exponent;
} brace_loaded_fixed_t;

/* The coordinates of a link, as brace_loaded_shape_t [rad, q29]. */
typedef struct {
    int32_t root, a, b;
} brace_loaded_fixed_shape_t;

/* Where a limb has been bent to. brace_loaded_fixed_follow writes it; other code must not read its members. */
typedef struct {
    brace_loaded_fixed_shape_t femur_shape, tibia_shape;
    brace_fixed_vec_t on_base_q30; /* the whole load, in units of 2^force_exponent N */
    int32_t force_exponent;
} brace_loaded_fixed_place_t;

#endif
