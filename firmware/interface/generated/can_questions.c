/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/can_messages.h"

#include "can_bits.h"

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

uint32_t brace_can_pack_k_at_tip_knee_down_request(const brace_can_k_at_tip_knee_down_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 5u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->x_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->z_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_request(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
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

uint32_t brace_can_pack_loading_test_start_request(const brace_can_loading_test_start_request_t *message,
    uint8_t data[8])
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

void brace_can_unpack_loading_test_start_request(const uint8_t data[8],
    brace_can_loading_test_start_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->axis = brace_value_number(bits, 16u, 8u);
    message->steps_per_side = brace_value_number(bits, 24u, 8u);
    message->step_mm = brace_value_unsigned(bits, 32u, 16u, 0.001f);
    message->dwell_ms = brace_value_number(bits, 48u, 16u);
}

uint32_t brace_can_pack_loading_test_stop_request(const brace_can_loading_test_stop_request_t *message,
    uint8_t data[8])
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

uint32_t brace_can_pack_loading_test_result_request(const brace_can_loading_test_result_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 21u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->item, 16u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_result_request(const uint8_t data[8],
    brace_can_loading_test_result_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->item = brace_value_number(bits, 16u, 8u);
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

uint32_t brace_can_pack_k_in_space_at_posture_request(const brace_can_k_in_space_at_posture_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 23u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->theta0_rad, 10000.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(message->theta1_rad, 10000.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(message->theta2_rad, 10000.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_request(const uint8_t data[8],
    brace_can_k_in_space_at_posture_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->theta0_rad = brace_value_signed(bits, 16u, 16u, 0.0001f);
    message->theta1_rad = brace_value_signed(bits, 32u, 16u, 0.0001f);
    message->theta2_rad = brace_value_signed(bits, 48u, 16u, 0.0001f);
}

uint32_t brace_can_pack_drift_request(const brace_can_drift_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 24u | (uint64_t)(message->token & 0xffu) << 8;
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_drift_request(const uint8_t data[8], brace_can_drift_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
}

uint32_t brace_can_pack_take_up_result_request(const brace_can_take_up_result_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 25u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->joint, 16u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_take_up_result_request(const uint8_t data[8], brace_can_take_up_result_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->joint = brace_value_number(bits, 16u, 8u);
}

uint32_t brace_can_pack_set_gravity_request(const brace_can_set_gravity_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 26u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->direction_rad, 1000000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->lean_rad, 1000000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_set_gravity_request(const uint8_t data[8], brace_can_set_gravity_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->direction_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
    message->lean_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
}

uint32_t brace_can_pack_tip_force_request(const brace_can_tip_force_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 27u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_tip_force_request(const uint8_t data[8], brace_can_tip_force_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->fx_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->fz_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_under_load_at_posture_request(const brace_can_k_under_load_at_posture_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 28u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->theta1_rad, 1000000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->theta2_rad, 1000000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_posture_request(const uint8_t data[8],
    brace_can_k_under_load_at_posture_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->theta1_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
    message->theta2_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_up_request(const brace_can_k_under_load_at_tip_knee_up_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 29u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->x_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->z_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_up_request(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_down_request(const brace_can_k_under_load_at_tip_knee_down_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 30u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->x_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->z_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_down_request(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->x_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->z_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_tip_force_in_space_request(const brace_can_tip_force_in_space_request_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 31u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->fx_n, 100.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(message->fy_n, 100.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(message->fz_n, 100.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_tip_force_in_space_request(const uint8_t data[8],
    brace_can_tip_force_in_space_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->fx_n = brace_value_signed(bits, 16u, 16u, 0.01f);
    message->fy_n = brace_value_signed(bits, 32u, 16u, 0.01f);
    message->fz_n = brace_value_signed(bits, 48u, 16u, 0.01f);
}

uint32_t brace_can_pack_sign_of_life_request(const brace_can_sign_of_life_request_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 32u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->heard, 16u, 16u, &limited);
    bits |= brace_bits_number(message->check, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sign_of_life_request(const uint8_t data[8], brace_can_sign_of_life_request_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->heard = brace_value_number(bits, 16u, 16u);
    message->check = brace_value_number(bits, 32u, 32u);
}
