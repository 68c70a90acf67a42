/* Types of K in space under a load in fixed point; brace/loaded_space_fixed.h says what they are for. */
#ifndef BRACE_LOADED_SPACE_FIXED_TYPES_H
#define BRACE_LOADED_SPACE_FIXED_TYPES_H

#include <stdint.h>

#include "brace/fixed_vec.h"

/* One link in its own frame. The springs at its end move it by their turn times a length: 2^-arm_shift of the unit. */
typedef struct {
    int32_t length_q28, twelfth_q28;
    brace_fixed_vec_t along_q30;       /* of the elastic line */
    brace_fixed_vec_t tilt_q28, bow_q28;
    int32_t twist_q31, sideways_q31, bend_q31; /* compliances of the link's turns, */
    int32_t across_arm_q31, sideways_arm_q31;  /* of its end's springs, */
    int32_t across_spread_q31, sideways_spread_q31;
    int32_t stretch_q31;               /* and of its axial spring */
    int32_t end_share_q30, stretch_end_share_q30, own_share_q30;
    int32_t curl_q30, shortens_q30;    /* for each turn of the end's springs */
    int32_t weight_q31;
    uint32_t arm_shift;
} brace_space_fixed_link_t;

/* A collapsed limb. brace_loaded_space_fixed_collapse writes it; other code must not read its members. Compliances per
 * angle are in units of 2^turn_exponent / N (their turn times the unit of length), springs in units of
 * 2^spring_exponent / N, weights in units of 2^weight_exponent N. */
typedef struct {
    brace_space_fixed_link_t coxa, femur, tibia;
    int32_t beyond_coxa_q31, beyond_femur_q31;
    int32_t base_x_q31, base_z_q31, base_rotation_q31;
    uint32_t weight_q8; /* one and a half times all weights [N], for the unit of force */
    int32_t length_exponent, turn_exponent, spring_exponent, weight_exponent;
} brace_loaded_space_fixed_t;

/* Angles q29. */
typedef struct {
    brace_fixed_vec3_t coxa, femur, tibia;
    int32_t base, yaw, hip, knee;
} brace_space_fixed_pose_t;

/* As brace_space_turns_t, q30. */
typedef struct {
    brace_fixed_vec_t base, yaw, coxa_z, coxa_y, coxa_x, hip, femur_y, femur_x, knee, tibia_y;
} brace_space_fixed_turns_t;

/* As brace_space_bent_t. */
typedef struct {
    brace_fixed_vec3_t chord_q28, across_q30;
    int32_t sideways_x_q30;
    brace_fixed_vec_t by_bend_q28;
    int32_t by_sideways_q28;
    int32_t across_curl_q30, sideways_curl_q30;
    brace_fixed_vec3_t beyond_q30, own_q30;
} brace_space_fixed_bent_t;

/* An equilibrium. Other code must not read its members. */
typedef struct {
    uint32_t theta1_turn, theta2_turn;
    brace_space_fixed_pose_t pose;
    brace_space_fixed_turns_t turns;
    brace_space_fixed_bent_t coxa, femur, tibia;
    brace_fixed_vec3_t whole_q30;
    int32_t base_q26, yaw_q26, hip_q26, knee_q26; /* compliances: the slopes of the joints' springs */
    int32_t force_exponent;
    uint32_t turn_shift, spring_shift;            /* from a collapsed limb's words to this load's */
} brace_space_fixed_rest_t;

#endif
