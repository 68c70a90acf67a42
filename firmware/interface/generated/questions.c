/* Written by tools/interface from dictionary.toml; do not edit. */
#include "brace/questions.h"

#include "brace/can_messages.h"

const brace_question_t brace_questions[BRACE_QUESTION_COUNT] = {
    {6, 2, 2, 1, {BRACE_REQUEST_K_AT_POSTURE}, 0, 7, true},
    {8, 3, 2, 2, {BRACE_REQUEST_K_AT_TIP_KNEE_UP, BRACE_REQUEST_K_AT_TIP_KNEE_DOWN}, 0, 7, true},
    {11, 2, 2, 1, {BRACE_REQUEST_CONTACT_FORCE}, 7, 4, false},
    {13, 2, 2, 1, {BRACE_REQUEST_SAG_FOR_LOAD}, 11, 2, false},
    {15, 2, 2, 1, {BRACE_REQUEST_FRICTION_MARGIN}, 13, 3, false},
};

const brace_commands_t brace_commands_unknown = {
    .asked_theta1_rad = __builtin_nanf(""),
    .asked_theta2_rad = __builtin_nanf(""),
    .asked_tip_x_mm = __builtin_nanf(""),
    .asked_tip_z_mm = __builtin_nanf(""),
    .asked_knee = UINT32_MAX,
    .asked_dx_mm = __builtin_nanf(""),
    .asked_dz_mm = __builtin_nanf(""),
    .asked_load_x_n = __builtin_nanf(""),
    .asked_load_z_n = __builtin_nanf(""),
    .asked_normal_rad = __builtin_nanf(""),
    .asked_friction = __builtin_nanf(""),
};

const brace_answered_t brace_answered_unknown = {
    .asked_k_xx_n_per_mm = __builtin_nanf(""),
    .asked_k_xz_n_per_mm = __builtin_nanf(""),
    .asked_k_zz_n_per_mm = __builtin_nanf(""),
    .asked_lambda_min_n_per_mm = __builtin_nanf(""),
    .asked_lambda_max_n_per_mm = __builtin_nanf(""),
    .asked_stiff_axis_rad = __builtin_nanf(""),
    .asked_flags = UINT32_MAX,
    .asked_force_x_n = __builtin_nanf(""),
    .asked_force_z_n = __builtin_nanf(""),
    .asked_force_low_n = __builtin_nanf(""),
    .asked_force_high_n = __builtin_nanf(""),
    .asked_sag_x_mm = __builtin_nanf(""),
    .asked_sag_z_mm = __builtin_nanf(""),
    .asked_margin_n = __builtin_nanf(""),
    .asked_angle_left_rad = __builtin_nanf(""),
    .asked_contact = UINT32_MAX,
};
