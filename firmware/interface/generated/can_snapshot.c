/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/can_snapshot.h"

#include <stdbool.h>

#include "brace/can_messages.h"
#include "brace/status.h"

/* NaN is beyond nothing. */
static bool is_beyond(float value, float most)
{
    return __builtin_fabsf(value) > most;
}

/* What is beyond is not known. */
static float known_to(float value, float most)
{
    return is_beyond(value, most) ? __builtin_nanf("") : value;
}

void brace_can_make_stiffness_a(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    const brace_can_stiffness_a_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_xx_n_per_mm = measured->k_xx_n_per_mm,
        .k_xz_n_per_mm = measured->k_xz_n_per_mm,
        .age_ms = age_ms,
    };
    (void)brace_can_pack_stiffness_a(&message, data);
}

static uint32_t stiffness_b_flags(const brace_measured_t *measured)
{
    const bool is_limited =
        is_beyond(measured->k_xx_n_per_mm, BRACE_CAN_STIFFNESS_A_K_XX_N_PER_MM_MOST) ||
        is_beyond(measured->k_xz_n_per_mm, BRACE_CAN_STIFFNESS_A_K_XZ_N_PER_MM_MOST) ||
        is_beyond(measured->k_zz_n_per_mm, BRACE_CAN_STIFFNESS_B_K_ZZ_N_PER_MM_MOST) ||
        is_beyond(measured->lambda_min_n_per_mm, BRACE_CAN_EIGENVALUES_LAMBDA_MIN_N_PER_MM_MOST) ||
        is_beyond(measured->lambda_max_n_per_mm, BRACE_CAN_EIGENVALUES_LAMBDA_MAX_N_PER_MM_MOST) ||
        is_beyond(measured->stiff_axis_rad, BRACE_CAN_EIGENVALUES_STIFF_AXIS_RAD_MOST);
    return measured->flags | (is_limited ? (uint32_t)BRACE_FLAG_SATURATED : 0u);
}

void brace_can_make_stiffness_b(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_stiffness_b_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_zz_n_per_mm = measured->k_zz_n_per_mm,
        .flags = stiffness_b_flags(measured),
        .play_femur = measured->play_femur,
        .play_tibia = measured->play_tibia,
        .mode = measured->mode,
    };
    (void)brace_can_pack_stiffness_b(&message, data);
}

void brace_can_make_eigenvalues(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_eigenvalues_t message = {
        .sequence = measured->sequence & 0xffu,
        .lambda_min_n_per_mm = measured->lambda_min_n_per_mm,
        .lambda_max_n_per_mm = measured->lambda_max_n_per_mm,
        .stiff_axis_rad = measured->stiff_axis_rad,
    };
    (void)brace_can_pack_eigenvalues(&message, data);
}

void brace_can_make_posture(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_posture_t message = {
        .sequence = measured->sequence & 0xffu,
        .theta1_rad = measured->theta1_rad,
        .theta2_rad = measured->theta2_rad,
        .parameter_tag = measured->parameter_crc & 0xffffu,
    };
    (void)brace_can_pack_posture(&message, data);
}

void brace_can_make_space_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_space_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_xx_n_per_mm = measured->space_k_xx_n_per_mm,
        .k_xy_n_per_mm = measured->space_k_xy_n_per_mm,
    };
    (void)brace_can_pack_space_0(&message, data);
}

void brace_can_make_space_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_space_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_xz_n_per_mm = measured->space_k_xz_n_per_mm,
        .k_yy_n_per_mm = measured->space_k_yy_n_per_mm,
    };
    (void)brace_can_pack_space_1(&message, data);
}

void brace_can_make_space_2(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_space_2_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_yz_n_per_mm = measured->space_k_yz_n_per_mm,
        .k_zz_n_per_mm = measured->space_k_zz_n_per_mm,
    };
    (void)brace_can_pack_space_2(&message, data);
}

void brace_can_make_space_3(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_space_3_t message = {
        .sequence = measured->sequence & 0xffu,
        .lambda_1_n_per_mm = measured->space_lambda_1_n_per_mm,
        .lambda_2_n_per_mm = measured->space_lambda_2_n_per_mm,
    };
    (void)brace_can_pack_space_3(&message, data);
}

static uint32_t space_4_flags(const brace_measured_t *measured)
{
    const bool is_limited =
        is_beyond(measured->space_k_xx_n_per_mm, BRACE_CAN_SPACE_0_K_XX_N_PER_MM_MOST) ||
        is_beyond(measured->space_k_xy_n_per_mm, BRACE_CAN_SPACE_0_K_XY_N_PER_MM_MOST) ||
        is_beyond(measured->space_k_xz_n_per_mm, BRACE_CAN_SPACE_1_K_XZ_N_PER_MM_MOST) ||
        is_beyond(measured->space_k_yy_n_per_mm, BRACE_CAN_SPACE_1_K_YY_N_PER_MM_MOST) ||
        is_beyond(measured->space_k_yz_n_per_mm, BRACE_CAN_SPACE_2_K_YZ_N_PER_MM_MOST) ||
        is_beyond(measured->space_k_zz_n_per_mm, BRACE_CAN_SPACE_2_K_ZZ_N_PER_MM_MOST) ||
        is_beyond(measured->space_lambda_3_n_per_mm, BRACE_CAN_SPACE_4_LAMBDA_3_N_PER_MM_MOST);
    return measured->space_flags | (is_limited ? (uint32_t)BRACE_FLAG_SATURATED : 0u);
}

void brace_can_make_space_4(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    const brace_can_space_4_t message = {
        .sequence = measured->sequence & 0xffu,
        .lambda_3_n_per_mm = measured->space_lambda_3_n_per_mm,
        .flags = space_4_flags(measured),
        .age_ms = age_ms,
    };
    (void)brace_can_pack_space_4(&message, data);
}

void brace_can_make_space_5(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_space_5_t message = {
        .sequence = measured->sequence & 0xffu,
        .stiff_axis_x = measured->space_stiff_axis_x,
        .stiff_axis_y = measured->space_stiff_axis_y,
        .stiff_axis_z = measured->space_stiff_axis_z,
    };
    (void)brace_can_pack_space_5(&message, data);
}

void brace_can_make_space_6(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_space_6_t message = {
        .sequence = measured->sequence & 0xffu,
        .theta0_rad = measured->theta0_rad,
        .k_across_n_per_mm = measured->k_across_n_per_mm,
        .play_coxa = measured->play_coxa,
    };
    (void)brace_can_pack_space_6(&message, data);
}

void brace_can_make_load_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .unloaded_k_xx_n_per_mm = measured->unloaded_k_xx_n_per_mm,
        .unloaded_k_xz_n_per_mm = measured->unloaded_k_xz_n_per_mm,
    };
    (void)brace_can_pack_load_0(&message, data);
}

static uint32_t load_1_flags(const brace_measured_t *measured)
{
    const bool is_limited =
        is_beyond(measured->unloaded_k_xx_n_per_mm, BRACE_CAN_LOAD_0_UNLOADED_K_XX_N_PER_MM_MOST) ||
        is_beyond(measured->unloaded_k_xz_n_per_mm, BRACE_CAN_LOAD_0_UNLOADED_K_XZ_N_PER_MM_MOST) ||
        is_beyond(measured->unloaded_k_zz_n_per_mm, BRACE_CAN_LOAD_1_UNLOADED_K_ZZ_N_PER_MM_MOST) ||
        is_beyond(measured->counted_force_x_n, BRACE_CAN_LOAD_2_COUNTED_FORCE_X_N_MOST) ||
        is_beyond(measured->counted_force_z_n, BRACE_CAN_LOAD_2_COUNTED_FORCE_Z_N_MOST) ||
        is_beyond(measured->moved_x_mm, BRACE_CAN_LOAD_3_MOVED_X_MM_MOST) ||
        is_beyond(measured->moved_z_mm, BRACE_CAN_LOAD_3_MOVED_Z_MM_MOST) ||
        is_beyond(measured->gravity_lean_rad, BRACE_CAN_LOAD_5_GRAVITY_LEAN_RAD_MOST);
    return measured->flags | (is_limited ? (uint32_t)BRACE_FLAG_SATURATED : 0u);
}

void brace_can_make_load_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .unloaded_k_zz_n_per_mm = measured->unloaded_k_zz_n_per_mm,
        .flags = load_1_flags(measured),
    };
    (void)brace_can_pack_load_1(&message, data);
}

void brace_can_make_load_2(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_2_t message = {
        .sequence = measured->sequence & 0xffu,
        .counted_force_x_n = measured->counted_force_x_n,
        .counted_force_z_n = measured->counted_force_z_n,
    };
    (void)brace_can_pack_load_2(&message, data);
}

void brace_can_make_load_3(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_3_t message = {
        .sequence = measured->sequence & 0xffu,
        .moved_x_mm = measured->moved_x_mm,
        .moved_z_mm = measured->moved_z_mm,
    };
    (void)brace_can_pack_load_3(&message, data);
}

void brace_can_make_load_4(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_4_t message = {
        .sequence = measured->sequence & 0xffu,
        .buckling_factor = measured->buckling_factor,
        .gravity_direction_rad = measured->gravity_direction_rad,
    };
    (void)brace_can_pack_load_4(&message, data);
}

void brace_can_make_load_5(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_5_t message = {
        .sequence = measured->sequence & 0xffu,
        .gravity_lean_rad = measured->gravity_lean_rad,
    };
    (void)brace_can_pack_load_5(&message, data);
}

void brace_can_make_load_across_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_across_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .counted_force_y_n = measured->counted_force_y_n,
        .moved_y_mm = measured->moved_y_mm,
    };
    (void)brace_can_pack_load_across_0(&message, data);
}

static uint32_t load_across_1_flags(const brace_measured_t *measured)
{
    const bool is_limited =
        is_beyond(measured->counted_force_y_n, BRACE_CAN_LOAD_ACROSS_0_COUNTED_FORCE_Y_N_MOST) ||
        is_beyond(measured->moved_y_mm, BRACE_CAN_LOAD_ACROSS_0_MOVED_Y_MM_MOST) ||
        is_beyond(measured->unloaded_k_across_n_per_mm, BRACE_CAN_LOAD_ACROSS_1_UNLOADED_K_ACROSS_N_PER_MM_MOST);
    return measured->space_flags | (is_limited ? (uint32_t)BRACE_FLAG_SATURATED : 0u);
}

void brace_can_make_load_across_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_load_across_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .unloaded_k_across_n_per_mm = measured->unloaded_k_across_n_per_mm,
        .flags = load_across_1_flags(measured),
    };
    (void)brace_can_pack_load_across_1(&message, data);
}

void brace_can_make_sigma_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_xx_n_per_mm = known_to(measured->sigma_k_xx_n_per_mm, BRACE_CAN_SIGMA_0_K_XX_N_PER_MM_MOST),
        .k_xz_n_per_mm = known_to(measured->sigma_k_xz_n_per_mm, BRACE_CAN_SIGMA_0_K_XZ_N_PER_MM_MOST),
        .k_zz_n_per_mm = known_to(measured->sigma_k_zz_n_per_mm, BRACE_CAN_SIGMA_0_K_ZZ_N_PER_MM_MOST),
    };
    (void)brace_can_pack_sigma_0(&message, data);
}

void brace_can_make_sigma_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .lambda_min_n_per_mm = known_to(measured->sigma_lambda_min_n_per_mm, BRACE_CAN_SIGMA_1_LAMBDA_MIN_N_PER_MM_MOST),
        .lambda_max_n_per_mm = known_to(measured->sigma_lambda_max_n_per_mm, BRACE_CAN_SIGMA_1_LAMBDA_MAX_N_PER_MM_MOST),
        .stiff_axis_rad = known_to(measured->sigma_stiff_axis_rad, BRACE_CAN_SIGMA_1_STIFF_AXIS_RAD_MOST),
    };
    (void)brace_can_pack_sigma_1(&message, data);
}

void brace_can_make_sigma_space_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_space_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_xx_n_per_mm = known_to(measured->sigma_space_k_xx_n_per_mm, BRACE_CAN_SIGMA_SPACE_0_K_XX_N_PER_MM_MOST),
        .k_xy_n_per_mm = known_to(measured->sigma_space_k_xy_n_per_mm, BRACE_CAN_SIGMA_SPACE_0_K_XY_N_PER_MM_MOST),
        .k_xz_n_per_mm = known_to(measured->sigma_space_k_xz_n_per_mm, BRACE_CAN_SIGMA_SPACE_0_K_XZ_N_PER_MM_MOST),
    };
    (void)brace_can_pack_sigma_space_0(&message, data);
}

void brace_can_make_sigma_space_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_space_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_yy_n_per_mm = known_to(measured->sigma_space_k_yy_n_per_mm, BRACE_CAN_SIGMA_SPACE_1_K_YY_N_PER_MM_MOST),
        .k_yz_n_per_mm = known_to(measured->sigma_space_k_yz_n_per_mm, BRACE_CAN_SIGMA_SPACE_1_K_YZ_N_PER_MM_MOST),
        .k_zz_n_per_mm = known_to(measured->sigma_space_k_zz_n_per_mm, BRACE_CAN_SIGMA_SPACE_1_K_ZZ_N_PER_MM_MOST),
    };
    (void)brace_can_pack_sigma_space_1(&message, data);
}

void brace_can_make_sigma_space_2(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_space_2_t message = {
        .sequence = measured->sequence & 0xffu,
        .lambda_1_n_per_mm = known_to(measured->sigma_space_lambda_1_n_per_mm, BRACE_CAN_SIGMA_SPACE_2_LAMBDA_1_N_PER_MM_MOST),
        .lambda_2_n_per_mm = known_to(measured->sigma_space_lambda_2_n_per_mm, BRACE_CAN_SIGMA_SPACE_2_LAMBDA_2_N_PER_MM_MOST),
        .lambda_3_n_per_mm = known_to(measured->sigma_space_lambda_3_n_per_mm, BRACE_CAN_SIGMA_SPACE_2_LAMBDA_3_N_PER_MM_MOST),
    };
    (void)brace_can_pack_sigma_space_2(&message, data);
}

void brace_can_make_sigma_space_3(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_space_3_t message = {
        .sequence = measured->sequence & 0xffu,
        .k_across_n_per_mm = known_to(measured->sigma_k_across_n_per_mm, BRACE_CAN_SIGMA_SPACE_3_K_ACROSS_N_PER_MM_MOST),
    };
    (void)brace_can_pack_sigma_space_3(&message, data);
}

void brace_can_make_interval_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .force_x_low_n = measured->force_x_low_n,
        .force_x_high_n = measured->force_x_high_n,
    };
    (void)brace_can_pack_interval_0(&message, data);
}

void brace_can_make_interval_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .force_z_low_n = measured->force_z_low_n,
        .force_z_high_n = measured->force_z_high_n,
    };
    (void)brace_can_pack_interval_1(&message, data);
}

void brace_can_make_interval_2(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_2_t message = {
        .sequence = measured->sequence & 0xffu,
        .load_femur_low_n_mm = measured->load_femur_low_n_mm,
        .load_femur_high_n_mm = measured->load_femur_high_n_mm,
    };
    (void)brace_can_pack_interval_2(&message, data);
}

void brace_can_make_interval_3(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_3_t message = {
        .sequence = measured->sequence & 0xffu,
        .load_tibia_low_n_mm = measured->load_tibia_low_n_mm,
        .load_tibia_high_n_mm = measured->load_tibia_high_n_mm,
    };
    (void)brace_can_pack_interval_3(&message, data);
}

void brace_can_make_interval_across_0(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_across_0_t message = {
        .sequence = measured->sequence & 0xffu,
        .force_y_low_n = measured->force_y_low_n,
        .force_y_high_n = measured->force_y_high_n,
    };
    (void)brace_can_pack_interval_across_0(&message, data);
}

void brace_can_make_interval_across_1(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_across_1_t message = {
        .sequence = measured->sequence & 0xffu,
        .load_coxa_low_n_mm = measured->load_coxa_low_n_mm,
        .load_coxa_high_n_mm = measured->load_coxa_high_n_mm,
    };
    (void)brace_can_pack_interval_across_1(&message, data);
}

void brace_can_make_snapshot_fd(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    const brace_can_snapshot_fd_t message = {
        .sequence = measured->sequence,
        .parameter_tag = measured->parameter_crc & 0xffffu,
        .age_ms = age_ms,
        .flags = measured->flags,
        .mode = measured->mode,
        .play_femur = measured->play_femur,
        .play_tibia = measured->play_tibia,
        .faults = measured->faults,
        .k_xx_n_per_mm = measured->k_xx_n_per_mm,
        .k_xz_n_per_mm = measured->k_xz_n_per_mm,
        .k_zz_n_per_mm = measured->k_zz_n_per_mm,
        .lambda_min_n_per_mm = measured->lambda_min_n_per_mm,
        .lambda_max_n_per_mm = measured->lambda_max_n_per_mm,
        .stiff_axis_rad = measured->stiff_axis_rad,
        .theta1_rad = measured->theta1_rad,
        .theta2_rad = measured->theta2_rad,
        .tip_x_mm = measured->tip_x_mm,
        .tip_z_mm = measured->tip_z_mm,
        .force_x_n = measured->force_x_n,
        .force_z_n = measured->force_z_n,
    };
    (void)brace_can_pack_snapshot_fd(&message, data);
}

void brace_can_make_space_fd(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    const brace_can_space_fd_t message = {
        .sequence = measured->sequence & 0xffu,
        .age_ms = age_ms,
        .flags = measured->space_flags,
        .parameter_tag = measured->parameter_crc & 0xffffu,
        .mode = measured->mode,
        .play_coxa = measured->play_coxa,
        .stiff_axis_x = measured->space_stiff_axis_x,
        .stiff_axis_y = measured->space_stiff_axis_y,
        .stiff_axis_z = measured->space_stiff_axis_z,
        .theta0_rad = measured->theta0_rad,
        .k_across_n_per_mm = measured->k_across_n_per_mm,
        .k_xx_n_per_mm = measured->space_k_xx_n_per_mm,
        .k_xy_n_per_mm = measured->space_k_xy_n_per_mm,
        .k_xz_n_per_mm = measured->space_k_xz_n_per_mm,
        .k_yy_n_per_mm = measured->space_k_yy_n_per_mm,
        .k_yz_n_per_mm = measured->space_k_yz_n_per_mm,
        .k_zz_n_per_mm = measured->space_k_zz_n_per_mm,
        .lambda_1_n_per_mm = measured->space_lambda_1_n_per_mm,
        .lambda_2_n_per_mm = measured->space_lambda_2_n_per_mm,
        .lambda_3_n_per_mm = measured->space_lambda_3_n_per_mm,
    };
    (void)brace_can_pack_space_fd(&message, data);
}

void brace_can_make_load_fd(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    const brace_can_load_fd_t message = {
        .sequence = measured->sequence & 0xffu,
        .age_ms = age_ms,
        .flags = measured->flags,
        .parameter_tag = measured->parameter_crc & 0xffffu,
        .unloaded_k_xx_n_per_mm = measured->unloaded_k_xx_n_per_mm,
        .unloaded_k_xz_n_per_mm = measured->unloaded_k_xz_n_per_mm,
        .unloaded_k_zz_n_per_mm = measured->unloaded_k_zz_n_per_mm,
        .counted_force_x_n = measured->counted_force_x_n,
        .counted_force_z_n = measured->counted_force_z_n,
        .moved_x_mm = measured->moved_x_mm,
        .moved_z_mm = measured->moved_z_mm,
        .buckling_factor = measured->buckling_factor,
        .gravity_direction_rad = measured->gravity_direction_rad,
        .gravity_lean_rad = measured->gravity_lean_rad,
        .counted_force_y_n = measured->counted_force_y_n,
        .moved_y_mm = measured->moved_y_mm,
        .unloaded_k_across_n_per_mm = measured->unloaded_k_across_n_per_mm,
    };
    (void)brace_can_pack_load_fd(&message, data);
}

void brace_can_make_sigma_fd(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_sigma_fd_t message = {
        .sequence = measured->sequence & 0xffu,
        .stiff_axis_rad = known_to(measured->sigma_stiff_axis_rad, BRACE_CAN_SIGMA_FD_STIFF_AXIS_RAD_MOST),
        .k_xx_n_per_mm = measured->sigma_k_xx_n_per_mm,
        .k_xz_n_per_mm = measured->sigma_k_xz_n_per_mm,
        .k_zz_n_per_mm = measured->sigma_k_zz_n_per_mm,
        .lambda_min_n_per_mm = measured->sigma_lambda_min_n_per_mm,
        .lambda_max_n_per_mm = measured->sigma_lambda_max_n_per_mm,
        .space_k_xx_n_per_mm = measured->sigma_space_k_xx_n_per_mm,
        .space_k_xy_n_per_mm = measured->sigma_space_k_xy_n_per_mm,
        .space_k_xz_n_per_mm = measured->sigma_space_k_xz_n_per_mm,
        .space_k_yy_n_per_mm = measured->sigma_space_k_yy_n_per_mm,
        .space_k_yz_n_per_mm = measured->sigma_space_k_yz_n_per_mm,
        .space_k_zz_n_per_mm = measured->sigma_space_k_zz_n_per_mm,
        .space_lambda_1_n_per_mm = measured->sigma_space_lambda_1_n_per_mm,
        .space_lambda_2_n_per_mm = measured->sigma_space_lambda_2_n_per_mm,
        .space_lambda_3_n_per_mm = measured->sigma_space_lambda_3_n_per_mm,
        .k_across_n_per_mm = measured->sigma_k_across_n_per_mm,
    };
    (void)brace_can_pack_sigma_fd(&message, data);
}

void brace_can_make_interval_fd(const brace_measured_t *measured, float age_ms, uint8_t *data)
{
    (void)age_ms;
    const brace_can_interval_fd_t message = {
        .sequence = measured->sequence & 0xffu,
        .parameter_tag = measured->parameter_crc & 0xffffu,
        .force_x_low_n = measured->force_x_low_n,
        .force_x_high_n = measured->force_x_high_n,
        .force_z_low_n = measured->force_z_low_n,
        .force_z_high_n = measured->force_z_high_n,
        .load_femur_low_n_mm = measured->load_femur_low_n_mm,
        .load_femur_high_n_mm = measured->load_femur_high_n_mm,
        .load_tibia_low_n_mm = measured->load_tibia_low_n_mm,
        .load_tibia_high_n_mm = measured->load_tibia_high_n_mm,
        .force_y_low_n = measured->force_y_low_n,
        .force_y_high_n = measured->force_y_high_n,
        .load_coxa_low_n_mm = measured->load_coxa_low_n_mm,
        .load_coxa_high_n_mm = measured->load_coxa_high_n_mm,
    };
    (void)brace_can_pack_interval_fd(&message, data);
}
