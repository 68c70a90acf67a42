/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/answering.h"

#include "brace/status.h"
#include "can_bits.h"

static void pack_read_entry(const brace_read_entry_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->index, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->value, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_write_entry(const brace_write_entry_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->index, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->value, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_k_at_posture(const brace_k_at_posture_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = head | number[2];
    bits |= brace_bits_unsigned(answer->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, parts[2]);
    bits = head | number[3];
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 16u, 16u, &limited);
    brace_bits_store(bits, parts[3]);
}

static void pack_contact_force(const brace_contact_force_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_unsigned(answer->low_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->high_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
}

static void pack_sag_for_load(const brace_sag_for_load_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->dx_mm, 10000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->dz_mm, 10000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_friction_margin(const brace_friction_margin_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->margin_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->angle_left_rad, 10000.0f, 40u, 16u, &limited);
    bits |= brace_bits_number(answer->contact, 56u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_set_mode(const brace_set_mode_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->mode, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->setting, 24u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_upload_begin(const brace_upload_begin_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->words, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->setting, 32u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_upload_word(const brace_upload_word_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->word, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->data, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_commit(const brace_commit_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->sequence, 16u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_number(answer->crc, 16u, 32u, &limited);
    bits |= brace_bits_number(answer->setting, 48u, 8u, &limited);
    brace_bits_store(bits, parts[1]);
}

static void pack_download_word(const brace_download_word_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->word, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->data, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_take_up(const brace_take_up_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->phase, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->begin, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_let_go(const brace_let_go_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->mode, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->begin, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_loading_test_start(const brace_loading_test_start_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->rows, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->begin, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_loading_test_stop(const brace_loading_test_stop_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->rows, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->setting, 32u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_fetch_row(const brace_fetch_row_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->row, 16u, 10u, &limited);
    bits |= brace_bits_number(answer->column, 26u, 6u, &limited);
    bits |= brace_bits_float(answer->value, 32u);
    brace_bits_store(bits, parts[0]);
}

static void pack_identify(const brace_identify_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->major, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->minor, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->patch, 32u, 8u, &limited);
    bits |= brace_bits_number(answer->protocol, 40u, 8u, &limited);
    bits |= brace_bits_number(answer->node, 48u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_number(answer->dictionary_hash, 16u, 32u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = head | number[2];
    bits |= brace_bits_number(answer->schema_hash, 16u, 32u, &limited);
    brace_bits_store(bits, parts[2]);
    bits = head | number[3];
    bits |= brace_bits_number(answer->parameter_crc, 16u, 32u, &limited);
    bits |= brace_bits_number(answer->origin, 48u, 8u, &limited);
    brace_bits_store(bits, parts[3]);
    bits = head | number[4];
    bits |= brace_bits_number(answer->faults, 16u, 32u, &limited);
    bits |= brace_bits_number(answer->mode, 48u, 8u, &limited);
    bits |= brace_bits_number(answer->setting, 56u, 8u, &limited);
    brace_bits_store(bits, parts[4]);
}

static void pack_loading_test_result(const brace_loading_test_result_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->item, 16u, 8u, &limited);
    bits |= brace_bits_whole(answer->outcome, 24u, 8u, &limited);
    bits |= brace_bits_float(answer->value, 32u);
    brace_bits_store(bits, parts[0]);
}

static void pack_clear(const brace_clear_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->faults, 16u, 32u, &limited);
    bits |= brace_bits_number(answer->setting, 48u, 8u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_k_in_space_at_posture(const brace_k_in_space_at_posture_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_yy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = head | number[2];
    bits |= brace_bits_signed(answer->k_yz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[2]);
    bits = head | number[3];
    bits |= brace_bits_unsigned(answer->lambda_1_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_2_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[3]);
    bits = head | number[5];
    bits |= brace_bits_signed(answer->dx_mm, 100.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(answer->dy_mm, 100.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(answer->dz_mm, 100.0f, 48u, 16u, &limited);
    brace_bits_store(bits, parts[5]);
    bits = head | number[4];
    bits |= brace_bits_unsigned(answer->lambda_3_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_number(answer->force_is_told, 56u, 8u, &limited);
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 40u, 16u, &limited);
    brace_bits_store(bits, parts[4]);
}

static void pack_drift(const brace_drift_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->state, 16u, 4u, &limited);
    bits |= brace_bits_number(answer->cause, 20u, 4u, &limited);
    bits |= brace_bits_number(answer->could_be, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->next_step, 32u, 8u, &limited);
    bits |= brace_bits_unsigned(answer->evidence, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_signed(answer->loss_ratio, 100000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->loss_sigma_ratio, 100000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = head | number[2];
    bits |= brace_bits_number(answer->since_readings, 16u, 16u, &limited);
    bits |= brace_bits_number(answer->readings, 32u, 32u, &limited);
    brace_bits_store(bits, parts[2]);
}

static void pack_take_up_result(const brace_take_up_result_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->joint, 16u, 8u, &limited);
    bits |= brace_bits_whole(answer->outcome, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->phase, 32u, 8u, &limited);
    bits |= brace_bits_signed(answer->torque_n_mm, 10.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_set_gravity(const brace_set_gravity_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->direction_rad, 1000000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->lean_rad, 1000000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_tip_force(const brace_tip_force_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_k_under_load_at_posture(const brace_k_under_load_at_posture_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[0]);
    bits = head | number[1];
    bits |= brace_bits_signed(answer->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(answer->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[1]);
    bits = head | number[2];
    bits |= brace_bits_unsigned(answer->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, parts[2]);
    bits = head | number[3];
    bits |= brace_bits_signed(answer->dx_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(answer->dz_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, parts[3]);
    bits = head | number[4];
    bits |= brace_bits_float(answer->buckling_factor, 16u);
    bits |= brace_bits_number(answer->flags | (limited > 0u ? (uint32_t)BRACE_FLAG_SATURATED : 0u), 48u, 16u, &limited);
    brace_bits_store(bits, parts[4]);
}

static void pack_tip_force_in_space(const brace_tip_force_in_space_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_signed(answer->fx_n, 100.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(answer->fy_n, 100.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(answer->fz_n, 100.0f, 48u, 16u, &limited);
    brace_bits_store(bits, parts[0]);
}

static void pack_sign_of_life(const brace_sign_of_life_answer_t *answer, const uint8_t *number,
    uint32_t token, uint8_t (*parts)[8])
{
    const uint32_t head = (token & 0xffu) << 8;
    uint32_t limited = 0u;
    uint64_t bits;
    bits = head | number[0];
    bits |= brace_bits_number(answer->owner, 16u, 8u, &limited);
    bits |= brace_bits_number(answer->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(answer->number, 32u, 32u, &limited);
    brace_bits_store(bits, parts[0]);
}

void brace_can_pack_answer(uint32_t code, const brace_answer_t *answer, uint32_t token, uint8_t (*parts)[8])
{
    switch (code) {
    case BRACE_REQUEST_READ_ENTRY: {
        static const uint8_t number[] = {BRACE_READ_ENTRY_ANSWER_0};
        pack_read_entry(&answer->read_entry, number, token, parts);
        break;
    }
    case BRACE_REQUEST_WRITE_ENTRY: {
        static const uint8_t number[] = {BRACE_WRITE_ENTRY_ANSWER_0};
        pack_write_entry(&answer->write_entry, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_AT_POSTURE: {
        static const uint8_t number[] = {BRACE_K_AT_POSTURE_ANSWER_0, BRACE_K_AT_POSTURE_ANSWER_1, BRACE_K_AT_POSTURE_ANSWER_2, BRACE_K_AT_POSTURE_ANSWER_3};
        pack_k_at_posture(&answer->k_at_posture, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_AT_TIP_KNEE_UP: {
        static const uint8_t number[] = {BRACE_K_AT_TIP_KNEE_UP_ANSWER_0, BRACE_K_AT_TIP_KNEE_UP_ANSWER_1, BRACE_K_AT_TIP_KNEE_UP_ANSWER_2, BRACE_K_AT_TIP_KNEE_UP_ANSWER_3};
        pack_k_at_posture(&answer->k_at_tip_knee_up, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_AT_TIP_KNEE_DOWN: {
        static const uint8_t number[] = {BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_0, BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_1, BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_2, BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_3};
        pack_k_at_posture(&answer->k_at_tip_knee_down, number, token, parts);
        break;
    }
    case BRACE_REQUEST_CONTACT_FORCE: {
        static const uint8_t number[] = {BRACE_CONTACT_FORCE_ANSWER_0, BRACE_CONTACT_FORCE_ANSWER_1};
        pack_contact_force(&answer->contact_force, number, token, parts);
        break;
    }
    case BRACE_REQUEST_SAG_FOR_LOAD: {
        static const uint8_t number[] = {BRACE_SAG_FOR_LOAD_ANSWER_0};
        pack_sag_for_load(&answer->sag_for_load, number, token, parts);
        break;
    }
    case BRACE_REQUEST_FRICTION_MARGIN: {
        static const uint8_t number[] = {BRACE_FRICTION_MARGIN_ANSWER_0};
        pack_friction_margin(&answer->friction_margin, number, token, parts);
        break;
    }
    case BRACE_REQUEST_SET_MODE: {
        static const uint8_t number[] = {BRACE_SET_MODE_ANSWER_0};
        pack_set_mode(&answer->set_mode, number, token, parts);
        break;
    }
    case BRACE_REQUEST_UPLOAD_BEGIN: {
        static const uint8_t number[] = {BRACE_UPLOAD_BEGIN_ANSWER_0};
        pack_upload_begin(&answer->upload_begin, number, token, parts);
        break;
    }
    case BRACE_REQUEST_UPLOAD_WORD: {
        static const uint8_t number[] = {BRACE_UPLOAD_WORD_ANSWER_0};
        pack_upload_word(&answer->upload_word, number, token, parts);
        break;
    }
    case BRACE_REQUEST_COMMIT: {
        static const uint8_t number[] = {BRACE_COMMIT_ANSWER_0, BRACE_COMMIT_ANSWER_1};
        pack_commit(&answer->commit, number, token, parts);
        break;
    }
    case BRACE_REQUEST_ROLLBACK: {
        static const uint8_t number[] = {BRACE_ROLLBACK_ANSWER_0, BRACE_ROLLBACK_ANSWER_1};
        pack_commit(&answer->rollback, number, token, parts);
        break;
    }
    case BRACE_REQUEST_DOWNLOAD_WORD: {
        static const uint8_t number[] = {BRACE_DOWNLOAD_WORD_ANSWER_0};
        pack_download_word(&answer->download_word, number, token, parts);
        break;
    }
    case BRACE_REQUEST_TAKE_UP: {
        static const uint8_t number[] = {BRACE_TAKE_UP_ANSWER_0};
        pack_take_up(&answer->take_up, number, token, parts);
        break;
    }
    case BRACE_REQUEST_LET_GO: {
        static const uint8_t number[] = {BRACE_LET_GO_ANSWER_0};
        pack_let_go(&answer->let_go, number, token, parts);
        break;
    }
    case BRACE_REQUEST_LOADING_TEST_START: {
        static const uint8_t number[] = {BRACE_LOADING_TEST_START_ANSWER_0};
        pack_loading_test_start(&answer->loading_test_start, number, token, parts);
        break;
    }
    case BRACE_REQUEST_LOADING_TEST_STOP: {
        static const uint8_t number[] = {BRACE_LOADING_TEST_STOP_ANSWER_0};
        pack_loading_test_stop(&answer->loading_test_stop, number, token, parts);
        break;
    }
    case BRACE_REQUEST_FETCH_ROW: {
        static const uint8_t number[] = {BRACE_FETCH_ROW_ANSWER_0};
        pack_fetch_row(&answer->fetch_row, number, token, parts);
        break;
    }
    case BRACE_REQUEST_IDENTIFY: {
        static const uint8_t number[] = {BRACE_IDENTIFY_ANSWER_0, BRACE_IDENTIFY_ANSWER_1, BRACE_IDENTIFY_ANSWER_2, BRACE_IDENTIFY_ANSWER_3, BRACE_IDENTIFY_ANSWER_4};
        pack_identify(&answer->identify, number, token, parts);
        break;
    }
    case BRACE_REQUEST_LOADING_TEST_RESULT: {
        static const uint8_t number[] = {BRACE_LOADING_TEST_RESULT_ANSWER_0};
        pack_loading_test_result(&answer->loading_test_result, number, token, parts);
        break;
    }
    case BRACE_REQUEST_CLEAR: {
        static const uint8_t number[] = {BRACE_CLEAR_ANSWER_0};
        pack_clear(&answer->clear, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_IN_SPACE_AT_POSTURE: {
        static const uint8_t number[] = {BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_0, BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_1, BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_2, BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_3, BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_4, BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_5};
        pack_k_in_space_at_posture(&answer->k_in_space_at_posture, number, token, parts);
        break;
    }
    case BRACE_REQUEST_DRIFT: {
        static const uint8_t number[] = {BRACE_DRIFT_ANSWER_0, BRACE_DRIFT_ANSWER_1, BRACE_DRIFT_ANSWER_2};
        pack_drift(&answer->drift, number, token, parts);
        break;
    }
    case BRACE_REQUEST_TAKE_UP_RESULT: {
        static const uint8_t number[] = {BRACE_TAKE_UP_RESULT_ANSWER_0};
        pack_take_up_result(&answer->take_up_result, number, token, parts);
        break;
    }
    case BRACE_REQUEST_SET_GRAVITY: {
        static const uint8_t number[] = {BRACE_SET_GRAVITY_ANSWER_0};
        pack_set_gravity(&answer->set_gravity, number, token, parts);
        break;
    }
    case BRACE_REQUEST_TIP_FORCE: {
        static const uint8_t number[] = {BRACE_TIP_FORCE_ANSWER_0};
        pack_tip_force(&answer->tip_force, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE: {
        static const uint8_t number[] = {BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_0, BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_1, BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_2, BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_3, BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_4};
        pack_k_under_load_at_posture(&answer->k_under_load_at_posture, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP: {
        static const uint8_t number[] = {BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_0, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_1, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_2, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_3, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_4};
        pack_k_under_load_at_posture(&answer->k_under_load_at_tip_knee_up, number, token, parts);
        break;
    }
    case BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN: {
        static const uint8_t number[] = {BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_0, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_1, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_2, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_3, BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_4};
        pack_k_under_load_at_posture(&answer->k_under_load_at_tip_knee_down, number, token, parts);
        break;
    }
    case BRACE_REQUEST_TIP_FORCE_IN_SPACE: {
        static const uint8_t number[] = {BRACE_TIP_FORCE_IN_SPACE_ANSWER_0};
        pack_tip_force_in_space(&answer->tip_force_in_space, number, token, parts);
        break;
    }
    case BRACE_REQUEST_SIGN_OF_LIFE: {
        static const uint8_t number[] = {BRACE_SIGN_OF_LIFE_ANSWER_0};
        pack_sign_of_life(&answer->sign_of_life, number, token, parts);
        break;
    }
    default: break;
    }
}
