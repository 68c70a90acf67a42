/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_ANSWERING_H
#define BRACE_ANSWERING_H

/* Every request of messages.toml and its whole answer, whichever wire carries them: members of 32 bits, in the order of
 * the fields of all parts. What they are is said at the frames (brace/can_messages.h): brace_can_<name>_request_t and
 * brace_can_<name>_answer_<part>_t.
 *
 * BRACE_REQUESTS(X)    X(code, name) for each of them. A controller makes its table from it, so a new request needs no
 *                      hand-written line besides the function that answers it.
 */
#include <stdint.h>

#include "brace/can_messages.h"

#define BRACE_REQUESTS(X) \
    X(BRACE_REQUEST_READ_ENTRY, read_entry) \
    X(BRACE_REQUEST_WRITE_ENTRY, write_entry) \
    X(BRACE_REQUEST_K_AT_POSTURE, k_at_posture) \
    X(BRACE_REQUEST_K_AT_TIP_KNEE_UP, k_at_tip_knee_up) \
    X(BRACE_REQUEST_K_AT_TIP_KNEE_DOWN, k_at_tip_knee_down) \
    X(BRACE_REQUEST_CONTACT_FORCE, contact_force) \
    X(BRACE_REQUEST_SAG_FOR_LOAD, sag_for_load) \
    X(BRACE_REQUEST_FRICTION_MARGIN, friction_margin) \
    X(BRACE_REQUEST_SET_MODE, set_mode) \
    X(BRACE_REQUEST_UPLOAD_BEGIN, upload_begin) \
    X(BRACE_REQUEST_UPLOAD_WORD, upload_word) \
    X(BRACE_REQUEST_COMMIT, commit) \
    X(BRACE_REQUEST_ROLLBACK, rollback) \
    X(BRACE_REQUEST_DOWNLOAD_WORD, download_word) \
    X(BRACE_REQUEST_TAKE_UP, take_up) \
    X(BRACE_REQUEST_LET_GO, let_go) \
    X(BRACE_REQUEST_LOADING_TEST_START, loading_test_start) \
    X(BRACE_REQUEST_LOADING_TEST_STOP, loading_test_stop) \
    X(BRACE_REQUEST_FETCH_ROW, fetch_row) \
    X(BRACE_REQUEST_IDENTIFY, identify) \
    X(BRACE_REQUEST_LOADING_TEST_RESULT, loading_test_result) \
    X(BRACE_REQUEST_CLEAR, clear) \
    X(BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, k_in_space_at_posture) \
    X(BRACE_REQUEST_DRIFT, drift) \
    X(BRACE_REQUEST_TAKE_UP_RESULT, take_up_result) \
    X(BRACE_REQUEST_SET_GRAVITY, set_gravity) \
    X(BRACE_REQUEST_TIP_FORCE, tip_force) \
    X(BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, k_under_load_at_posture) \
    X(BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP, k_under_load_at_tip_knee_up) \
    X(BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN, k_under_load_at_tip_knee_down) \
    X(BRACE_REQUEST_TIP_FORCE_IN_SPACE, tip_force_in_space) \
    X(BRACE_REQUEST_SIGN_OF_LIFE, sign_of_life)

enum {
    BRACE_REQUEST_CODE_MOST = 32,
    BRACE_CAN_ANSWER_PARTS_MOST = 6 /* frames of one answer */
};

typedef struct {
    uint32_t index;
} brace_read_entry_request_t;
typedef struct {
    uint32_t index;
    uint32_t value;
} brace_read_entry_answer_t;

typedef struct {
    uint32_t index;
    uint32_t value;
} brace_write_entry_request_t;
typedef struct {
    uint32_t index;
    uint32_t value;
} brace_write_entry_answer_t;

typedef struct {
    float theta1_rad;
    float theta2_rad;
} brace_k_at_posture_request_t;
typedef struct {
    float k_xx_n_per_mm;
    float k_xz_n_per_mm;
    float k_zz_n_per_mm;
    float lambda_min_n_per_mm;
    float lambda_max_n_per_mm;
    float stiff_axis_rad;
    uint32_t flags;
} brace_k_at_posture_answer_t;

typedef struct {
    float x_mm;
    float z_mm;
} brace_k_at_tip_knee_up_request_t;
typedef brace_k_at_posture_answer_t brace_k_at_tip_knee_up_answer_t;

typedef struct {
    float x_mm;
    float z_mm;
} brace_k_at_tip_knee_down_request_t;
typedef brace_k_at_posture_answer_t brace_k_at_tip_knee_down_answer_t;

typedef struct {
    float dx_mm;
    float dz_mm;
} brace_contact_force_request_t;
typedef struct {
    float fx_n;
    float fz_n;
    float low_n;
    float high_n;
} brace_contact_force_answer_t;

typedef struct {
    float fx_n;
    float fz_n;
} brace_sag_for_load_request_t;
typedef struct {
    float dx_mm;
    float dz_mm;
} brace_sag_for_load_answer_t;

typedef struct {
    float normal_rad;
    float friction_ratio;
} brace_friction_margin_request_t;
typedef struct {
    float margin_n;
    float angle_left_rad;
    uint32_t contact;
} brace_friction_margin_answer_t;

typedef struct {
    uint32_t mode;
    uint32_t key;
} brace_set_mode_request_t;
typedef struct {
    uint32_t mode;
    uint32_t setting;
} brace_set_mode_answer_t;

typedef struct {
    uint32_t bytes;
    uint32_t crc;
} brace_upload_begin_request_t;
typedef struct {
    uint32_t words;
    uint32_t setting;
} brace_upload_begin_answer_t;

typedef struct {
    uint32_t word;
    uint32_t data;
} brace_upload_word_request_t;
typedef struct {
    uint32_t word;
    uint32_t data;
} brace_upload_word_answer_t;

typedef struct {
    uint32_t crc;
} brace_commit_request_t;
typedef struct {
    uint32_t sequence;
    uint32_t crc;
    uint32_t setting;
} brace_commit_answer_t;

typedef struct {
    uint32_t nothing;
} brace_rollback_request_t;
typedef brace_commit_answer_t brace_rollback_answer_t;

typedef struct {
    uint32_t word;
} brace_download_word_request_t;
typedef struct {
    uint32_t word;
    uint32_t data;
} brace_download_word_answer_t;

typedef struct {
    uint32_t joint;
    int32_t flank;
} brace_take_up_request_t;
typedef struct {
    uint32_t phase;
    uint32_t setting;
    uint32_t begin;
} brace_take_up_answer_t;

typedef struct {
    uint32_t nothing;
} brace_let_go_request_t;
typedef struct {
    uint32_t mode;
    uint32_t setting;
    uint32_t begin;
} brace_let_go_answer_t;

typedef struct {
    uint32_t axis;
    uint32_t steps_per_side;
    float step_mm;
    uint32_t dwell_ms;
} brace_loading_test_start_request_t;
typedef struct {
    uint32_t rows;
    uint32_t setting;
    uint32_t begin;
} brace_loading_test_start_answer_t;

typedef struct {
    uint32_t nothing;
} brace_loading_test_stop_request_t;
typedef struct {
    uint32_t rows;
    uint32_t setting;
} brace_loading_test_stop_answer_t;

typedef struct {
    uint32_t row;
    uint32_t column;
} brace_fetch_row_request_t;
typedef struct {
    uint32_t row;
    uint32_t column;
    float value;
} brace_fetch_row_answer_t;

typedef struct {
    uint32_t nothing;
} brace_identify_request_t;
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
    uint32_t faults;
    uint32_t mode;
    uint32_t setting;
} brace_identify_answer_t;

typedef struct {
    uint32_t item;
} brace_loading_test_result_request_t;
typedef struct {
    uint32_t item;
    int32_t outcome;
    float value;
} brace_loading_test_result_answer_t;

typedef struct {
    uint32_t faults;
} brace_clear_request_t;
typedef struct {
    uint32_t faults;
    uint32_t setting;
} brace_clear_answer_t;

typedef struct {
    float theta0_rad;
    float theta1_rad;
    float theta2_rad;
} brace_k_in_space_at_posture_request_t;
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
    uint32_t force_is_told;
    float dx_mm;
    float dy_mm;
    float dz_mm;
} brace_k_in_space_at_posture_answer_t;

typedef struct {
    uint32_t nothing;
} brace_drift_request_t;
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
} brace_drift_answer_t;

typedef struct {
    uint32_t joint;
} brace_take_up_result_request_t;
typedef struct {
    uint32_t joint;
    int32_t outcome;
    uint32_t phase;
    float torque_n_mm;
} brace_take_up_result_answer_t;

typedef struct {
    float direction_rad;
    float lean_rad;
} brace_set_gravity_request_t;
typedef struct {
    float direction_rad;
    float lean_rad;
} brace_set_gravity_answer_t;

typedef struct {
    float fx_n;
    float fz_n;
} brace_tip_force_request_t;
typedef struct {
    float fx_n;
    float fz_n;
} brace_tip_force_answer_t;

typedef struct {
    float theta1_rad;
    float theta2_rad;
} brace_k_under_load_at_posture_request_t;
typedef struct {
    float k_xx_n_per_mm;
    float k_xz_n_per_mm;
    float k_zz_n_per_mm;
    float lambda_min_n_per_mm;
    float lambda_max_n_per_mm;
    float stiff_axis_rad;
    float dx_mm;
    float dz_mm;
    float buckling_factor;
    uint32_t flags;
} brace_k_under_load_at_posture_answer_t;

typedef struct {
    float x_mm;
    float z_mm;
} brace_k_under_load_at_tip_knee_up_request_t;
typedef brace_k_under_load_at_posture_answer_t brace_k_under_load_at_tip_knee_up_answer_t;

typedef struct {
    float x_mm;
    float z_mm;
} brace_k_under_load_at_tip_knee_down_request_t;
typedef brace_k_under_load_at_posture_answer_t brace_k_under_load_at_tip_knee_down_answer_t;

typedef struct {
    float fx_n;
    float fy_n;
    float fz_n;
} brace_tip_force_in_space_request_t;
typedef struct {
    float fx_n;
    float fy_n;
    float fz_n;
} brace_tip_force_in_space_answer_t;

typedef struct {
    uint32_t heard;
    uint32_t check;
} brace_sign_of_life_request_t;
typedef struct {
    uint32_t owner;
    uint32_t setting;
    uint32_t number;
} brace_sign_of_life_answer_t;

/* What is asked, by the request's name, or word by word. */
typedef union {
    brace_read_entry_request_t read_entry;
    brace_write_entry_request_t write_entry;
    brace_k_at_posture_request_t k_at_posture;
    brace_k_at_tip_knee_up_request_t k_at_tip_knee_up;
    brace_k_at_tip_knee_down_request_t k_at_tip_knee_down;
    brace_contact_force_request_t contact_force;
    brace_sag_for_load_request_t sag_for_load;
    brace_friction_margin_request_t friction_margin;
    brace_set_mode_request_t set_mode;
    brace_upload_begin_request_t upload_begin;
    brace_upload_word_request_t upload_word;
    brace_commit_request_t commit;
    brace_rollback_request_t rollback;
    brace_download_word_request_t download_word;
    brace_take_up_request_t take_up;
    brace_let_go_request_t let_go;
    brace_loading_test_start_request_t loading_test_start;
    brace_loading_test_stop_request_t loading_test_stop;
    brace_fetch_row_request_t fetch_row;
    brace_identify_request_t identify;
    brace_loading_test_result_request_t loading_test_result;
    brace_clear_request_t clear;
    brace_k_in_space_at_posture_request_t k_in_space_at_posture;
    brace_drift_request_t drift;
    brace_take_up_result_request_t take_up_result;
    brace_set_gravity_request_t set_gravity;
    brace_tip_force_request_t tip_force;
    brace_k_under_load_at_posture_request_t k_under_load_at_posture;
    brace_k_under_load_at_tip_knee_up_request_t k_under_load_at_tip_knee_up;
    brace_k_under_load_at_tip_knee_down_request_t k_under_load_at_tip_knee_down;
    brace_tip_force_in_space_request_t tip_force_in_space;
    brace_sign_of_life_request_t sign_of_life;
    uint32_t word[4];
} brace_request_t;

/* What is answered, likewise. */
typedef union {
    brace_read_entry_answer_t read_entry;
    brace_write_entry_answer_t write_entry;
    brace_k_at_posture_answer_t k_at_posture;
    brace_k_at_tip_knee_up_answer_t k_at_tip_knee_up;
    brace_k_at_tip_knee_down_answer_t k_at_tip_knee_down;
    brace_contact_force_answer_t contact_force;
    brace_sag_for_load_answer_t sag_for_load;
    brace_friction_margin_answer_t friction_margin;
    brace_set_mode_answer_t set_mode;
    brace_upload_begin_answer_t upload_begin;
    brace_upload_word_answer_t upload_word;
    brace_commit_answer_t commit;
    brace_rollback_answer_t rollback;
    brace_download_word_answer_t download_word;
    brace_take_up_answer_t take_up;
    brace_let_go_answer_t let_go;
    brace_loading_test_start_answer_t loading_test_start;
    brace_loading_test_stop_answer_t loading_test_stop;
    brace_fetch_row_answer_t fetch_row;
    brace_identify_answer_t identify;
    brace_loading_test_result_answer_t loading_test_result;
    brace_clear_answer_t clear;
    brace_k_in_space_at_posture_answer_t k_in_space_at_posture;
    brace_drift_answer_t drift;
    brace_take_up_result_answer_t take_up_result;
    brace_set_gravity_answer_t set_gravity;
    brace_tip_force_answer_t tip_force;
    brace_k_under_load_at_posture_answer_t k_under_load_at_posture;
    brace_k_under_load_at_tip_knee_up_answer_t k_under_load_at_tip_knee_up;
    brace_k_under_load_at_tip_knee_down_answer_t k_under_load_at_tip_knee_down;
    brace_tip_force_in_space_answer_t tip_force_in_space;
    brace_sign_of_life_answer_t sign_of_life;
    uint32_t word[14];
} brace_answer_t;

/* The fields of a request over CAN; all zero where the dictionary has no request of its code (data[0]). Below 120
 * instructions on a Cortex-M4F. */
void brace_can_unpack_request(const uint8_t data[8], brace_request_t *asked);

/* The frames of an answer. Where it has flags for it, they get SATURATED when one of its values is limited.
 *   code: of a request that the dictionary has
 *   parts (out): brace_can_answer_parts[code] frames of eight bytes
 * Below 120 instructions for each part. */
void brace_can_pack_answer(uint32_t code, const brace_answer_t *answer, uint32_t token, uint8_t (*parts)[8]);

#endif
