/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_ANSWERING_H
#define BRACE_CAN_ANSWERING_H

/* The whole answer to each request: the fields of all its parts, and the packer that makes its frames. What the fields
 * are is said at the parts, brace_can_<name>_answer_<part>_t.
 *   parts (out): brace_can_answer_parts[code] frames of eight bytes
 * Where an answer has flags for it, they get SATURATED when a value of the answer is limited.
 * cost on a Cortex-M4F: below 120 instructions for each part. */
#include <stdint.h>

#include "brace/can_messages.h"

enum { BRACE_CAN_ANSWER_PARTS_MOST = 5 }; /* frames of one answer */

typedef struct {
    uint32_t index;
    uint32_t value;
} brace_can_read_entry_answer_t;
void brace_can_pack_read_entry_answer(const brace_can_read_entry_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t index;
    uint32_t value;
} brace_can_write_entry_answer_t;
void brace_can_pack_write_entry_answer(const brace_can_write_entry_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    float k_xx_n_per_mm;
    float k_xz_n_per_mm;
    float k_zz_n_per_mm;
    float lambda_min_n_per_mm;
    float lambda_max_n_per_mm;
    float stiff_axis_rad;
    uint32_t flags;
} brace_can_k_at_posture_answer_t;
void brace_can_pack_k_at_posture_answer(const brace_can_k_at_posture_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef brace_can_k_at_posture_answer_t brace_can_k_at_tip_knee_up_answer_t;
void brace_can_pack_k_at_tip_knee_up_answer(const brace_can_k_at_tip_knee_up_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef brace_can_k_at_posture_answer_t brace_can_k_at_tip_knee_down_answer_t;
void brace_can_pack_k_at_tip_knee_down_answer(const brace_can_k_at_tip_knee_down_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    float fx_n;
    float fz_n;
    float low_n;
    float high_n;
} brace_can_contact_force_answer_t;
void brace_can_pack_contact_force_answer(const brace_can_contact_force_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    float dx_mm;
    float dz_mm;
} brace_can_sag_for_load_answer_t;
void brace_can_pack_sag_for_load_answer(const brace_can_sag_for_load_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    float margin_n;
    float angle_left_rad;
    uint32_t contact;
} brace_can_friction_margin_answer_t;
void brace_can_pack_friction_margin_answer(const brace_can_friction_margin_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t mode;
} brace_can_set_mode_answer_t;
void brace_can_pack_set_mode_answer(const brace_can_set_mode_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t words;
} brace_can_upload_begin_answer_t;
void brace_can_pack_upload_begin_answer(const brace_can_upload_begin_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t word;
    uint32_t data;
} brace_can_upload_word_answer_t;
void brace_can_pack_upload_word_answer(const brace_can_upload_word_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t sequence;
    uint32_t crc;
} brace_can_commit_answer_t;
void brace_can_pack_commit_answer(const brace_can_commit_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef brace_can_commit_answer_t brace_can_rollback_answer_t;
void brace_can_pack_rollback_answer(const brace_can_rollback_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t word;
    uint32_t data;
} brace_can_download_word_answer_t;
void brace_can_pack_download_word_answer(const brace_can_download_word_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t phase;
} brace_can_take_up_answer_t;
void brace_can_pack_take_up_answer(const brace_can_take_up_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t mode;
} brace_can_let_go_answer_t;
void brace_can_pack_let_go_answer(const brace_can_let_go_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t rows;
} brace_can_loading_test_start_answer_t;
void brace_can_pack_loading_test_start_answer(const brace_can_loading_test_start_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t rows;
} brace_can_loading_test_stop_answer_t;
void brace_can_pack_loading_test_stop_answer(const brace_can_loading_test_stop_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t row;
    uint32_t column;
    float value;
} brace_can_fetch_row_answer_t;
void brace_can_pack_fetch_row_answer(const brace_can_fetch_row_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t major;
    uint32_t minor;
    uint32_t patch;
    uint32_t protocol;
    uint32_t node;
    uint32_t dictionary_hash;
    uint32_t schema_hash;
    uint32_t parameter_crc;
    uint32_t origin;
} brace_can_identify_answer_t;
void brace_can_pack_identify_answer(const brace_can_identify_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t item;
    int32_t outcome;
    float value;
} brace_can_loading_test_result_answer_t;
void brace_can_pack_loading_test_result_answer(const brace_can_loading_test_result_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t faults;
} brace_can_clear_answer_t;
void brace_can_pack_clear_answer(const brace_can_clear_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    float k_xx_n_per_mm;
    float k_xy_n_per_mm;
    float k_xz_n_per_mm;
    float k_yy_n_per_mm;
    float k_yz_n_per_mm;
    float k_zz_n_per_mm;
    float lambda_1_n_per_mm;
    float lambda_2_n_per_mm;
    float lambda_3_n_per_mm;
    uint32_t flags;
} brace_can_k_in_space_at_posture_answer_t;
void brace_can_pack_k_in_space_at_posture_answer(const brace_can_k_in_space_at_posture_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t state;
    uint32_t cause;
    uint32_t could_be;
    uint32_t next_step;
    float evidence;
    float loss_ratio;
    float loss_sigma_ratio;
    uint32_t since_readings;
    uint32_t readings;
} brace_can_drift_answer_t;
void brace_can_pack_drift_answer(const brace_can_drift_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

typedef struct {
    uint32_t joint;
    int32_t outcome;
    uint32_t phase;
    float torque_n_mm;
} brace_can_take_up_result_answer_t;
void brace_can_pack_take_up_result_answer(const brace_can_take_up_result_answer_t *answer,
    uint32_t token, uint8_t (*parts)[8]);

#endif
