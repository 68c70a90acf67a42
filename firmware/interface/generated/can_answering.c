/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/can_answering.h"

#include "brace/status.h"
#include "can_bits.h"

void brace_can_pack_read_entry_answer(const brace_can_read_entry_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 1u | token_bits;
    bits |= brace_bits_number(answer->index, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->value, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_write_entry_answer(const brace_can_write_entry_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 2u | token_bits;
    bits |= brace_bits_number(answer->index, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->value, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_k_at_posture_answer(const brace_can_k_at_posture_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 3u | token_bits;
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 35u | token_bits;
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = 67u | token_bits;
    bits |= brace_bits_unsigned(answer->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 56u, 8u, &limited);
    brace_bits_store(bits, parts[2]);
}

void brace_can_pack_k_at_tip_knee_up_answer(const brace_can_k_at_tip_knee_up_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 4u | token_bits;
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 36u | token_bits;
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = 68u | token_bits;
    bits |= brace_bits_unsigned(answer->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 56u, 8u, &limited);
    brace_bits_store(bits, parts[2]);
}

void brace_can_pack_k_at_tip_knee_down_answer(const brace_can_k_at_tip_knee_down_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 5u | token_bits;
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 37u | token_bits;
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = 69u | token_bits;
    bits |= brace_bits_unsigned(answer->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 56u, 8u, &limited);
    brace_bits_store(bits, parts[2]);
}

void brace_can_pack_contact_force_answer(const brace_can_contact_force_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 6u | token_bits;
    bits |= brace_bits_signed(answer->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 38u | token_bits;
    bits |= brace_bits_unsigned(answer->low_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->high_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
}

void brace_can_pack_sag_for_load_answer(const brace_can_sag_for_load_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 7u | token_bits;
    bits |= brace_bits_signed(answer->dx_mm, 10000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->dz_mm, 10000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_friction_margin_answer(const brace_can_friction_margin_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 8u | token_bits;
    bits |= brace_bits_signed(answer->margin_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->angle_left_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(answer->contact, 56u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_set_mode_answer(const brace_can_set_mode_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 9u | token_bits;
    bits |= brace_bits_number(answer->mode, 16u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_upload_begin_answer(const brace_can_upload_begin_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 10u | token_bits;
    bits |= brace_bits_number(answer->words, 16u, 16u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_upload_word_answer(const brace_can_upload_word_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 11u | token_bits;
    bits |= brace_bits_number(answer->word, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->data, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_commit_answer(const brace_can_commit_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 12u | token_bits;
    bits |= brace_bits_number(answer->sequence, 16u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 44u | token_bits;
    bits |= brace_bits_number(answer->crc, 16u, 32u, &limited);
    brace_bits_store(bits, parts[1]);
}

void brace_can_pack_rollback_answer(const brace_can_rollback_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 13u | token_bits;
    bits |= brace_bits_number(answer->sequence, 16u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 45u | token_bits;
    bits |= brace_bits_number(answer->crc, 16u, 32u, &limited);
    brace_bits_store(bits, parts[1]);
}

void brace_can_pack_download_word_answer(const brace_can_download_word_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 14u | token_bits;
    bits |= brace_bits_number(answer->word, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->data, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_take_up_answer(const brace_can_take_up_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 15u | token_bits;
    bits |= brace_bits_number(answer->phase, 16u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_let_go_answer(const brace_can_let_go_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 16u | token_bits;
    bits |= brace_bits_number(answer->mode, 16u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_loading_test_start_answer(const brace_can_loading_test_start_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 17u | token_bits;
    bits |= brace_bits_number(answer->rows, 16u, 16u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_loading_test_stop_answer(const brace_can_loading_test_stop_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 18u | token_bits;
    bits |= brace_bits_number(answer->rows, 16u, 16u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_fetch_row_answer(const brace_can_fetch_row_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 19u | token_bits;
    bits |= brace_bits_number(answer->row, 16u, 10u, &limited);
    bits |= brace_bits_number(answer->column, 26u, 6u, &limited);
    bits |= brace_bits_float(answer->value, 32u);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_identify_answer(const brace_can_identify_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 20u | token_bits;
    bits |= brace_bits_number(answer->major, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->minor, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->patch, 32u, 8u, &limited);
    bits |= brace_bits_number(answer->protocol, 40u, 8u, &limited);
    bits |= brace_bits_number(answer->node, 48u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 52u | token_bits;
    bits |= brace_bits_number(answer->dictionary_hash, 16u, 32u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = 84u | token_bits;
    bits |= brace_bits_number(answer->schema_hash, 16u, 32u, &limited);
    brace_bits_store(bits, parts[2]);
    bits = 116u | token_bits;
    bits |= brace_bits_number(answer->parameter_crc, 16u, 32u, &limited);
    bits |= brace_bits_number(answer->origin, 48u, 8u, &limited);
    brace_bits_store(bits, parts[3]);
}

void brace_can_pack_loading_test_result_answer(const brace_can_loading_test_result_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 21u | token_bits;
    bits |= brace_bits_number(answer->item, 16u, 8u, &limited);
    bits |= brace_bits_whole(answer->outcome, 24u, 8u, &limited);
    bits |= brace_bits_float(answer->value, 32u);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_clear_answer(const brace_can_clear_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 22u | token_bits;
    bits |= brace_bits_number(answer->faults, 16u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_k_in_space_at_posture_answer(const brace_can_k_in_space_at_posture_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 23u | token_bits;
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 55u | token_bits;
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_yy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = 87u | token_bits;
    bits |= brace_bits_signed(answer->k_yz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[2]);
    bits = 119u | token_bits;
    bits |= brace_bits_unsigned(answer->lambda_1_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_2_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[3]);
    bits = 151u | token_bits;
    bits |= brace_bits_unsigned(answer->lambda_3_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 40u, 8u, &limited);
    brace_bits_store(bits, parts[4]);
}

void brace_can_pack_drift_answer(const brace_can_drift_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 24u | token_bits;
    bits |= brace_bits_number(answer->state, 16u, 4u, &limited);
    bits |= brace_bits_number(answer->cause, 20u, 4u, &limited);
    bits |= brace_bits_number(answer->could_be, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->next_step, 32u, 8u, &limited);
    bits |= brace_bits_unsigned(answer->evidence, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = 56u | token_bits;
    bits |= brace_bits_signed(answer->loss_ratio, 100000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->loss_sigma_ratio, 100000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = 88u | token_bits;
    bits |= brace_bits_number(answer->since_readings, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->readings, 32u, 32u, &limited);
    brace_bits_store(bits, parts[2]);
}

void brace_can_pack_take_up_result_answer(const brace_can_take_up_result_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint64_t token_bits = (uint64_t)(token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = 25u | token_bits;
    bits |= brace_bits_number(answer->joint, 16u, 8u, &limited);
    bits |= brace_bits_whole(answer->outcome, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->phase, 32u, 8u, &limited);
    bits |= brace_bits_signed(answer->torque_n_mm, 10.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
}
