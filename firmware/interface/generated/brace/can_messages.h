/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_MESSAGES_H
#define BRACE_CAN_MESSAGES_H

/* The frames of the wire, for the controller and for whoever speaks to it. Formats: docs/protocol.md.
 *
 * A value that is not known is NaN here and a code of its own on the wire, never zero. brace_can_pack_... limits what
 * does not fit and answers how many values it limited; the frame's bytes are always written. brace_can_unpack_...
 * always writes the struct: every bit pattern means something. Pure functions, no libm; any thread.
 * accuracy: half a step, and a float's rounding.
 * cost on a Cortex-M4F: below 120 instructions each; of the CAN FD frame 250.
 */
#include <stdint.h>

/* Of every frame, entry and parameter, with types, steps and units: what two ends must agree on. */
#define BRACE_DICTIONARY_HASH 0x588d26d8u
#define BRACE_PROTOCOL 1u

/* Identifiers of node 0; a controller adds its node number, 1-127. */
enum {
    BRACE_CAN_ID_EMERGENCY = 0x080,
    BRACE_CAN_ID_STIFFNESS_A = 0x180,
    BRACE_CAN_ID_STIFFNESS_B = 0x280,
    BRACE_CAN_ID_EIGENVALUES = 0x380,
    BRACE_CAN_ID_POSTURE = 0x480,
    BRACE_CAN_ID_HEARTBEAT = 0x700,
    BRACE_CAN_ID_SNAPSHOT_FD = 0x500,
    BRACE_CAN_ID_REQUEST = 0x600,
    BRACE_CAN_ID_ANSWER = 0x580
};

/* First byte of a request; of an answer: plus 32 times its part. */
enum {
    BRACE_REQUEST_READ_ENTRY = 1,
    BRACE_REQUEST_WRITE_ENTRY = 2,
    BRACE_REQUEST_K_AT_POSTURE = 3,
    BRACE_REQUEST_K_AT_TIP_KNEE_UP = 4,
    BRACE_REQUEST_K_AT_TIP_KNEE_DOWN = 5,
    BRACE_REQUEST_CONTACT_FORCE = 6,
    BRACE_REQUEST_SAG_FOR_LOAD = 7,
    BRACE_REQUEST_FRICTION_MARGIN = 8,
    BRACE_REQUEST_SET_MODE = 9,
    BRACE_REQUEST_UPLOAD_BEGIN = 10,
    BRACE_REQUEST_UPLOAD_WORD = 11,
    BRACE_REQUEST_COMMIT = 12,
    BRACE_REQUEST_ROLLBACK = 13,
    BRACE_REQUEST_DOWNLOAD_WORD = 14,
    BRACE_REQUEST_TAKE_UP = 15,
    BRACE_REQUEST_LET_GO = 16,
    BRACE_REQUEST_LOADING_TEST_START = 17,
    BRACE_REQUEST_LOADING_TEST_STOP = 18,
    BRACE_REQUEST_FETCH_ROW = 19,
    BRACE_REQUEST_IDENTIFY = 20,
    BRACE_REQUEST_LOADING_TEST_RESULT = 21,
    BRACE_REQUEST_CLEAR = 22,
    BRACE_ANSWER_PART = 32,
    BRACE_ANSWER_REFUSED = 224
};

/* Frames of the answer, by the request's code; 0: no such request. */
extern const uint8_t brace_can_answer_parts[32];

/* a fault has come or gone */
typedef struct {
    uint32_t error_code; /* of the fault that came, as CANopen orders them: 0x7300 sensor, 0x7305 encoder stuck, 0x6100 tick late, 0x6320 parameters, 0x5530 memory, 0x8140 bus off, 0xff01 model drift, 0x6010 crashed; 0x1000 one is gone, others are there; 0x0000 all is well again */
    uint32_t error_register; /* 1 while any fault is there */
    uint32_t mode; /* what the controller is doing */
    uint32_t faults; /* all faults that are there now */
} brace_can_emergency_t;
uint32_t brace_can_pack_emergency(const brace_can_emergency_t *message, uint8_t data[8]);
void brace_can_unpack_emergency(const uint8_t data[8], brace_can_emergency_t *message);

/* K at the tip, first half; the second is stiffness_b of the same sequence */
typedef struct {
    uint32_t sequence; /* of the snapshot; equal in all frames of one */
    uint32_t flags; /* quality of K */
    float k_xx_n_per_mm; /* force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm; /* force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
} brace_can_stiffness_a_t;
uint32_t brace_can_pack_stiffness_a(const brace_can_stiffness_a_t *message, uint8_t data[8]);
void brace_can_unpack_stiffness_a(const uint8_t data[8], brace_can_stiffness_a_t *message);

/* K at the tip, second half, and what it stands for */
typedef struct {
    uint32_t sequence; /* of the snapshot; equal in all frames of one */
    float k_zz_n_per_mm; /* force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float age_ms; /* of the samples when the frame was made; more than 127 ms are sent as 127 [ms, 0 to 127] */
    uint32_t play_femur; /* which flank of the femur joint's play carries */
    uint32_t play_tibia; /* which flank of the tibia joint's play carries */
    uint32_t parameter_tag; /* low half of the CRC of the parameters in force */
} brace_can_stiffness_b_t;
uint32_t brace_can_pack_stiffness_b(const brace_can_stiffness_b_t *message, uint8_t data[8]);
void brace_can_unpack_stiffness_b(const uint8_t data[8], brace_can_stiffness_b_t *message);

/* eigenvalues of K and the direction of the stiffer */
typedef struct {
    uint32_t sequence; /* of the snapshot; equal in all frames of one */
    float lambda_min_n_per_mm; /* smaller eigenvalue of K [N/mm, 0 to 524.287] */
    float lambda_max_n_per_mm; /* larger eigenvalue of K [N/mm, 0 to 5242.87] */
    float stiff_axis_rad; /* direction of lambda_max from +x [rad, -3.2767 to 3.2767] */
} brace_can_eigenvalues_t;
uint32_t brace_can_pack_eigenvalues(const brace_can_eigenvalues_t *message, uint8_t data[8]);
void brace_can_unpack_eigenvalues(const uint8_t data[8], brace_can_eigenvalues_t *message);

/* true joint angles of the snapshot, and what the controller is doing */
typedef struct {
    uint32_t sequence; /* of the snapshot; equal in all frames of one */
    float theta1_rad; /* angle of the femur from +x [rad, -10.4857 to 10.4857] */
    float theta2_rad; /* flexion of the knee [rad, -10.4857 to 10.4857] */
    uint32_t mode; /* what the controller is doing */
    uint32_t faults; /* faults that are there now */
} brace_can_posture_t;
uint32_t brace_can_pack_posture(const brace_can_posture_t *message, uint8_t data[8]);
void brace_can_unpack_posture(const uint8_t data[8], brace_can_posture_t *message);

/* the controller lives, and speaks this dictionary */
typedef struct {
    uint32_t state; /* as CANopen numbers them: STOPPED in FAULT, PRE_OPERATIONAL in CONFIGURATION */
    uint32_t mode; /* what the controller is doing */
    uint32_t faults; /* faults that are there now */
    uint32_t dictionary_hash; /* of everything that matters on the wire; another one is another language */
} brace_can_heartbeat_t;
uint32_t brace_can_pack_heartbeat(const brace_can_heartbeat_t *message, uint8_t data[8]);
void brace_can_unpack_heartbeat(const uint8_t data[8], brace_can_heartbeat_t *message);

/* a whole snapshot, in place of stiffness_a, stiffness_b, eigenvalues and posture, where controller.can_fd_bit_rate is set and the bus can do it */
typedef struct {
    uint32_t sequence; /* of the snapshot */
    uint32_t parameter_crc; /* CRC of the parameters in force */
    float age_ms; /* of the samples when the frame was made; more than 32767 ms are sent as 32767 [ms, 0 to 32767] */
    uint32_t flags; /* quality of K */
    uint32_t mode; /* what the controller is doing */
    uint32_t play_femur; /* which flank of the femur joint's play carries */
    uint32_t play_tibia; /* which flank of the tibia joint's play carries */
    uint32_t faults; /* all faults that are there now */
    float k_xx_n_per_mm; /* force along x per displacement along x */
    float k_xz_n_per_mm; /* force along x per displacement along z, and the reverse */
    float k_zz_n_per_mm; /* force along z per displacement along z */
    float lambda_min_n_per_mm; /* smaller eigenvalue of K */
    float lambda_max_n_per_mm; /* larger eigenvalue of K */
    float stiff_axis_rad; /* direction of lambda_max from +x */
    float theta1_rad; /* true angle of the femur joint */
    float theta2_rad; /* true angle of the tibia joint */
    float tip_x_mm; /* where the tip is, outwards from the hip */
    float tip_z_mm; /* where the tip is, upwards from the hip */
    float force_x_n; /* force of the ground on the tip, outwards */
    float force_z_n; /* force of the ground on the tip, upwards */
} brace_can_snapshot_fd_t;
uint32_t brace_can_pack_snapshot_fd(const brace_can_snapshot_fd_t *message, uint8_t data[64]);
void brace_can_unpack_snapshot_fd(const uint8_t data[64], brace_can_snapshot_fd_t *message);

typedef struct {
    uint32_t token;
    uint32_t index; /* number of the entry, as the dictionary counts them */
} brace_can_read_entry_request_t;
uint32_t brace_can_pack_read_entry_request(const brace_can_read_entry_request_t *message, uint8_t data[8]);
void brace_can_unpack_read_entry_request(const uint8_t data[8], brace_can_read_entry_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t index; /* number of the entry, as the dictionary counts them */
    uint32_t value; /* a float's or a whole number's 32 bits, as the entry's type says */
} brace_can_read_entry_answer_0_t;
uint32_t brace_can_pack_read_entry_answer_0(const brace_can_read_entry_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_read_entry_answer_0(const uint8_t data[8], brace_can_read_entry_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t index; /* number of the entry, as the dictionary counts them */
    uint32_t value; /* a float's or a whole number's 32 bits, as the entry's type says */
} brace_can_write_entry_request_t;
uint32_t brace_can_pack_write_entry_request(const brace_can_write_entry_request_t *message, uint8_t data[8]);
void brace_can_unpack_write_entry_request(const uint8_t data[8], brace_can_write_entry_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t index; /* number of the entry, as the dictionary counts them */
    uint32_t value; /* the same, read back from where it was staged */
} brace_can_write_entry_answer_0_t;
uint32_t brace_can_pack_write_entry_answer_0(const brace_can_write_entry_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_write_entry_answer_0(const uint8_t data[8], brace_can_write_entry_answer_0_t *message);

typedef struct {
    uint32_t token;
    float theta1_rad; /* true angle of the femur from +x [rad, -8.38861 to 8.38861] */
    float theta2_rad; /* true flexion of the knee [rad, -8.38861 to 8.38861] */
} brace_can_k_at_posture_request_t;
uint32_t brace_can_pack_k_at_posture_request(const brace_can_k_at_posture_request_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_request(const uint8_t data[8], brace_can_k_at_posture_request_t *message);

typedef struct {
    uint32_t token;
    float k_xx_n_per_mm; /* force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm; /* force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
} brace_can_k_at_posture_answer_0_t;
uint32_t brace_can_pack_k_at_posture_answer_0(const brace_can_k_at_posture_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_0(const uint8_t data[8], brace_can_k_at_posture_answer_0_t *message);

typedef struct {
    uint32_t token;
    float k_zz_n_per_mm; /* force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float lambda_min_n_per_mm; /* smaller eigenvalue of K [N/mm, 0 to 8388.61] */
} brace_can_k_at_posture_answer_1_t;
uint32_t brace_can_pack_k_at_posture_answer_1(const brace_can_k_at_posture_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_1(const uint8_t data[8], brace_can_k_at_posture_answer_1_t *message);

typedef struct {
    uint32_t token;
    float lambda_max_n_per_mm; /* larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float stiff_axis_rad; /* direction of lambda_max from +x [rad, -3.2767 to 3.2767] */
    uint32_t flags; /* quality of K */
} brace_can_k_at_posture_answer_2_t;
uint32_t brace_can_pack_k_at_posture_answer_2(const brace_can_k_at_posture_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_2(const uint8_t data[8], brace_can_k_at_posture_answer_2_t *message);

typedef struct {
    uint32_t token;
    float x_mm; /* tip outwards from the femur axis [mm, -8388.61 to 8388.61] */
    float z_mm; /* tip above the femur axis [mm, -8388.61 to 8388.61] */
} brace_can_k_at_tip_knee_up_request_t;
uint32_t brace_can_pack_k_at_tip_knee_up_request(const brace_can_k_at_tip_knee_up_request_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_request(const uint8_t data[8], brace_can_k_at_tip_knee_up_request_t *message);

typedef struct {
    uint32_t token;
    float k_xx_n_per_mm; /* force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm; /* force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
} brace_can_k_at_tip_knee_up_answer_0_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_0(const brace_can_k_at_tip_knee_up_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_0(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_0_t *message);

typedef struct {
    uint32_t token;
    float k_zz_n_per_mm; /* force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float lambda_min_n_per_mm; /* smaller eigenvalue of K [N/mm, 0 to 8388.61] */
} brace_can_k_at_tip_knee_up_answer_1_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_1(const brace_can_k_at_tip_knee_up_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_1(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_1_t *message);

typedef struct {
    uint32_t token;
    float lambda_max_n_per_mm; /* larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float stiff_axis_rad; /* direction of lambda_max from +x [rad, -3.2767 to 3.2767] */
    uint32_t flags; /* quality of K */
} brace_can_k_at_tip_knee_up_answer_2_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_2(const brace_can_k_at_tip_knee_up_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_2(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_2_t *message);

typedef struct {
    uint32_t token;
    float x_mm; /* tip outwards from the femur axis [mm, -8388.61 to 8388.61] */
    float z_mm; /* tip above the femur axis [mm, -8388.61 to 8388.61] */
} brace_can_k_at_tip_knee_down_request_t;
uint32_t brace_can_pack_k_at_tip_knee_down_request(const brace_can_k_at_tip_knee_down_request_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_request(const uint8_t data[8], brace_can_k_at_tip_knee_down_request_t *message);

typedef struct {
    uint32_t token;
    float k_xx_n_per_mm; /* force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm; /* force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
} brace_can_k_at_tip_knee_down_answer_0_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_0(const brace_can_k_at_tip_knee_down_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_0(const uint8_t data[8], brace_can_k_at_tip_knee_down_answer_0_t *message);

typedef struct {
    uint32_t token;
    float k_zz_n_per_mm; /* force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float lambda_min_n_per_mm; /* smaller eigenvalue of K [N/mm, 0 to 8388.61] */
} brace_can_k_at_tip_knee_down_answer_1_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_1(const brace_can_k_at_tip_knee_down_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_1(const uint8_t data[8], brace_can_k_at_tip_knee_down_answer_1_t *message);

typedef struct {
    uint32_t token;
    float lambda_max_n_per_mm; /* larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float stiff_axis_rad; /* direction of lambda_max from +x [rad, -3.2767 to 3.2767] */
    uint32_t flags; /* quality of K */
} brace_can_k_at_tip_knee_down_answer_2_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_2(const brace_can_k_at_tip_knee_down_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_2(const uint8_t data[8], brace_can_k_at_tip_knee_down_answer_2_t *message);

typedef struct {
    uint32_t token;
    float dx_mm; /* displacement of the tip along x [mm, -838.861 to 838.861] */
    float dz_mm; /* along z [mm, -838.861 to 838.861] */
} brace_can_contact_force_request_t;
uint32_t brace_can_pack_contact_force_request(const brace_can_contact_force_request_t *message, uint8_t data[8]);
void brace_can_unpack_contact_force_request(const uint8_t data[8], brace_can_contact_force_request_t *message);

typedef struct {
    uint32_t token;
    float fx_n; /* force along x [N, -8388.61 to 8388.61] */
    float fz_n; /* force along z [N, -8388.61 to 8388.61] */
} brace_can_contact_force_answer_0_t;
uint32_t brace_can_pack_contact_force_answer_0(const brace_can_contact_force_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_contact_force_answer_0(const uint8_t data[8], brace_can_contact_force_answer_0_t *message);

typedef struct {
    uint32_t token;
    float low_n; /* what any displacement of this size gives at least [N, 0 to 16777.2] */
    float high_n; /* and at most [N, 0 to 16777.2] */
} brace_can_contact_force_answer_1_t;
uint32_t brace_can_pack_contact_force_answer_1(const brace_can_contact_force_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_contact_force_answer_1(const uint8_t data[8], brace_can_contact_force_answer_1_t *message);

typedef struct {
    uint32_t token;
    float fx_n; /* force along x [N, -8388.61 to 8388.61] */
    float fz_n; /* force along z [N, -8388.61 to 8388.61] */
} brace_can_sag_for_load_request_t;
uint32_t brace_can_pack_sag_for_load_request(const brace_can_sag_for_load_request_t *message, uint8_t data[8]);
void brace_can_unpack_sag_for_load_request(const uint8_t data[8], brace_can_sag_for_load_request_t *message);

typedef struct {
    uint32_t token;
    float dx_mm; /* displacement along x [mm, -838.861 to 838.861] */
    float dz_mm; /* along z [mm, -838.861 to 838.861] */
} brace_can_sag_for_load_answer_0_t;
uint32_t brace_can_pack_sag_for_load_answer_0(const brace_can_sag_for_load_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_sag_for_load_answer_0(const uint8_t data[8], brace_can_sag_for_load_answer_0_t *message);

typedef struct {
    uint32_t token;
    float normal_rad; /* direction of the surface's normal, towards the limb, from +x [rad, -3.2767 to 3.2767] */
    float friction_ratio; /* friction coefficient mu, at most 10 [1, 0 to 65.534] */
} brace_can_friction_margin_request_t;
uint32_t brace_can_pack_friction_margin_request(const brace_can_friction_margin_request_t *message, uint8_t data[8]);
void brace_can_unpack_friction_margin_request(const uint8_t data[8], brace_can_friction_margin_request_t *message);

typedef struct {
    uint32_t token;
    float margin_n; /* what may be added along the surface before it slides [N, -8388.61 to 8388.61] */
    float angle_left_rad; /* from the force to the edge of the cone [rad, -3.2767 to 3.2767] */
    uint32_t contact; /* how the foot stands */
} brace_can_friction_margin_answer_0_t;
uint32_t brace_can_pack_friction_margin_answer_0(const brace_can_friction_margin_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_friction_margin_answer_0(const uint8_t data[8], brace_can_friction_margin_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t mode; /* wanted */
    uint32_t key; /* 0xc0de, so that no stray frame does it */
} brace_can_set_mode_request_t;
uint32_t brace_can_pack_set_mode_request(const brace_can_set_mode_request_t *message, uint8_t data[8]);
void brace_can_unpack_set_mode_request(const uint8_t data[8], brace_can_set_mode_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t mode; /* the controller's mode now; on the way back to MONITOR that is START, until there are samples */
} brace_can_set_mode_answer_0_t;
uint32_t brace_can_pack_set_mode_answer_0(const brace_can_set_mode_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_set_mode_answer_0(const uint8_t data[8], brace_can_set_mode_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t bytes; /* of the block */
    uint32_t crc; /* the CRC-32 that ends it */
} brace_can_upload_begin_request_t;
uint32_t brace_can_pack_upload_begin_request(const brace_can_upload_begin_request_t *message, uint8_t data[8]);
void brace_can_unpack_upload_begin_request(const uint8_t data[8], brace_can_upload_begin_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t words; /* expected */
} brace_can_upload_begin_answer_0_t;
uint32_t brace_can_pack_upload_begin_answer_0(const brace_can_upload_begin_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_upload_begin_answer_0(const uint8_t data[8], brace_can_upload_begin_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t word; /* number of the 4-byte word of the block, from 0 */
    uint32_t data; /* its bytes, first byte lowest */
} brace_can_upload_word_request_t;
uint32_t brace_can_pack_upload_word_request(const brace_can_upload_word_request_t *message, uint8_t data[8]);
void brace_can_unpack_upload_word_request(const uint8_t data[8], brace_can_upload_word_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t word; /* number of the 4-byte word of the block, from 0 */
    uint32_t data; /* its bytes, first byte lowest */
} brace_can_upload_word_answer_0_t;
uint32_t brace_can_pack_upload_word_answer_0(const brace_can_upload_word_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_upload_word_answer_0(const uint8_t data[8], brace_can_upload_word_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t crc; /* of the block uploaded; 0: of the set with the staged entries, not checked */
} brace_can_commit_request_t;
uint32_t brace_can_pack_commit_request(const brace_can_commit_request_t *message, uint8_t data[8]);
void brace_can_unpack_commit_request(const uint8_t data[8], brace_can_commit_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t sequence; /* of the set now in force */
} brace_can_commit_answer_0_t;
uint32_t brace_can_pack_commit_answer_0(const brace_can_commit_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_commit_answer_0(const uint8_t data[8], brace_can_commit_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t crc; /* of the set now in force */
} brace_can_commit_answer_1_t;
uint32_t brace_can_pack_commit_answer_1(const brace_can_commit_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_commit_answer_1(const uint8_t data[8], brace_can_commit_answer_1_t *message);

typedef struct {
    uint32_t token;
} brace_can_rollback_request_t;
uint32_t brace_can_pack_rollback_request(const brace_can_rollback_request_t *message, uint8_t data[8]);
void brace_can_unpack_rollback_request(const uint8_t data[8], brace_can_rollback_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t sequence; /* of the set now in force */
} brace_can_rollback_answer_0_t;
uint32_t brace_can_pack_rollback_answer_0(const brace_can_rollback_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_rollback_answer_0(const uint8_t data[8], brace_can_rollback_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t crc; /* of the set now in force */
} brace_can_rollback_answer_1_t;
uint32_t brace_can_pack_rollback_answer_1(const brace_can_rollback_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_rollback_answer_1(const uint8_t data[8], brace_can_rollback_answer_1_t *message);

typedef struct {
    uint32_t token;
    uint32_t word; /* number of the 4-byte word of the block, from 0 */
} brace_can_download_word_request_t;
uint32_t brace_can_pack_download_word_request(const brace_can_download_word_request_t *message, uint8_t data[8]);
void brace_can_unpack_download_word_request(const uint8_t data[8], brace_can_download_word_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t word; /* number of the 4-byte word of the block, from 0 */
    uint32_t data; /* its bytes, first byte lowest; of word 65535 the block's bytes in the low half, in the high one where the set comes from: 0 DEFAULT, 1 SLOT_A, 2 SLOT_B */
} brace_can_download_word_answer_0_t;
uint32_t brace_can_pack_download_word_answer_0(const brace_can_download_word_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_download_word_answer_0(const uint8_t data[8], brace_can_download_word_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t joint; /* 1 femur, 2 tibia */
    int32_t flank; /* +1 or -1 */
} brace_can_take_up_request_t;
uint32_t brace_can_pack_take_up_request(const brace_can_take_up_request_t *message, uint8_t data[8]);
void brace_can_unpack_take_up_request(const uint8_t data[8], brace_can_take_up_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t phase; /* of the joint's take-up, as it was when this was asked */
} brace_can_take_up_answer_0_t;
uint32_t brace_can_pack_take_up_answer_0(const brace_can_take_up_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_take_up_answer_0(const uint8_t data[8], brace_can_take_up_answer_0_t *message);

typedef struct {
    uint32_t token;
} brace_can_let_go_request_t;
uint32_t brace_can_pack_let_go_request(const brace_can_let_go_request_t *message, uint8_t data[8]);
void brace_can_unpack_let_go_request(const uint8_t data[8], brace_can_let_go_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t mode; /* the controller's mode now */
} brace_can_let_go_answer_0_t;
uint32_t brace_can_pack_let_go_answer_0(const brace_can_let_go_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_let_go_answer_0(const uint8_t data[8], brace_can_let_go_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t axis; /* 0 x, 1 z */
    uint32_t steps_per_side; /* to each side, 2 to 60 */
    float step_mm; /* of the tip, 0.001 to 50 mm [mm, 0 to 65.534] */
    uint32_t dwell_ms; /* at each step, 20 to 10000 */
} brace_can_loading_test_start_request_t;
uint32_t brace_can_pack_loading_test_start_request(const brace_can_loading_test_start_request_t *message, uint8_t data[8]);
void brace_can_unpack_loading_test_start_request(const uint8_t data[8], brace_can_loading_test_start_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t rows; /* that it will take */
} brace_can_loading_test_start_answer_0_t;
uint32_t brace_can_pack_loading_test_start_answer_0(const brace_can_loading_test_start_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_loading_test_start_answer_0(const uint8_t data[8], brace_can_loading_test_start_answer_0_t *message);

typedef struct {
    uint32_t token;
} brace_can_loading_test_stop_request_t;
uint32_t brace_can_pack_loading_test_stop_request(const brace_can_loading_test_stop_request_t *message, uint8_t data[8]);
void brace_can_unpack_loading_test_stop_request(const uint8_t data[8], brace_can_loading_test_stop_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t rows; /* there now */
} brace_can_loading_test_stop_answer_0_t;
uint32_t brace_can_pack_loading_test_stop_answer_0(const brace_can_loading_test_stop_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_loading_test_stop_answer_0(const uint8_t data[8], brace_can_loading_test_stop_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t row; /* 0 is the oldest */
    uint32_t column; /* 0 run, 1 config, 2 theta1_rad, 3 theta2_rad, 4 axis (0 x, 1 z), 5 rep, 6 step, 7 t_s, 8 temp_degc, 9 dx_mm, 10 dz_mm, 11 fx_n, 12 fz_n, 13 enc1_rad, 14 enc2_rad: docs/datasets.md has what they are */
} brace_can_fetch_row_request_t;
uint32_t brace_can_pack_fetch_row_request(const brace_can_fetch_row_request_t *message, uint8_t data[8]);
void brace_can_unpack_fetch_row_request(const uint8_t data[8], brace_can_fetch_row_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t row; /* as asked */
    uint32_t column; /* as asked */
    float value; /* the number */
} brace_can_fetch_row_answer_0_t;
uint32_t brace_can_pack_fetch_row_answer_0(const brace_can_fetch_row_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_fetch_row_answer_0(const uint8_t data[8], brace_can_fetch_row_answer_0_t *message);

typedef struct {
    uint32_t token;
} brace_can_identify_request_t;
uint32_t brace_can_pack_identify_request(const brace_can_identify_request_t *message, uint8_t data[8]);
void brace_can_unpack_identify_request(const uint8_t data[8], brace_can_identify_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t major; /* firmware version */
    uint32_t minor; /* firmware version */
    uint32_t patch; /* firmware version */
    uint32_t protocol; /* of these frames */
    uint32_t node; /* number on the bus */
} brace_can_identify_answer_0_t;
uint32_t brace_can_pack_identify_answer_0(const brace_can_identify_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_0(const uint8_t data[8], brace_can_identify_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t dictionary_hash; /* of everything that matters on the wire */
} brace_can_identify_answer_1_t;
uint32_t brace_can_pack_identify_answer_1(const brace_can_identify_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_1(const uint8_t data[8], brace_can_identify_answer_1_t *message);

typedef struct {
    uint32_t token;
    uint32_t schema_hash; /* of the parameter block's list */
} brace_can_identify_answer_2_t;
uint32_t brace_can_pack_identify_answer_2(const brace_can_identify_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_2(const uint8_t data[8], brace_can_identify_answer_2_t *message);

typedef struct {
    uint32_t token;
    uint32_t parameter_crc; /* of the set in force */
    uint32_t origin; /* where it comes from */
} brace_can_identify_answer_3_t;
uint32_t brace_can_pack_identify_answer_3(const brace_can_identify_answer_3_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_3(const uint8_t data[8], brace_can_identify_answer_3_t *message);

typedef struct {
    uint32_t token;
    uint32_t item; /* 0 loading_outcome, 1 loading_rows and so on, as the entries below go on */
} brace_can_loading_test_result_request_t;
uint32_t brace_can_pack_loading_test_result_request(const brace_can_loading_test_result_request_t *message, uint8_t data[8]);
void brace_can_unpack_loading_test_result_request(const uint8_t data[8], brace_can_loading_test_result_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t item; /* as asked */
    int32_t outcome; /* of the test: 0 none, 1 running, 2 done, 3 stopped; -1 force, -2 torque, -3 travel beyond its bound, -4 not done in time, -5 no force known, -6 a fault or a flank let go, -7 the motors do not follow */
    float value; /* the number */
} brace_can_loading_test_result_answer_0_t;
uint32_t brace_can_pack_loading_test_result_answer_0(const brace_can_loading_test_result_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_loading_test_result_answer_0(const uint8_t data[8], brace_can_loading_test_result_answer_0_t *message);

typedef struct {
    uint32_t token;
    uint32_t faults; /* bits */
} brace_can_clear_request_t;
uint32_t brace_can_pack_clear_request(const brace_can_clear_request_t *message, uint8_t data[8]);
void brace_can_unpack_clear_request(const uint8_t data[8], brace_can_clear_request_t *message);

typedef struct {
    uint32_t token;
    uint32_t faults; /* that are there now */
} brace_can_clear_answer_0_t;
uint32_t brace_can_pack_clear_answer_0(const brace_can_clear_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_clear_answer_0(const uint8_t data[8], brace_can_clear_answer_0_t *message);

typedef struct {
    uint32_t token;
    int32_t status; /* why: docs/errors.md, statuses and refusals */
    uint32_t detail; /* what more there is to say: an index, a mode, a hash */
} brace_can_refusal_t;
uint32_t brace_can_pack_refusal(const brace_can_refusal_t *message, uint8_t data[8]);
void brace_can_unpack_refusal(const uint8_t data[8], brace_can_refusal_t *message);

#endif
