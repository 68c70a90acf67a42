/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/can_messages.h"

#include "can_bits.h"

uint32_t brace_can_pack_emergency(const brace_can_emergency_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->error_code, 0u, 16u, &limited);
    bits |= brace_bits_number(message->error_register, 16u, 4u, &limited);
    bits |= brace_bits_number(message->drift_cause, 20u, 4u, &limited);
    bits |= brace_bits_number(message->mode, 24u, 8u, &limited);
    bits |= brace_bits_number(message->faults, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_emergency(const uint8_t data[8], brace_can_emergency_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->error_code = brace_value_number(bits, 0u, 16u);
    message->error_register = brace_value_number(bits, 16u, 4u);
    message->drift_cause = brace_value_number(bits, 20u, 4u);
    message->mode = brace_value_number(bits, 24u, 8u);
    message->faults = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_stiffness_a(const brace_can_stiffness_a_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 8u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 32u, 24u, &limited);
    bits |= brace_bits_unsigned(message->age_ms, 2.0f, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_stiffness_a(const uint8_t data[8], brace_can_stiffness_a_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_xx_n_per_mm = brace_value_signed(bits, 8u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 32u, 24u, 0.0005f);
    message->age_ms = brace_value_unsigned(bits, 56u, 8u, 0.5f);
}

uint32_t brace_can_pack_stiffness_b(const brace_can_stiffness_b_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 8u, 24u, &limited);
    bits |= brace_bits_number(message->flags, 32u, 16u, &limited);
    bits |= brace_bits_number(message->play_femur, 48u, 4u, &limited);
    bits |= brace_bits_number(message->play_tibia, 52u, 4u, &limited);
    bits |= brace_bits_number(message->mode, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_stiffness_b(const uint8_t data[8], brace_can_stiffness_b_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_zz_n_per_mm = brace_value_signed(bits, 8u, 24u, 0.0005f);
    message->flags = brace_value_number(bits, 32u, 16u);
    message->play_femur = brace_value_number(bits, 48u, 4u);
    message->play_tibia = brace_value_number(bits, 52u, 4u);
    message->mode = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_eigenvalues(const brace_can_eigenvalues_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 8u, 20u, &limited);
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 200.0f, 28u, 20u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_eigenvalues(const uint8_t data[8], brace_can_eigenvalues_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 8u, 20u, 0.0005f);
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 28u, 20u, 0.005f);
    message->stiff_axis_rad = brace_value_signed(bits, 48u, 16u, 0.0001f);
}

uint32_t brace_can_pack_posture(const brace_can_posture_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->theta1_rad, 50000.0f, 8u, 20u, &limited);
    bits |= brace_bits_signed(message->theta2_rad, 50000.0f, 28u, 20u, &limited);
    bits |= brace_bits_number(message->parameter_tag, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_posture(const uint8_t data[8], brace_can_posture_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->theta1_rad = brace_value_signed(bits, 8u, 20u, 2e-05f);
    message->theta2_rad = brace_value_signed(bits, 28u, 20u, 2e-05f);
    message->parameter_tag = brace_value_number(bits, 48u, 16u);
}

uint32_t brace_can_pack_heartbeat(const brace_can_heartbeat_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->state, 0u, 8u, &limited);
    bits |= brace_bits_number(message->mode, 8u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 16u, 8u, &limited);
    bits |= brace_bits_number(message->protocol, 24u, 8u, &limited);
    bits |= brace_bits_number(message->dictionary_hash, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_heartbeat(const uint8_t data[8], brace_can_heartbeat_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->state = brace_value_number(bits, 0u, 8u);
    message->mode = brace_value_number(bits, 8u, 8u);
    message->setting = brace_value_number(bits, 16u, 8u);
    message->protocol = brace_value_number(bits, 24u, 8u);
    message->dictionary_hash = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_condition(const brace_can_condition_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_number(message->faults, 16u, 32u, &limited);
    bits |= brace_bits_number(message->mode, 48u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_condition(const uint8_t data[8], brace_can_condition_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->faults = brace_value_number(bits, 16u, 32u);
    message->mode = brace_value_number(bits, 48u, 8u);
    message->setting = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_space_0(const brace_can_space_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4096u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_0(const uint8_t data[8], brace_can_space_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xy_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_space_1(const brace_can_space_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4352u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_yy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_1(const uint8_t data[8], brace_can_space_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_xz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_yy_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_space_2(const brace_can_space_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4608u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->k_yz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_2(const uint8_t data[8], brace_can_space_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_yz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_zz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_space_3(const brace_can_space_3_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4864u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->lambda_1_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_2_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_3(const uint8_t data[8], brace_can_space_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->lambda_1_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->lambda_2_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_space_4(const brace_can_space_4_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 5120u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->lambda_3_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_number(message->flags, 40u, 16u, &limited);
    bits |= brace_bits_unsigned(message->age_ms, 2.0f, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_4(const uint8_t data[8], brace_can_space_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->lambda_3_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->flags = brace_value_number(bits, 40u, 16u);
    message->age_ms = brace_value_unsigned(bits, 56u, 8u, 0.5f);
}

uint32_t brace_can_pack_space_5(const brace_can_space_5_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 5376u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_x, 20000.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_y, 20000.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_z, 20000.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_5(const uint8_t data[8], brace_can_space_5_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->stiff_axis_x = brace_value_signed(bits, 16u, 16u, 5e-05f);
    message->stiff_axis_y = brace_value_signed(bits, 32u, 16u, 5e-05f);
    message->stiff_axis_z = brace_value_signed(bits, 48u, 16u, 5e-05f);
}

uint32_t brace_can_pack_space_6(const brace_can_space_6_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 5632u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->theta0_rad, 50000.0f, 16u, 20u, &limited);
    bits |= brace_bits_unsigned(message->k_across_n_per_mm, 2000.0f, 36u, 24u, &limited);
    bits |= brace_bits_number(message->play_coxa, 60u, 4u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_space_6(const uint8_t data[8], brace_can_space_6_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->theta0_rad = brace_value_signed(bits, 16u, 20u, 2e-05f);
    message->k_across_n_per_mm = brace_value_unsigned(bits, 36u, 24u, 0.0005f);
    message->play_coxa = brace_value_number(bits, 60u, 4u);
}

uint32_t brace_can_pack_load_0(const brace_can_load_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8192u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->unloaded_k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->unloaded_k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_0(const uint8_t data[8], brace_can_load_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->unloaded_k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->unloaded_k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_load_1(const brace_can_load_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8448u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->unloaded_k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_number(message->flags, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_1(const uint8_t data[8], brace_can_load_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->unloaded_k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->flags = brace_value_number(bits, 40u, 16u);
}

uint32_t brace_can_pack_load_2(const brace_can_load_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8704u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->counted_force_x_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->counted_force_z_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_2(const uint8_t data[8], brace_can_load_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->counted_force_x_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->counted_force_z_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_load_3(const brace_can_load_3_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8960u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->moved_x_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->moved_z_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_3(const uint8_t data[8], brace_can_load_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->moved_x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->moved_z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_load_4(const brace_can_load_4_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 9216u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_float(message->buckling_factor, 16u);
    bits |= brace_bits_signed(message->gravity_direction_rad, 10000.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_4(const uint8_t data[8], brace_can_load_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->buckling_factor = brace_value_float(bits, 16u);
    message->gravity_direction_rad = brace_value_signed(bits, 48u, 16u, 0.0001f);
}

uint32_t brace_can_pack_load_5(const brace_can_load_5_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 9472u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->gravity_lean_rad, 10000.0f, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_5(const uint8_t data[8], brace_can_load_5_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->gravity_lean_rad = brace_value_signed(bits, 16u, 16u, 0.0001f);
}

uint32_t brace_can_pack_load_across_0(const brace_can_load_across_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 12288u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->counted_force_y_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->moved_y_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_across_0(const uint8_t data[8], brace_can_load_across_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->counted_force_y_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->moved_y_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_load_across_1(const brace_can_load_across_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 12544u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->unloaded_k_across_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_number(message->flags, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_load_across_1(const uint8_t data[8], brace_can_load_across_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->unloaded_k_across_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->flags = brace_value_number(bits, 40u, 16u);
}

uint32_t brace_can_pack_sigma_0(const brace_can_sigma_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 16384u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->k_xx_n_per_mm, 500.0f, 16u, 16u, &limited);
    bits |= brace_bits_unsigned(message->k_xz_n_per_mm, 500.0f, 32u, 16u, &limited);
    bits |= brace_bits_unsigned(message->k_zz_n_per_mm, 500.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sigma_0(const uint8_t data[8], brace_can_sigma_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_xx_n_per_mm = brace_value_unsigned(bits, 16u, 16u, 0.002f);
    message->k_xz_n_per_mm = brace_value_unsigned(bits, 32u, 16u, 0.002f);
    message->k_zz_n_per_mm = brace_value_unsigned(bits, 48u, 16u, 0.002f);
}

uint32_t brace_can_pack_sigma_1(const brace_can_sigma_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 16640u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 16u, 16u, &limited);
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 250.0f, 32u, 16u, &limited);
    bits |= brace_bits_unsigned(message->stiff_axis_rad, 10000.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sigma_1(const uint8_t data[8], brace_can_sigma_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 16u, 16u, 0.0005f);
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 32u, 16u, 0.004f);
    message->stiff_axis_rad = brace_value_unsigned(bits, 48u, 16u, 0.0001f);
}

uint32_t brace_can_pack_sigma_space_0(const brace_can_sigma_space_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 20480u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->k_xx_n_per_mm, 500.0f, 16u, 16u, &limited);
    bits |= brace_bits_unsigned(message->k_xy_n_per_mm, 500.0f, 32u, 16u, &limited);
    bits |= brace_bits_unsigned(message->k_xz_n_per_mm, 500.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sigma_space_0(const uint8_t data[8], brace_can_sigma_space_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_xx_n_per_mm = brace_value_unsigned(bits, 16u, 16u, 0.002f);
    message->k_xy_n_per_mm = brace_value_unsigned(bits, 32u, 16u, 0.002f);
    message->k_xz_n_per_mm = brace_value_unsigned(bits, 48u, 16u, 0.002f);
}

uint32_t brace_can_pack_sigma_space_1(const brace_can_sigma_space_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 20736u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->k_yy_n_per_mm, 500.0f, 16u, 16u, &limited);
    bits |= brace_bits_unsigned(message->k_yz_n_per_mm, 500.0f, 32u, 16u, &limited);
    bits |= brace_bits_unsigned(message->k_zz_n_per_mm, 500.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sigma_space_1(const uint8_t data[8], brace_can_sigma_space_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_yy_n_per_mm = brace_value_unsigned(bits, 16u, 16u, 0.002f);
    message->k_yz_n_per_mm = brace_value_unsigned(bits, 32u, 16u, 0.002f);
    message->k_zz_n_per_mm = brace_value_unsigned(bits, 48u, 16u, 0.002f);
}

uint32_t brace_can_pack_sigma_space_2(const brace_can_sigma_space_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 20992u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->lambda_1_n_per_mm, 2000.0f, 16u, 16u, &limited);
    bits |= brace_bits_unsigned(message->lambda_2_n_per_mm, 500.0f, 32u, 16u, &limited);
    bits |= brace_bits_unsigned(message->lambda_3_n_per_mm, 250.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sigma_space_2(const uint8_t data[8], brace_can_sigma_space_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->lambda_1_n_per_mm = brace_value_unsigned(bits, 16u, 16u, 0.0005f);
    message->lambda_2_n_per_mm = brace_value_unsigned(bits, 32u, 16u, 0.002f);
    message->lambda_3_n_per_mm = brace_value_unsigned(bits, 48u, 16u, 0.004f);
}

uint32_t brace_can_pack_sigma_space_3(const brace_can_sigma_space_3_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 21248u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->k_across_n_per_mm, 500.0f, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sigma_space_3(const uint8_t data[8], brace_can_sigma_space_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_across_n_per_mm = brace_value_unsigned(bits, 16u, 16u, 0.002f);
}

uint32_t brace_can_pack_interval_0(const brace_can_interval_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 24576u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->force_x_low_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->force_x_high_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_interval_0(const uint8_t data[8], brace_can_interval_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->force_x_low_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->force_x_high_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_interval_1(const brace_can_interval_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 24832u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->force_z_low_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->force_z_high_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_interval_1(const uint8_t data[8], brace_can_interval_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->force_z_low_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->force_z_high_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_interval_2(const brace_can_interval_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 25088u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->load_femur_low_n_mm, 5.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->load_femur_high_n_mm, 5.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_interval_2(const uint8_t data[8], brace_can_interval_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->load_femur_low_n_mm = brace_value_signed(bits, 16u, 24u, 0.2f);
    message->load_femur_high_n_mm = brace_value_signed(bits, 40u, 24u, 0.2f);
}

uint32_t brace_can_pack_interval_3(const brace_can_interval_3_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 25344u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->load_tibia_low_n_mm, 5.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->load_tibia_high_n_mm, 5.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_interval_3(const uint8_t data[8], brace_can_interval_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->load_tibia_low_n_mm = brace_value_signed(bits, 16u, 24u, 0.2f);
    message->load_tibia_high_n_mm = brace_value_signed(bits, 40u, 24u, 0.2f);
}

uint32_t brace_can_pack_interval_across_0(const brace_can_interval_across_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 28672u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->force_y_low_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->force_y_high_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_interval_across_0(const uint8_t data[8], brace_can_interval_across_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->force_y_low_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->force_y_high_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_interval_across_1(const brace_can_interval_across_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 28928u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->load_coxa_low_n_mm, 5.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->load_coxa_high_n_mm, 5.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_interval_across_1(const uint8_t data[8], brace_can_interval_across_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->load_coxa_low_n_mm = brace_value_signed(bits, 16u, 24u, 0.2f);
    message->load_coxa_high_n_mm = brace_value_signed(bits, 40u, 24u, 0.2f);
}

uint32_t brace_can_pack_snapshot_fd(const brace_can_snapshot_fd_t *message, uint8_t data[64])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 32u, &limited);
    bits |= brace_bits_number(message->parameter_tag, 32u, 16u, &limited);
    bits |= brace_bits_unsigned(message->age_ms, 2.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    bits = 0u;
    bits |= brace_bits_number(message->flags, 0u, 16u, &limited);
    bits |= brace_bits_number(message->mode, 16u, 8u, &limited);
    bits |= brace_bits_number(message->play_femur, 24u, 4u, &limited);
    bits |= brace_bits_number(message->play_tibia, 28u, 4u, &limited);
    bits |= brace_bits_number(message->faults, 32u, 32u, &limited);
    brace_bits_store(bits, data + 8);
    bits = 0u;
    bits |= brace_bits_float(message->k_xx_n_per_mm, 0u);
    bits |= brace_bits_float(message->k_xz_n_per_mm, 32u);
    brace_bits_store(bits, data + 16);
    bits = 0u;
    bits |= brace_bits_float(message->k_zz_n_per_mm, 0u);
    bits |= brace_bits_float(message->lambda_min_n_per_mm, 32u);
    brace_bits_store(bits, data + 24);
    bits = 0u;
    bits |= brace_bits_float(message->lambda_max_n_per_mm, 0u);
    bits |= brace_bits_float(message->stiff_axis_rad, 32u);
    brace_bits_store(bits, data + 32);
    bits = 0u;
    bits |= brace_bits_float(message->theta1_rad, 0u);
    bits |= brace_bits_float(message->theta2_rad, 32u);
    brace_bits_store(bits, data + 40);
    bits = 0u;
    bits |= brace_bits_float(message->tip_x_mm, 0u);
    bits |= brace_bits_float(message->tip_z_mm, 32u);
    brace_bits_store(bits, data + 48);
    bits = 0u;
    bits |= brace_bits_float(message->force_x_n, 0u);
    bits |= brace_bits_float(message->force_z_n, 32u);
    brace_bits_store(bits, data + 56);
    return limited;
}

void brace_can_unpack_snapshot_fd(const uint8_t data[64], brace_can_snapshot_fd_t *message)
{
    uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 32u);
    message->parameter_tag = brace_value_number(bits, 32u, 16u);
    message->age_ms = brace_value_unsigned(bits, 48u, 16u, 0.5f);
    bits = brace_bits_load(data + 8);
    message->flags = brace_value_number(bits, 0u, 16u);
    message->mode = brace_value_number(bits, 16u, 8u);
    message->play_femur = brace_value_number(bits, 24u, 4u);
    message->play_tibia = brace_value_number(bits, 28u, 4u);
    message->faults = brace_value_number(bits, 32u, 32u);
    bits = brace_bits_load(data + 16);
    message->k_xx_n_per_mm = brace_value_float(bits, 0u);
    message->k_xz_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 24);
    message->k_zz_n_per_mm = brace_value_float(bits, 0u);
    message->lambda_min_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 32);
    message->lambda_max_n_per_mm = brace_value_float(bits, 0u);
    message->stiff_axis_rad = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 40);
    message->theta1_rad = brace_value_float(bits, 0u);
    message->theta2_rad = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 48);
    message->tip_x_mm = brace_value_float(bits, 0u);
    message->tip_z_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 56);
    message->force_x_n = brace_value_float(bits, 0u);
    message->force_z_n = brace_value_float(bits, 32u);
}

uint32_t brace_can_pack_space_fd(const brace_can_space_fd_t *message, uint8_t data[64])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4096u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->age_ms, 2.0f, 16u, 16u, &limited);
    bits |= brace_bits_number(message->flags, 32u, 16u, &limited);
    bits |= brace_bits_number(message->parameter_tag, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    bits = 0u;
    bits |= brace_bits_number(message->mode, 0u, 8u, &limited);
    bits |= brace_bits_number(message->play_coxa, 8u, 8u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_x, 20000.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_y, 20000.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_z, 20000.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data + 8);
    bits = 0u;
    bits |= brace_bits_float(message->theta0_rad, 0u);
    bits |= brace_bits_float(message->k_across_n_per_mm, 32u);
    brace_bits_store(bits, data + 16);
    bits = 0u;
    bits |= brace_bits_float(message->k_xx_n_per_mm, 0u);
    bits |= brace_bits_float(message->k_xy_n_per_mm, 32u);
    brace_bits_store(bits, data + 24);
    bits = 0u;
    bits |= brace_bits_float(message->k_xz_n_per_mm, 0u);
    bits |= brace_bits_float(message->k_yy_n_per_mm, 32u);
    brace_bits_store(bits, data + 32);
    bits = 0u;
    bits |= brace_bits_float(message->k_yz_n_per_mm, 0u);
    bits |= brace_bits_float(message->k_zz_n_per_mm, 32u);
    brace_bits_store(bits, data + 40);
    bits = 0u;
    bits |= brace_bits_float(message->lambda_1_n_per_mm, 0u);
    bits |= brace_bits_float(message->lambda_2_n_per_mm, 32u);
    brace_bits_store(bits, data + 48);
    bits = 0u;
    bits |= brace_bits_float(message->lambda_3_n_per_mm, 0u);
    brace_bits_store(bits, data + 56);
    return limited;
}

void brace_can_unpack_space_fd(const uint8_t data[64], brace_can_space_fd_t *message)
{
    uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->age_ms = brace_value_unsigned(bits, 16u, 16u, 0.5f);
    message->flags = brace_value_number(bits, 32u, 16u);
    message->parameter_tag = brace_value_number(bits, 48u, 16u);
    bits = brace_bits_load(data + 8);
    message->mode = brace_value_number(bits, 0u, 8u);
    message->play_coxa = brace_value_number(bits, 8u, 8u);
    message->stiff_axis_x = brace_value_signed(bits, 16u, 16u, 5e-05f);
    message->stiff_axis_y = brace_value_signed(bits, 32u, 16u, 5e-05f);
    message->stiff_axis_z = brace_value_signed(bits, 48u, 16u, 5e-05f);
    bits = brace_bits_load(data + 16);
    message->theta0_rad = brace_value_float(bits, 0u);
    message->k_across_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 24);
    message->k_xx_n_per_mm = brace_value_float(bits, 0u);
    message->k_xy_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 32);
    message->k_xz_n_per_mm = brace_value_float(bits, 0u);
    message->k_yy_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 40);
    message->k_yz_n_per_mm = brace_value_float(bits, 0u);
    message->k_zz_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 48);
    message->lambda_1_n_per_mm = brace_value_float(bits, 0u);
    message->lambda_2_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 56);
    message->lambda_3_n_per_mm = brace_value_float(bits, 0u);
}

uint32_t brace_can_pack_load_fd(const brace_can_load_fd_t *message, uint8_t data[64])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8192u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->age_ms, 2.0f, 16u, 16u, &limited);
    bits |= brace_bits_number(message->flags, 32u, 16u, &limited);
    bits |= brace_bits_number(message->parameter_tag, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    bits = 0u;
    bits |= brace_bits_float(message->unloaded_k_xx_n_per_mm, 0u);
    bits |= brace_bits_float(message->unloaded_k_xz_n_per_mm, 32u);
    brace_bits_store(bits, data + 8);
    bits = 0u;
    bits |= brace_bits_float(message->unloaded_k_zz_n_per_mm, 0u);
    bits |= brace_bits_float(message->counted_force_x_n, 32u);
    brace_bits_store(bits, data + 16);
    bits = 0u;
    bits |= brace_bits_float(message->counted_force_z_n, 0u);
    bits |= brace_bits_float(message->moved_x_mm, 32u);
    brace_bits_store(bits, data + 24);
    bits = 0u;
    bits |= brace_bits_float(message->moved_z_mm, 0u);
    bits |= brace_bits_float(message->buckling_factor, 32u);
    brace_bits_store(bits, data + 32);
    bits = 0u;
    bits |= brace_bits_float(message->gravity_direction_rad, 0u);
    bits |= brace_bits_float(message->gravity_lean_rad, 32u);
    brace_bits_store(bits, data + 40);
    bits = 0u;
    bits |= brace_bits_float(message->counted_force_y_n, 0u);
    bits |= brace_bits_float(message->moved_y_mm, 32u);
    brace_bits_store(bits, data + 48);
    bits = 0u;
    bits |= brace_bits_float(message->unloaded_k_across_n_per_mm, 0u);
    brace_bits_store(bits, data + 56);
    return limited;
}

void brace_can_unpack_load_fd(const uint8_t data[64], brace_can_load_fd_t *message)
{
    uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->age_ms = brace_value_unsigned(bits, 16u, 16u, 0.5f);
    message->flags = brace_value_number(bits, 32u, 16u);
    message->parameter_tag = brace_value_number(bits, 48u, 16u);
    bits = brace_bits_load(data + 8);
    message->unloaded_k_xx_n_per_mm = brace_value_float(bits, 0u);
    message->unloaded_k_xz_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 16);
    message->unloaded_k_zz_n_per_mm = brace_value_float(bits, 0u);
    message->counted_force_x_n = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 24);
    message->counted_force_z_n = brace_value_float(bits, 0u);
    message->moved_x_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 32);
    message->moved_z_mm = brace_value_float(bits, 0u);
    message->buckling_factor = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 40);
    message->gravity_direction_rad = brace_value_float(bits, 0u);
    message->gravity_lean_rad = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 48);
    message->counted_force_y_n = brace_value_float(bits, 0u);
    message->moved_y_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 56);
    message->unloaded_k_across_n_per_mm = brace_value_float(bits, 0u);
}

uint32_t brace_can_pack_sigma_fd(const brace_can_sigma_fd_t *message, uint8_t data[64])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 16384u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_unsigned(message->stiff_axis_rad, 10000.0f, 16u, 16u, &limited);
    bits |= brace_bits_float(message->k_xx_n_per_mm, 32u);
    brace_bits_store(bits, data);
    bits = 0u;
    bits |= brace_bits_float(message->k_xz_n_per_mm, 0u);
    bits |= brace_bits_float(message->k_zz_n_per_mm, 32u);
    brace_bits_store(bits, data + 8);
    bits = 0u;
    bits |= brace_bits_float(message->lambda_min_n_per_mm, 0u);
    bits |= brace_bits_float(message->lambda_max_n_per_mm, 32u);
    brace_bits_store(bits, data + 16);
    bits = 0u;
    bits |= brace_bits_float(message->space_k_xx_n_per_mm, 0u);
    bits |= brace_bits_float(message->space_k_xy_n_per_mm, 32u);
    brace_bits_store(bits, data + 24);
    bits = 0u;
    bits |= brace_bits_float(message->space_k_xz_n_per_mm, 0u);
    bits |= brace_bits_float(message->space_k_yy_n_per_mm, 32u);
    brace_bits_store(bits, data + 32);
    bits = 0u;
    bits |= brace_bits_float(message->space_k_yz_n_per_mm, 0u);
    bits |= brace_bits_float(message->space_k_zz_n_per_mm, 32u);
    brace_bits_store(bits, data + 40);
    bits = 0u;
    bits |= brace_bits_float(message->space_lambda_1_n_per_mm, 0u);
    bits |= brace_bits_float(message->space_lambda_2_n_per_mm, 32u);
    brace_bits_store(bits, data + 48);
    bits = 0u;
    bits |= brace_bits_float(message->space_lambda_3_n_per_mm, 0u);
    bits |= brace_bits_float(message->k_across_n_per_mm, 32u);
    brace_bits_store(bits, data + 56);
    return limited;
}

void brace_can_unpack_sigma_fd(const uint8_t data[64], brace_can_sigma_fd_t *message)
{
    uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->stiff_axis_rad = brace_value_unsigned(bits, 16u, 16u, 0.0001f);
    message->k_xx_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 8);
    message->k_xz_n_per_mm = brace_value_float(bits, 0u);
    message->k_zz_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 16);
    message->lambda_min_n_per_mm = brace_value_float(bits, 0u);
    message->lambda_max_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 24);
    message->space_k_xx_n_per_mm = brace_value_float(bits, 0u);
    message->space_k_xy_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 32);
    message->space_k_xz_n_per_mm = brace_value_float(bits, 0u);
    message->space_k_yy_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 40);
    message->space_k_yz_n_per_mm = brace_value_float(bits, 0u);
    message->space_k_zz_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 48);
    message->space_lambda_1_n_per_mm = brace_value_float(bits, 0u);
    message->space_lambda_2_n_per_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 56);
    message->space_lambda_3_n_per_mm = brace_value_float(bits, 0u);
    message->k_across_n_per_mm = brace_value_float(bits, 32u);
}

uint32_t brace_can_pack_interval_fd(const brace_can_interval_fd_t *message, uint8_t data[64])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 24576u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_number(message->parameter_tag, 16u, 16u, &limited);
    bits |= brace_bits_float(message->force_x_low_n, 32u);
    brace_bits_store(bits, data);
    bits = 0u;
    bits |= brace_bits_float(message->force_x_high_n, 0u);
    bits |= brace_bits_float(message->force_z_low_n, 32u);
    brace_bits_store(bits, data + 8);
    bits = 0u;
    bits |= brace_bits_float(message->force_z_high_n, 0u);
    bits |= brace_bits_float(message->load_femur_low_n_mm, 32u);
    brace_bits_store(bits, data + 16);
    bits = 0u;
    bits |= brace_bits_float(message->load_femur_high_n_mm, 0u);
    bits |= brace_bits_float(message->load_tibia_low_n_mm, 32u);
    brace_bits_store(bits, data + 24);
    bits = 0u;
    bits |= brace_bits_float(message->load_tibia_high_n_mm, 0u);
    bits |= brace_bits_float(message->force_y_low_n, 32u);
    brace_bits_store(bits, data + 32);
    bits = 0u;
    bits |= brace_bits_float(message->force_y_high_n, 0u);
    bits |= brace_bits_float(message->load_coxa_low_n_mm, 32u);
    brace_bits_store(bits, data + 40);
    bits = 0u;
    bits |= brace_bits_float(message->load_coxa_high_n_mm, 0u);
    brace_bits_store(bits, data + 48);
    bits = 0u;
    brace_bits_store(bits, data + 56);
    return limited;
}

void brace_can_unpack_interval_fd(const uint8_t data[64], brace_can_interval_fd_t *message)
{
    uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->parameter_tag = brace_value_number(bits, 16u, 16u);
    message->force_x_low_n = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 8);
    message->force_x_high_n = brace_value_float(bits, 0u);
    message->force_z_low_n = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 16);
    message->force_z_high_n = brace_value_float(bits, 0u);
    message->load_femur_low_n_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 24);
    message->load_femur_high_n_mm = brace_value_float(bits, 0u);
    message->load_tibia_low_n_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 32);
    message->load_tibia_high_n_mm = brace_value_float(bits, 0u);
    message->force_y_low_n = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 40);
    message->force_y_high_n = brace_value_float(bits, 0u);
    message->load_coxa_low_n_mm = brace_value_float(bits, 32u);
    bits = brace_bits_load(data + 48);
    message->load_coxa_high_n_mm = brace_value_float(bits, 0u);
    bits = brace_bits_load(data + 56);
}

uint32_t brace_can_details_part(const uint8_t *data)
{
    return brace_value_number(brace_bits_load(data), 8u, 8u);
}

uint32_t brace_can_details_fd_part(const uint8_t *data)
{
    return brace_value_number(brace_bits_load(data), 8u, 8u);
}
