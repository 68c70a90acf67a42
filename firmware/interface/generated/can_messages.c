/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/can_messages.h"

#include "can_bits.h"

const uint8_t brace_can_answer_parts[32] = {0, 1, 1, 3, 3, 3, 2, 1, 1, 1, 1, 1, 2, 2, 1, 1, 1, 1, 1, 1, 4, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};

uint32_t brace_can_pack_emergency(const brace_can_emergency_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->error_code, 0u, 16u, &limited);
    bits |= brace_bits_number(message->error_register, 16u, 8u, &limited);
    bits |= brace_bits_number(message->mode, 24u, 8u, &limited);
    bits |= brace_bits_number(message->faults, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_emergency(const uint8_t data[8], brace_can_emergency_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->error_code = brace_value_number(bits, 0u, 16u);
    message->error_register = brace_value_number(bits, 16u, 8u);
    message->mode = brace_value_number(bits, 24u, 8u);
    message->faults = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_stiffness_a(const brace_can_stiffness_a_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_number(message->flags, 8u, 8u, &limited);
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_stiffness_a(const uint8_t data[8], brace_can_stiffness_a_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->flags = brace_value_number(bits, 8u, 8u);
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_stiffness_b(const brace_can_stiffness_b_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->sequence, 0u, 8u, &limited);
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 8u, 24u, &limited);
    bits |= brace_bits_unsigned(message->age_ms, 2.0f, 32u, 8u, &limited);
    bits |= brace_bits_number(message->play_femur, 40u, 4u, &limited);
    bits |= brace_bits_number(message->play_tibia, 44u, 4u, &limited);
    bits |= brace_bits_number(message->parameter_tag, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_stiffness_b(const uint8_t data[8], brace_can_stiffness_b_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->k_zz_n_per_mm = brace_value_signed(bits, 8u, 24u, 0.0005f);
    message->age_ms = brace_value_unsigned(bits, 32u, 8u, 0.5f);
    message->play_femur = brace_value_number(bits, 40u, 4u);
    message->play_tibia = brace_value_number(bits, 44u, 4u);
    message->parameter_tag = brace_value_number(bits, 48u, 16u);
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
    bits |= brace_bits_number(message->mode, 48u, 4u, &limited);
    bits |= brace_bits_number(message->faults, 52u, 12u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_posture(const uint8_t data[8], brace_can_posture_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->sequence = brace_value_number(bits, 0u, 8u);
    message->theta1_rad = brace_value_signed(bits, 8u, 20u, 2e-05f);
    message->theta2_rad = brace_value_signed(bits, 28u, 20u, 2e-05f);
    message->mode = brace_value_number(bits, 48u, 4u);
    message->faults = brace_value_number(bits, 52u, 12u);
}

uint32_t brace_can_pack_heartbeat(const brace_can_heartbeat_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits |= brace_bits_number(message->state, 0u, 8u, &limited);
    bits |= brace_bits_number(message->mode, 8u, 8u, &limited);
    bits |= brace_bits_number(message->faults, 16u, 16u, &limited);
    bits |= brace_bits_number(message->dictionary_hash, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_heartbeat(const uint8_t data[8], brace_can_heartbeat_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->state = brace_value_number(bits, 0u, 8u);
    message->mode = brace_value_number(bits, 8u, 8u);
    message->faults = brace_value_number(bits, 16u, 16u);
    message->dictionary_hash = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_read_entry_request(const brace_can_read_entry_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 1u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->index, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_read_entry_request(const uint8_t data[8], brace_can_read_entry_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->index = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_read_entry_answer_0(const brace_can_read_entry_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 1u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->index, 16u, 16u, &limited);
    bits |= brace_bits_number(message->value, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_read_entry_answer_0(const uint8_t data[8], brace_can_read_entry_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->index = brace_value_number(bits, 16u, 16u);
    message->value = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_write_entry_request(const brace_can_write_entry_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 2u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->index, 16u, 16u, &limited);
    bits |= brace_bits_number(message->value, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_write_entry_request(const uint8_t data[8], brace_can_write_entry_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->index = brace_value_number(bits, 16u, 16u);
    message->value = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_write_entry_answer_0(const brace_can_write_entry_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 2u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->index, 16u, 16u, &limited);
    bits |= brace_bits_number(message->value, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_write_entry_answer_0(const uint8_t data[8], brace_can_write_entry_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->index = brace_value_number(bits, 16u, 16u);
    message->value = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_k_at_posture_request(const brace_can_k_at_posture_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 3u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->theta1_rad, 1000000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->theta2_rad, 1000000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_posture_request(const uint8_t data[8], brace_can_k_at_posture_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->theta1_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
    message->theta2_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
}

uint32_t brace_can_pack_k_at_posture_answer_0(const brace_can_k_at_posture_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 3u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_posture_answer_0(const uint8_t data[8], brace_can_k_at_posture_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_posture_answer_1(const brace_can_k_at_posture_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 35u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_posture_answer_1(const uint8_t data[8], brace_can_k_at_posture_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_posture_answer_2(const brace_can_k_at_posture_answer_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 67u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(message->flags, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_posture_answer_2(const uint8_t data[8], brace_can_k_at_posture_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
    message->flags = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_k_at_tip_knee_up_request(const brace_can_k_at_tip_knee_up_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->x_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->z_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_up_request(const uint8_t data[8], brace_can_k_at_tip_knee_up_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_at_tip_knee_up_answer_0(const brace_can_k_at_tip_knee_up_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 4u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_up_answer_0(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_tip_knee_up_answer_1(const brace_can_k_at_tip_knee_up_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 36u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_up_answer_1(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_tip_knee_up_answer_2(const brace_can_k_at_tip_knee_up_answer_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 68u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(message->flags, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_up_answer_2(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
    message->flags = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_k_at_tip_knee_down_request(const brace_can_k_at_tip_knee_down_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 5u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->x_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->z_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_request(const uint8_t data[8], brace_can_k_at_tip_knee_down_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_0(const brace_can_k_at_tip_knee_down_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 5u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_0(const uint8_t data[8], brace_can_k_at_tip_knee_down_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_1(const brace_can_k_at_tip_knee_down_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 37u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_1(const uint8_t data[8], brace_can_k_at_tip_knee_down_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_2(const brace_can_k_at_tip_knee_down_answer_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 69u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(message->flags, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_2(const uint8_t data[8], brace_can_k_at_tip_knee_down_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
    message->flags = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_contact_force_request(const brace_can_contact_force_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 6u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->dx_mm, 10000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->dz_mm, 10000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_contact_force_request(const uint8_t data[8], brace_can_contact_force_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dx_mm = brace_value_signed(bits, 16u, 24u, 0.0001f);
    message->dz_mm = brace_value_signed(bits, 40u, 24u, 0.0001f);
}

uint32_t brace_can_pack_contact_force_answer_0(const brace_can_contact_force_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 6u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_contact_force_answer_0(const uint8_t data[8], brace_can_contact_force_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->fx_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->fz_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_contact_force_answer_1(const brace_can_contact_force_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 38u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->low_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->high_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_contact_force_answer_1(const uint8_t data[8], brace_can_contact_force_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->low_n = brace_value_unsigned(bits, 16u, 24u, 0.001f);
    message->high_n = brace_value_unsigned(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_sag_for_load_request(const brace_can_sag_for_load_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 7u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sag_for_load_request(const uint8_t data[8], brace_can_sag_for_load_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->fx_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->fz_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_sag_for_load_answer_0(const brace_can_sag_for_load_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 7u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->dx_mm, 10000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->dz_mm, 10000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sag_for_load_answer_0(const uint8_t data[8], brace_can_sag_for_load_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dx_mm = brace_value_signed(bits, 16u, 24u, 0.0001f);
    message->dz_mm = brace_value_signed(bits, 40u, 24u, 0.0001f);
}

uint32_t brace_can_pack_friction_margin_request(const brace_can_friction_margin_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->normal_rad, 10000.0f, 16u, 16u, &limited);
    bits |= brace_bits_unsigned(message->friction_ratio, 1000.0f, 32u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_friction_margin_request(const uint8_t data[8], brace_can_friction_margin_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->normal_rad = brace_value_signed(bits, 16u, 16u, 0.0001f);
    message->friction_ratio = brace_value_unsigned(bits, 32u, 16u, 0.001f);
}

uint32_t brace_can_pack_friction_margin_answer_0(const brace_can_friction_margin_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->margin_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->angle_left_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(message->contact, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_friction_margin_answer_0(const uint8_t data[8], brace_can_friction_margin_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->margin_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->angle_left_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
    message->contact = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_set_mode_request(const brace_can_set_mode_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 9u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->mode, 16u, 8u, &limited);
    bits |= brace_bits_number(message->key, 24u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_set_mode_request(const uint8_t data[8], brace_can_set_mode_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->mode = brace_value_number(bits, 16u, 8u);
    message->key = brace_value_number(bits, 24u, 16u);
}

uint32_t brace_can_pack_set_mode_answer_0(const brace_can_set_mode_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 9u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->mode, 16u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_set_mode_answer_0(const uint8_t data[8], brace_can_set_mode_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->mode = brace_value_number(bits, 16u, 8u);
}

uint32_t brace_can_pack_upload_begin_request(const brace_can_upload_begin_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 10u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->bytes, 16u, 16u, &limited);
    bits |= brace_bits_number(message->crc, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_upload_begin_request(const uint8_t data[8], brace_can_upload_begin_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->bytes = brace_value_number(bits, 16u, 16u);
    message->crc = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_upload_begin_answer_0(const brace_can_upload_begin_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 10u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->words, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_upload_begin_answer_0(const uint8_t data[8], brace_can_upload_begin_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->words = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_upload_word_request(const brace_can_upload_word_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 11u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->word, 16u, 16u, &limited);
    bits |= brace_bits_number(message->data, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_upload_word_request(const uint8_t data[8], brace_can_upload_word_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->word = brace_value_number(bits, 16u, 16u);
    message->data = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_upload_word_answer_0(const brace_can_upload_word_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 11u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->word, 16u, 16u, &limited);
    bits |= brace_bits_number(message->data, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_upload_word_answer_0(const uint8_t data[8], brace_can_upload_word_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->word = brace_value_number(bits, 16u, 16u);
    message->data = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_commit_request(const brace_can_commit_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 12u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->crc, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_commit_request(const uint8_t data[8], brace_can_commit_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->crc = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_commit_answer_0(const brace_can_commit_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 12u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->sequence, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_commit_answer_0(const uint8_t data[8], brace_can_commit_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->sequence = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_commit_answer_1(const brace_can_commit_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 44u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->crc, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_commit_answer_1(const uint8_t data[8], brace_can_commit_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->crc = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_rollback_request(const brace_can_rollback_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 13u | (uint64_t)(message->token & 0xffu) << 8;
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_rollback_request(const uint8_t data[8], brace_can_rollback_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
}

uint32_t brace_can_pack_rollback_answer_0(const brace_can_rollback_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 13u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->sequence, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_rollback_answer_0(const uint8_t data[8], brace_can_rollback_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->sequence = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_rollback_answer_1(const brace_can_rollback_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 45u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->crc, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_rollback_answer_1(const uint8_t data[8], brace_can_rollback_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->crc = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_download_word_request(const brace_can_download_word_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 14u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->word, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_download_word_request(const uint8_t data[8], brace_can_download_word_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->word = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_download_word_answer_0(const brace_can_download_word_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 14u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->word, 16u, 16u, &limited);
    bits |= brace_bits_number(message->data, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_download_word_answer_0(const uint8_t data[8], brace_can_download_word_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->word = brace_value_number(bits, 16u, 16u);
    message->data = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_take_up_request(const brace_can_take_up_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 15u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->joint, 16u, 8u, &limited);
    bits |= brace_bits_whole(message->flank, 24u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_take_up_request(const uint8_t data[8], brace_can_take_up_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->joint = brace_value_number(bits, 16u, 8u);
    message->flank = brace_value_whole(bits, 24u, 8u);
}

uint32_t brace_can_pack_take_up_answer_0(const brace_can_take_up_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 15u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->phase, 16u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_take_up_answer_0(const uint8_t data[8], brace_can_take_up_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->phase = brace_value_number(bits, 16u, 8u);
}

uint32_t brace_can_pack_let_go_request(const brace_can_let_go_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 16u | (uint64_t)(message->token & 0xffu) << 8;
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_let_go_request(const uint8_t data[8], brace_can_let_go_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
}

uint32_t brace_can_pack_let_go_answer_0(const brace_can_let_go_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 16u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->mode, 16u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_let_go_answer_0(const uint8_t data[8], brace_can_let_go_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->mode = brace_value_number(bits, 16u, 8u);
}

uint32_t brace_can_pack_loading_test_start_request(const brace_can_loading_test_start_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 17u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->axis, 16u, 8u, &limited);
    bits |= brace_bits_number(message->steps_per_side, 24u, 8u, &limited);
    bits |= brace_bits_unsigned(message->step_mm, 1000.0f, 32u, 16u, &limited);
    bits |= brace_bits_number(message->dwell_ms, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_start_request(const uint8_t data[8], brace_can_loading_test_start_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->axis = brace_value_number(bits, 16u, 8u);
    message->steps_per_side = brace_value_number(bits, 24u, 8u);
    message->step_mm = brace_value_unsigned(bits, 32u, 16u, 0.001f);
    message->dwell_ms = brace_value_number(bits, 48u, 16u);
}

uint32_t brace_can_pack_loading_test_start_answer_0(const brace_can_loading_test_start_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 17u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->rows, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_start_answer_0(const uint8_t data[8], brace_can_loading_test_start_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->rows = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_loading_test_stop_request(const brace_can_loading_test_stop_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 18u | (uint64_t)(message->token & 0xffu) << 8;
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_stop_request(const uint8_t data[8], brace_can_loading_test_stop_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
}

uint32_t brace_can_pack_loading_test_stop_answer_0(const brace_can_loading_test_stop_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 18u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->rows, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_stop_answer_0(const uint8_t data[8], brace_can_loading_test_stop_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->rows = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_fetch_row_request(const brace_can_fetch_row_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 19u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->row, 16u, 16u, &limited);
    bits |= brace_bits_number(message->column, 32u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_fetch_row_request(const uint8_t data[8], brace_can_fetch_row_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->row = brace_value_number(bits, 16u, 16u);
    message->column = brace_value_number(bits, 32u, 8u);
}

uint32_t brace_can_pack_fetch_row_answer_0(const brace_can_fetch_row_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 19u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->row, 16u, 10u, &limited);
    bits |= brace_bits_number(message->column, 26u, 6u, &limited);
    bits |= brace_bits_float(message->value, 32u);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_fetch_row_answer_0(const uint8_t data[8], brace_can_fetch_row_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->row = brace_value_number(bits, 16u, 10u);
    message->column = brace_value_number(bits, 26u, 6u);
    message->value = brace_value_float(bits, 32u);
}

uint32_t brace_can_pack_identify_request(const brace_can_identify_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 20u | (uint64_t)(message->token & 0xffu) << 8;
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_identify_request(const uint8_t data[8], brace_can_identify_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
}

uint32_t brace_can_pack_identify_answer_0(const brace_can_identify_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 20u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->major, 16u, 8u, &limited);
    bits |= brace_bits_number(message->minor, 24u, 8u, &limited);
    bits |= brace_bits_number(message->patch, 32u, 8u, &limited);
    bits |= brace_bits_number(message->protocol, 40u, 8u, &limited);
    bits |= brace_bits_number(message->node, 48u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_identify_answer_0(const uint8_t data[8], brace_can_identify_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->major = brace_value_number(bits, 16u, 8u);
    message->minor = brace_value_number(bits, 24u, 8u);
    message->patch = brace_value_number(bits, 32u, 8u);
    message->protocol = brace_value_number(bits, 40u, 8u);
    message->node = brace_value_number(bits, 48u, 8u);
}

uint32_t brace_can_pack_identify_answer_1(const brace_can_identify_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 52u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->dictionary_hash, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_identify_answer_1(const uint8_t data[8], brace_can_identify_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dictionary_hash = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_identify_answer_2(const brace_can_identify_answer_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 84u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->schema_hash, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_identify_answer_2(const uint8_t data[8], brace_can_identify_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->schema_hash = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_identify_answer_3(const brace_can_identify_answer_3_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 116u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->parameter_crc, 16u, 32u, &limited);
    bits |= brace_bits_number(message->origin, 48u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_identify_answer_3(const uint8_t data[8], brace_can_identify_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->parameter_crc = brace_value_number(bits, 16u, 32u);
    message->origin = brace_value_number(bits, 48u, 8u);
}

uint32_t brace_can_pack_loading_test_result_request(const brace_can_loading_test_result_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 21u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->item, 16u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_result_request(const uint8_t data[8], brace_can_loading_test_result_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->item = brace_value_number(bits, 16u, 8u);
}

uint32_t brace_can_pack_loading_test_result_answer_0(const brace_can_loading_test_result_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 21u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->item, 16u, 8u, &limited);
    bits |= brace_bits_whole(message->outcome, 24u, 8u, &limited);
    bits |= brace_bits_float(message->value, 32u);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_result_answer_0(const uint8_t data[8], brace_can_loading_test_result_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->item = brace_value_number(bits, 16u, 8u);
    message->outcome = brace_value_whole(bits, 24u, 8u);
    message->value = brace_value_float(bits, 32u);
}

uint32_t brace_can_pack_clear_request(const brace_can_clear_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 22u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->faults, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_clear_request(const uint8_t data[8], brace_can_clear_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->faults = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_clear_answer_0(const brace_can_clear_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 22u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->faults, 16u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_clear_answer_0(const uint8_t data[8], brace_can_clear_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->faults = brace_value_number(bits, 16u, 32u);
}

uint32_t brace_can_pack_refusal(const brace_can_refusal_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 224u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_whole(message->status, 16u, 8u, &limited);
    bits |= brace_bits_number(message->detail, 24u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_refusal(const uint8_t data[8], brace_can_refusal_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->status = brace_value_whole(bits, 16u, 8u);
    message->detail = brace_value_number(bits, 24u, 32u);
}
