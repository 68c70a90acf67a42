/* Written by tools/interface from messages.toml; do not edit. */
#include "brace/can_messages.h"

#include "can_bits.h"

const uint8_t brace_can_answer_parts[256] = {
    [BRACE_REQUEST_READ_ENTRY] = 1,
    [BRACE_REQUEST_WRITE_ENTRY] = 1,
    [BRACE_REQUEST_K_AT_POSTURE] = 4,
    [BRACE_REQUEST_K_AT_TIP_KNEE_UP] = 4,
    [BRACE_REQUEST_K_AT_TIP_KNEE_DOWN] = 4,
    [BRACE_REQUEST_CONTACT_FORCE] = 2,
    [BRACE_REQUEST_SAG_FOR_LOAD] = 1,
    [BRACE_REQUEST_FRICTION_MARGIN] = 1,
    [BRACE_REQUEST_SET_MODE] = 1,
    [BRACE_REQUEST_UPLOAD_BEGIN] = 1,
    [BRACE_REQUEST_UPLOAD_WORD] = 1,
    [BRACE_REQUEST_COMMIT] = 2,
    [BRACE_REQUEST_ROLLBACK] = 2,
    [BRACE_REQUEST_DOWNLOAD_WORD] = 1,
    [BRACE_REQUEST_TAKE_UP] = 1,
    [BRACE_REQUEST_LET_GO] = 1,
    [BRACE_REQUEST_LOADING_TEST_START] = 1,
    [BRACE_REQUEST_LOADING_TEST_STOP] = 1,
    [BRACE_REQUEST_FETCH_ROW] = 1,
    [BRACE_REQUEST_IDENTIFY] = 5,
    [BRACE_REQUEST_LOADING_TEST_RESULT] = 1,
    [BRACE_REQUEST_CLEAR] = 1,
    [BRACE_REQUEST_K_IN_SPACE_AT_POSTURE] = 6,
    [BRACE_REQUEST_DRIFT] = 3,
    [BRACE_REQUEST_TAKE_UP_RESULT] = 1,
    [BRACE_REQUEST_SET_GRAVITY] = 1,
    [BRACE_REQUEST_TIP_FORCE] = 1,
    [BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE] = 5,
    [BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP] = 5,
    [BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN] = 5,
    [BRACE_REQUEST_TIP_FORCE_IN_SPACE] = 1,
    [BRACE_REQUEST_SIGN_OF_LIFE] = 1,
};

const brace_can_answer_frame_t brace_can_answer_frames[256] = {
    [BRACE_READ_ENTRY_ANSWER_0] = {BRACE_REQUEST_READ_ENTRY, 0, 1},
    [BRACE_WRITE_ENTRY_ANSWER_0] = {BRACE_REQUEST_WRITE_ENTRY, 0, 1},
    [BRACE_K_AT_POSTURE_ANSWER_0] = {BRACE_REQUEST_K_AT_POSTURE, 0, 4},
    [BRACE_K_AT_POSTURE_ANSWER_1] = {BRACE_REQUEST_K_AT_POSTURE, 1, 4},
    [BRACE_K_AT_POSTURE_ANSWER_2] = {BRACE_REQUEST_K_AT_POSTURE, 2, 4},
    [BRACE_K_AT_POSTURE_ANSWER_3] = {BRACE_REQUEST_K_AT_POSTURE, 3, 4},
    [BRACE_K_AT_TIP_KNEE_UP_ANSWER_0] = {BRACE_REQUEST_K_AT_TIP_KNEE_UP, 0, 4},
    [BRACE_K_AT_TIP_KNEE_UP_ANSWER_1] = {BRACE_REQUEST_K_AT_TIP_KNEE_UP, 1, 4},
    [BRACE_K_AT_TIP_KNEE_UP_ANSWER_2] = {BRACE_REQUEST_K_AT_TIP_KNEE_UP, 2, 4},
    [BRACE_K_AT_TIP_KNEE_UP_ANSWER_3] = {BRACE_REQUEST_K_AT_TIP_KNEE_UP, 3, 4},
    [BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_0] = {BRACE_REQUEST_K_AT_TIP_KNEE_DOWN, 0, 4},
    [BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_1] = {BRACE_REQUEST_K_AT_TIP_KNEE_DOWN, 1, 4},
    [BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_2] = {BRACE_REQUEST_K_AT_TIP_KNEE_DOWN, 2, 4},
    [BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_3] = {BRACE_REQUEST_K_AT_TIP_KNEE_DOWN, 3, 4},
    [BRACE_CONTACT_FORCE_ANSWER_0] = {BRACE_REQUEST_CONTACT_FORCE, 0, 2},
    [BRACE_CONTACT_FORCE_ANSWER_1] = {BRACE_REQUEST_CONTACT_FORCE, 1, 2},
    [BRACE_SAG_FOR_LOAD_ANSWER_0] = {BRACE_REQUEST_SAG_FOR_LOAD, 0, 1},
    [BRACE_FRICTION_MARGIN_ANSWER_0] = {BRACE_REQUEST_FRICTION_MARGIN, 0, 1},
    [BRACE_SET_MODE_ANSWER_0] = {BRACE_REQUEST_SET_MODE, 0, 1},
    [BRACE_UPLOAD_BEGIN_ANSWER_0] = {BRACE_REQUEST_UPLOAD_BEGIN, 0, 1},
    [BRACE_UPLOAD_WORD_ANSWER_0] = {BRACE_REQUEST_UPLOAD_WORD, 0, 1},
    [BRACE_COMMIT_ANSWER_0] = {BRACE_REQUEST_COMMIT, 0, 2},
    [BRACE_COMMIT_ANSWER_1] = {BRACE_REQUEST_COMMIT, 1, 2},
    [BRACE_ROLLBACK_ANSWER_0] = {BRACE_REQUEST_ROLLBACK, 0, 2},
    [BRACE_ROLLBACK_ANSWER_1] = {BRACE_REQUEST_ROLLBACK, 1, 2},
    [BRACE_DOWNLOAD_WORD_ANSWER_0] = {BRACE_REQUEST_DOWNLOAD_WORD, 0, 1},
    [BRACE_TAKE_UP_ANSWER_0] = {BRACE_REQUEST_TAKE_UP, 0, 1},
    [BRACE_LET_GO_ANSWER_0] = {BRACE_REQUEST_LET_GO, 0, 1},
    [BRACE_LOADING_TEST_START_ANSWER_0] = {BRACE_REQUEST_LOADING_TEST_START, 0, 1},
    [BRACE_LOADING_TEST_STOP_ANSWER_0] = {BRACE_REQUEST_LOADING_TEST_STOP, 0, 1},
    [BRACE_FETCH_ROW_ANSWER_0] = {BRACE_REQUEST_FETCH_ROW, 0, 1},
    [BRACE_IDENTIFY_ANSWER_0] = {BRACE_REQUEST_IDENTIFY, 0, 5},
    [BRACE_IDENTIFY_ANSWER_1] = {BRACE_REQUEST_IDENTIFY, 1, 5},
    [BRACE_IDENTIFY_ANSWER_2] = {BRACE_REQUEST_IDENTIFY, 2, 5},
    [BRACE_IDENTIFY_ANSWER_3] = {BRACE_REQUEST_IDENTIFY, 3, 5},
    [BRACE_IDENTIFY_ANSWER_4] = {BRACE_REQUEST_IDENTIFY, 4, 5},
    [BRACE_LOADING_TEST_RESULT_ANSWER_0] = {BRACE_REQUEST_LOADING_TEST_RESULT, 0, 1},
    [BRACE_CLEAR_ANSWER_0] = {BRACE_REQUEST_CLEAR, 0, 1},
    [BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_0] = {BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, 0, 6},
    [BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_1] = {BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, 1, 6},
    [BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_2] = {BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, 2, 6},
    [BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_3] = {BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, 3, 6},
    [BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_4] = {BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, 4, 6},
    [BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_5] = {BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, 5, 6},
    [BRACE_DRIFT_ANSWER_0] = {BRACE_REQUEST_DRIFT, 0, 3},
    [BRACE_DRIFT_ANSWER_1] = {BRACE_REQUEST_DRIFT, 1, 3},
    [BRACE_DRIFT_ANSWER_2] = {BRACE_REQUEST_DRIFT, 2, 3},
    [BRACE_TAKE_UP_RESULT_ANSWER_0] = {BRACE_REQUEST_TAKE_UP_RESULT, 0, 1},
    [BRACE_SET_GRAVITY_ANSWER_0] = {BRACE_REQUEST_SET_GRAVITY, 0, 1},
    [BRACE_TIP_FORCE_ANSWER_0] = {BRACE_REQUEST_TIP_FORCE, 0, 1},
    [BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_0] = {BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, 0, 5},
    [BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_1] = {BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, 1, 5},
    [BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_2] = {BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, 2, 5},
    [BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_3] = {BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, 3, 5},
    [BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_4] = {BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, 4, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_0] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP, 0, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_1] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP, 1, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_2] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP, 2, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_3] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP, 3, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_4] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP, 4, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_0] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN, 0, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_1] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN, 1, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_2] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN, 2, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_3] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN, 3, 5},
    [BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_4] = {BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN, 4, 5},
    [BRACE_TIP_FORCE_IN_SPACE_ANSWER_0] = {BRACE_REQUEST_TIP_FORCE_IN_SPACE, 0, 1},
    [BRACE_SIGN_OF_LIFE_ANSWER_0] = {BRACE_REQUEST_SIGN_OF_LIFE, 0, 1},
};

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
    bits = 4u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 5u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_posture_answer_2(const uint8_t data[8], brace_can_k_at_posture_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
}

uint32_t brace_can_pack_k_at_posture_answer_3(const brace_can_k_at_posture_answer_3_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 6u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->flags, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_posture_answer_3(const uint8_t data[8], brace_can_k_at_posture_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->flags = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_k_at_tip_knee_up_answer_0(const brace_can_k_at_tip_knee_up_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 7u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_k_at_tip_knee_up_answer_1(const brace_can_k_at_tip_knee_up_answer_1_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 8u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_k_at_tip_knee_up_answer_2(const brace_can_k_at_tip_knee_up_answer_2_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 9u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_up_answer_2(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
}

uint32_t brace_can_pack_k_at_tip_knee_up_answer_3(const brace_can_k_at_tip_knee_up_answer_3_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 10u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->flags, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_up_answer_3(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->flags = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_0(const brace_can_k_at_tip_knee_down_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 11u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_0(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_1(const brace_can_k_at_tip_knee_down_answer_1_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 12u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_1(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_2(const brace_can_k_at_tip_knee_down_answer_2_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 13u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_2(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
}

uint32_t brace_can_pack_k_at_tip_knee_down_answer_3(const brace_can_k_at_tip_knee_down_answer_3_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 14u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->flags, 16u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_at_tip_knee_down_answer_3(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->flags = brace_value_number(bits, 16u, 16u);
}

uint32_t brace_can_pack_contact_force_answer_0(const brace_can_contact_force_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 15u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 16u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_sag_for_load_answer_0(const brace_can_sag_for_load_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 17u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_friction_margin_answer_0(const brace_can_friction_margin_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 18u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_set_mode_answer_0(const brace_can_set_mode_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 19u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->mode, 16u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 24u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_set_mode_answer_0(const uint8_t data[8], brace_can_set_mode_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->mode = brace_value_number(bits, 16u, 8u);
    message->setting = brace_value_number(bits, 24u, 8u);
}

uint32_t brace_can_pack_upload_begin_answer_0(const brace_can_upload_begin_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 20u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->words, 16u, 16u, &limited);
    bits |= brace_bits_number(message->setting, 32u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_upload_begin_answer_0(const uint8_t data[8], brace_can_upload_begin_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->words = brace_value_number(bits, 16u, 16u);
    message->setting = brace_value_number(bits, 32u, 8u);
}

uint32_t brace_can_pack_upload_word_answer_0(const brace_can_upload_word_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 21u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_commit_answer_0(const brace_can_commit_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 22u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 23u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->crc, 16u, 32u, &limited);
    bits |= brace_bits_number(message->setting, 48u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_commit_answer_1(const uint8_t data[8], brace_can_commit_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->crc = brace_value_number(bits, 16u, 32u);
    message->setting = brace_value_number(bits, 48u, 8u);
}

uint32_t brace_can_pack_rollback_answer_0(const brace_can_rollback_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 24u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 25u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->crc, 16u, 32u, &limited);
    bits |= brace_bits_number(message->setting, 48u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_rollback_answer_1(const uint8_t data[8], brace_can_rollback_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->crc = brace_value_number(bits, 16u, 32u);
    message->setting = brace_value_number(bits, 48u, 8u);
}

uint32_t brace_can_pack_download_word_answer_0(const brace_can_download_word_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 26u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_take_up_answer_0(const brace_can_take_up_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 27u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->phase, 16u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(message->begin, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_take_up_answer_0(const uint8_t data[8], brace_can_take_up_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->phase = brace_value_number(bits, 16u, 8u);
    message->setting = brace_value_number(bits, 24u, 8u);
    message->begin = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_let_go_answer_0(const brace_can_let_go_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 28u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->mode, 16u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(message->begin, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_let_go_answer_0(const uint8_t data[8], brace_can_let_go_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->mode = brace_value_number(bits, 16u, 8u);
    message->setting = brace_value_number(bits, 24u, 8u);
    message->begin = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_loading_test_start_answer_0(const brace_can_loading_test_start_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 29u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->rows, 16u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(message->begin, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_start_answer_0(const uint8_t data[8],
    brace_can_loading_test_start_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->rows = brace_value_number(bits, 16u, 8u);
    message->setting = brace_value_number(bits, 24u, 8u);
    message->begin = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_loading_test_stop_answer_0(const brace_can_loading_test_stop_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 30u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->rows, 16u, 16u, &limited);
    bits |= brace_bits_number(message->setting, 32u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_stop_answer_0(const uint8_t data[8],
    brace_can_loading_test_stop_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->rows = brace_value_number(bits, 16u, 16u);
    message->setting = brace_value_number(bits, 32u, 8u);
}

uint32_t brace_can_pack_fetch_row_answer_0(const brace_can_fetch_row_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 31u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_identify_answer_0(const brace_can_identify_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 32u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 33u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 34u | (uint64_t)(message->token & 0xffu) << 8;
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
    bits = 35u | (uint64_t)(message->token & 0xffu) << 8;
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

uint32_t brace_can_pack_identify_answer_4(const brace_can_identify_answer_4_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 36u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->faults, 16u, 32u, &limited);
    bits |= brace_bits_number(message->mode, 48u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_identify_answer_4(const uint8_t data[8], brace_can_identify_answer_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->faults = brace_value_number(bits, 16u, 32u);
    message->mode = brace_value_number(bits, 48u, 8u);
    message->setting = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_loading_test_result_answer_0(const brace_can_loading_test_result_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 37u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->item, 16u, 8u, &limited);
    bits |= brace_bits_whole(message->outcome, 24u, 8u, &limited);
    bits |= brace_bits_float(message->value, 32u);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_loading_test_result_answer_0(const uint8_t data[8],
    brace_can_loading_test_result_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->item = brace_value_number(bits, 16u, 8u);
    message->outcome = brace_value_whole(bits, 24u, 8u);
    message->value = brace_value_float(bits, 32u);
}

uint32_t brace_can_pack_clear_answer_0(const brace_can_clear_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 38u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->faults, 16u, 32u, &limited);
    bits |= brace_bits_number(message->setting, 48u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_clear_answer_0(const uint8_t data[8], brace_can_clear_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->faults = brace_value_number(bits, 16u, 32u);
    message->setting = brace_value_number(bits, 48u, 8u);
}

uint32_t brace_can_pack_k_in_space_at_posture_answer_0(const brace_can_k_in_space_at_posture_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 39u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_answer_0(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xy_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_in_space_at_posture_answer_1(const brace_can_k_in_space_at_posture_answer_1_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 40u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_yy_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_answer_1(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_yy_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_in_space_at_posture_answer_2(const brace_can_k_in_space_at_posture_answer_2_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 41u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_yz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_answer_2(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_yz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_zz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_in_space_at_posture_answer_3(const brace_can_k_in_space_at_posture_answer_3_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 42u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_1_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_2_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_answer_3(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_1_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->lambda_2_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_in_space_at_posture_answer_4(const brace_can_k_in_space_at_posture_answer_4_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 43u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_3_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_number(message->flags, 40u, 16u, &limited);
    bits |= brace_bits_number(message->force_is_told, 56u, 8u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_answer_4(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_3_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->flags = brace_value_number(bits, 40u, 16u);
    message->force_is_told = brace_value_number(bits, 56u, 8u);
}

uint32_t brace_can_pack_k_in_space_at_posture_answer_5(const brace_can_k_in_space_at_posture_answer_5_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 44u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->dx_mm, 100.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(message->dy_mm, 100.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(message->dz_mm, 100.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_in_space_at_posture_answer_5(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_5_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dx_mm = brace_value_signed(bits, 16u, 16u, 0.01f);
    message->dy_mm = brace_value_signed(bits, 32u, 16u, 0.01f);
    message->dz_mm = brace_value_signed(bits, 48u, 16u, 0.01f);
}

uint32_t brace_can_pack_drift_answer_0(const brace_can_drift_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 45u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->state, 16u, 4u, &limited);
    bits |= brace_bits_number(message->cause, 20u, 4u, &limited);
    bits |= brace_bits_number(message->could_be, 24u, 8u, &limited);
    bits |= brace_bits_number(message->next_step, 32u, 8u, &limited);
    bits |= brace_bits_unsigned(message->evidence, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_drift_answer_0(const uint8_t data[8], brace_can_drift_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->state = brace_value_number(bits, 16u, 4u);
    message->cause = brace_value_number(bits, 20u, 4u);
    message->could_be = brace_value_number(bits, 24u, 8u);
    message->next_step = brace_value_number(bits, 32u, 8u);
    message->evidence = brace_value_unsigned(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_drift_answer_1(const brace_can_drift_answer_1_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 46u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->loss_ratio, 100000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->loss_sigma_ratio, 100000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_drift_answer_1(const uint8_t data[8], brace_can_drift_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->loss_ratio = brace_value_signed(bits, 16u, 24u, 1e-05f);
    message->loss_sigma_ratio = brace_value_unsigned(bits, 40u, 24u, 1e-05f);
}

uint32_t brace_can_pack_drift_answer_2(const brace_can_drift_answer_2_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 47u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->since_readings, 16u, 16u, &limited);
    bits |= brace_bits_number(message->readings, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_drift_answer_2(const uint8_t data[8], brace_can_drift_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->since_readings = brace_value_number(bits, 16u, 16u);
    message->readings = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_take_up_result_answer_0(const brace_can_take_up_result_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 48u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->joint, 16u, 8u, &limited);
    bits |= brace_bits_whole(message->outcome, 24u, 8u, &limited);
    bits |= brace_bits_number(message->phase, 32u, 8u, &limited);
    bits |= brace_bits_signed(message->torque_n_mm, 10.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_take_up_result_answer_0(const uint8_t data[8], brace_can_take_up_result_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->joint = brace_value_number(bits, 16u, 8u);
    message->outcome = brace_value_whole(bits, 24u, 8u);
    message->phase = brace_value_number(bits, 32u, 8u);
    message->torque_n_mm = brace_value_signed(bits, 40u, 24u, 0.1f);
}

uint32_t brace_can_pack_set_gravity_answer_0(const brace_can_set_gravity_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 49u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->direction_rad, 1000000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->lean_rad, 1000000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_set_gravity_answer_0(const uint8_t data[8], brace_can_set_gravity_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->direction_rad = brace_value_signed(bits, 16u, 24u, 1e-06f);
    message->lean_rad = brace_value_signed(bits, 40u, 24u, 1e-06f);
}

uint32_t brace_can_pack_tip_force_answer_0(const brace_can_tip_force_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 50u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->fx_n, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->fz_n, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_tip_force_answer_0(const uint8_t data[8], brace_can_tip_force_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->fx_n = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->fz_n = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_under_load_at_posture_answer_0(const brace_can_k_under_load_at_posture_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 51u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_posture_answer_0(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_under_load_at_posture_answer_1(const brace_can_k_under_load_at_posture_answer_1_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 52u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_posture_answer_1(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_under_load_at_posture_answer_2(const brace_can_k_under_load_at_posture_answer_2_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 53u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_posture_answer_2(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
}

uint32_t brace_can_pack_k_under_load_at_posture_answer_3(const brace_can_k_under_load_at_posture_answer_3_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 54u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->dx_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->dz_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_posture_answer_3(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dx_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->dz_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_under_load_at_posture_answer_4(const brace_can_k_under_load_at_posture_answer_4_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 55u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_float(message->buckling_factor, 16u);
    bits |= brace_bits_number(message->flags, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_posture_answer_4(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->buckling_factor = brace_value_float(bits, 16u);
    message->flags = brace_value_number(bits, 48u, 16u);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_0(const brace_can_k_under_load_at_tip_knee_up_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 56u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_up_answer_0(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_1(const brace_can_k_under_load_at_tip_knee_up_answer_1_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 57u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_up_answer_1(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_2(const brace_can_k_under_load_at_tip_knee_up_answer_2_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 58u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_up_answer_2(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_3(const brace_can_k_under_load_at_tip_knee_up_answer_3_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 59u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->dx_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->dz_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_up_answer_3(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dx_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->dz_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_4(const brace_can_k_under_load_at_tip_knee_up_answer_4_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 60u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_float(message->buckling_factor, 16u);
    bits |= brace_bits_number(message->flags, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_up_answer_4(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->buckling_factor = brace_value_float(bits, 16u);
    message->flags = brace_value_number(bits, 48u, 16u);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_0(const brace_can_k_under_load_at_tip_knee_down_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 61u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_xx_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->k_xz_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_down_answer_0(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_xx_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->k_xz_n_per_mm = brace_value_signed(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_1(const brace_can_k_under_load_at_tip_knee_down_answer_1_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 62u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->k_zz_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_unsigned(message->lambda_min_n_per_mm, 2000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_down_answer_1(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_1_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->k_zz_n_per_mm = brace_value_signed(bits, 16u, 24u, 0.0005f);
    message->lambda_min_n_per_mm = brace_value_unsigned(bits, 40u, 24u, 0.0005f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_2(const brace_can_k_under_load_at_tip_knee_down_answer_2_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 63u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_unsigned(message->lambda_max_n_per_mm, 2000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->stiff_axis_rad, 10000.0f, 40u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_down_answer_2(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_2_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->lambda_max_n_per_mm = brace_value_unsigned(bits, 16u, 24u, 0.0005f);
    message->stiff_axis_rad = brace_value_signed(bits, 40u, 16u, 0.0001f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_3(const brace_can_k_under_load_at_tip_knee_down_answer_3_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 64u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->dx_mm, 1000.0f, 16u, 24u, &limited);
    bits |= brace_bits_signed(message->dz_mm, 1000.0f, 40u, 24u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_down_answer_3(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_3_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->dx_mm = brace_value_signed(bits, 16u, 24u, 0.001f);
    message->dz_mm = brace_value_signed(bits, 40u, 24u, 0.001f);
}

uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_4(const brace_can_k_under_load_at_tip_knee_down_answer_4_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 65u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_float(message->buckling_factor, 16u);
    bits |= brace_bits_number(message->flags, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_k_under_load_at_tip_knee_down_answer_4(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_4_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->buckling_factor = brace_value_float(bits, 16u);
    message->flags = brace_value_number(bits, 48u, 16u);
}

uint32_t brace_can_pack_tip_force_in_space_answer_0(const brace_can_tip_force_in_space_answer_0_t *message,
    uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 66u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_signed(message->fx_n, 100.0f, 16u, 16u, &limited);
    bits |= brace_bits_signed(message->fy_n, 100.0f, 32u, 16u, &limited);
    bits |= brace_bits_signed(message->fz_n, 100.0f, 48u, 16u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_tip_force_in_space_answer_0(const uint8_t data[8],
    brace_can_tip_force_in_space_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->fx_n = brace_value_signed(bits, 16u, 16u, 0.01f);
    message->fy_n = brace_value_signed(bits, 32u, 16u, 0.01f);
    message->fz_n = brace_value_signed(bits, 48u, 16u, 0.01f);
}

uint32_t brace_can_pack_sign_of_life_answer_0(const brace_can_sign_of_life_answer_0_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 67u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->owner, 16u, 8u, &limited);
    bits |= brace_bits_number(message->setting, 24u, 8u, &limited);
    bits |= brace_bits_number(message->number, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_sign_of_life_answer_0(const uint8_t data[8], brace_can_sign_of_life_answer_0_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->owner = brace_value_number(bits, 16u, 8u);
    message->setting = brace_value_number(bits, 24u, 8u);
    message->number = brace_value_number(bits, 32u, 32u);
}

uint32_t brace_can_pack_refusal(const brace_can_refusal_t *message, uint8_t data[8])
{
    uint32_t limited = 0u;
    uint64_t bits = 0u;
    bits = 255u | (uint64_t)(message->token & 0xffu) << 8;
    bits |= brace_bits_number(message->code, 16u, 8u, &limited);
    bits |= brace_bits_whole(message->status, 24u, 8u, &limited);
    bits |= brace_bits_number(message->detail, 32u, 32u, &limited);
    brace_bits_store(bits, data);
    return limited;
}

void brace_can_unpack_refusal(const uint8_t data[8], brace_can_refusal_t *message)
{
    const uint64_t bits = brace_bits_load(data);
    message->token = (uint32_t)(bits >> 8) & 0xffu;
    message->code = brace_value_number(bits, 16u, 8u);
    message->status = brace_value_whole(bits, 24u, 8u);
    message->detail = brace_value_number(bits, 32u, 32u);
}
