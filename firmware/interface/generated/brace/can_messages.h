/* Written by tools/interface from messages.toml; do not edit. */
#ifndef BRACE_CAN_MESSAGES_H
#define BRACE_CAN_MESSAGES_H

/* The frames of the wire, for the controller and for whoever speaks to it. Formats: docs/protocol.md.
 *
 * A value that is not known is NaN here and a code of its own on the wire, never zero. brace_can_pack_... limits what
 * does not fit and answers how many values it limited; the frame's bytes are always written. The greatest value that a
 * message's signal can carry is BRACE_CAN_<MESSAGE>_<MEMBER>_MOST; a signed one goes as far down. brace_can_unpack_...
 * always writes the struct: every bit pattern means something. Pure functions, no libm; any thread.
 * accuracy: half a step, and a float's rounding.
 * cost on a Cortex-M4F: below 120 instructions each; of the CAN FD frame 250.
 */
#include <stdint.h>

/* Of every frame, entry and parameter, with types, steps and units: what two ends must agree on. */
#define BRACE_DICTIONARY_HASH 0x5e29be72u
#define BRACE_PROTOCOL 2u

/* Identifiers of node 0; a controller adds its node number, 1-127. */
enum {
    BRACE_CAN_ID_EMERGENCY = 0x080,
    BRACE_CAN_ID_STIFFNESS_A = 0x180,
    BRACE_CAN_ID_STIFFNESS_B = 0x280,
    BRACE_CAN_ID_EIGENVALUES = 0x380,
    BRACE_CAN_ID_POSTURE = 0x480,
    BRACE_CAN_ID_HEARTBEAT = 0x700,
    BRACE_CAN_ID_DETAILS = 0x200,
    BRACE_CAN_ID_DETAILS_FD = 0x300,
    BRACE_CAN_ID_SNAPSHOT_FD = 0x500,
    BRACE_CAN_ID_REQUEST = 0x600,
    BRACE_CAN_ID_ANSWER = 0x580
};

/* First byte of a request. */
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
    BRACE_REQUEST_K_IN_SPACE_AT_POSTURE = 23,
    BRACE_REQUEST_DRIFT = 24,
    BRACE_REQUEST_TAKE_UP_RESULT = 25,
    BRACE_REQUEST_SET_GRAVITY = 26,
    BRACE_REQUEST_TIP_FORCE = 27,
    BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE = 28,
    BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP = 29,
    BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN = 30,
    BRACE_REQUEST_TIP_FORCE_IN_SPACE = 31,
    BRACE_REQUEST_SIGN_OF_LIFE = 32,
};

/* First byte of an answer: the number of this frame, which no other answer has. */
enum {
    BRACE_READ_ENTRY_ANSWER_0 = 1,
    BRACE_WRITE_ENTRY_ANSWER_0 = 2,
    BRACE_K_AT_POSTURE_ANSWER_0 = 3,
    BRACE_K_AT_POSTURE_ANSWER_1 = 4,
    BRACE_K_AT_POSTURE_ANSWER_2 = 5,
    BRACE_K_AT_POSTURE_ANSWER_3 = 6,
    BRACE_K_AT_TIP_KNEE_UP_ANSWER_0 = 7,
    BRACE_K_AT_TIP_KNEE_UP_ANSWER_1 = 8,
    BRACE_K_AT_TIP_KNEE_UP_ANSWER_2 = 9,
    BRACE_K_AT_TIP_KNEE_UP_ANSWER_3 = 10,
    BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_0 = 11,
    BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_1 = 12,
    BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_2 = 13,
    BRACE_K_AT_TIP_KNEE_DOWN_ANSWER_3 = 14,
    BRACE_CONTACT_FORCE_ANSWER_0 = 15,
    BRACE_CONTACT_FORCE_ANSWER_1 = 16,
    BRACE_SAG_FOR_LOAD_ANSWER_0 = 17,
    BRACE_FRICTION_MARGIN_ANSWER_0 = 18,
    BRACE_SET_MODE_ANSWER_0 = 19,
    BRACE_UPLOAD_BEGIN_ANSWER_0 = 20,
    BRACE_UPLOAD_WORD_ANSWER_0 = 21,
    BRACE_COMMIT_ANSWER_0 = 22,
    BRACE_COMMIT_ANSWER_1 = 23,
    BRACE_ROLLBACK_ANSWER_0 = 24,
    BRACE_ROLLBACK_ANSWER_1 = 25,
    BRACE_DOWNLOAD_WORD_ANSWER_0 = 26,
    BRACE_TAKE_UP_ANSWER_0 = 27,
    BRACE_LET_GO_ANSWER_0 = 28,
    BRACE_LOADING_TEST_START_ANSWER_0 = 29,
    BRACE_LOADING_TEST_STOP_ANSWER_0 = 30,
    BRACE_FETCH_ROW_ANSWER_0 = 31,
    BRACE_IDENTIFY_ANSWER_0 = 32,
    BRACE_IDENTIFY_ANSWER_1 = 33,
    BRACE_IDENTIFY_ANSWER_2 = 34,
    BRACE_IDENTIFY_ANSWER_3 = 35,
    BRACE_IDENTIFY_ANSWER_4 = 36,
    BRACE_LOADING_TEST_RESULT_ANSWER_0 = 37,
    BRACE_CLEAR_ANSWER_0 = 38,
    BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_0 = 39,
    BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_1 = 40,
    BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_2 = 41,
    BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_3 = 42,
    BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_4 = 43,
    BRACE_K_IN_SPACE_AT_POSTURE_ANSWER_5 = 44,
    BRACE_DRIFT_ANSWER_0 = 45,
    BRACE_DRIFT_ANSWER_1 = 46,
    BRACE_DRIFT_ANSWER_2 = 47,
    BRACE_TAKE_UP_RESULT_ANSWER_0 = 48,
    BRACE_SET_GRAVITY_ANSWER_0 = 49,
    BRACE_TIP_FORCE_ANSWER_0 = 50,
    BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_0 = 51,
    BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_1 = 52,
    BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_2 = 53,
    BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_3 = 54,
    BRACE_K_UNDER_LOAD_AT_POSTURE_ANSWER_4 = 55,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_0 = 56,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_1 = 57,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_2 = 58,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_3 = 59,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_UP_ANSWER_4 = 60,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_0 = 61,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_1 = 62,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_2 = 63,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_3 = 64,
    BRACE_K_UNDER_LOAD_AT_TIP_KNEE_DOWN_ANSWER_4 = 65,
    BRACE_TIP_FORCE_IN_SPACE_ANSWER_0 = 66,
    BRACE_SIGN_OF_LIFE_ANSWER_0 = 67,
    BRACE_ANSWER_REFUSED = 255
};

/* Frames of the answer, by the request's code; 0: no such request. */
extern const uint8_t brace_can_answer_parts[256];

/* Whose answer's frame a number is, and which of its frames, counted from 0; parts of 0: nobody's. */
typedef struct {
    uint8_t code, part, parts;
} brace_can_answer_frame_t;
extern const brace_can_answer_frame_t brace_can_answer_frames[256];

/* Which frame of details it is: BRACE_CAN_PART_..., or a number that this list lacks. */
enum {
    BRACE_CAN_PART_CONDITION = 0,
    BRACE_CAN_PART_SPACE_0 = 16,
    BRACE_CAN_PART_SPACE_1 = 17,
    BRACE_CAN_PART_SPACE_2 = 18,
    BRACE_CAN_PART_SPACE_3 = 19,
    BRACE_CAN_PART_SPACE_4 = 20,
    BRACE_CAN_PART_SPACE_5 = 21,
    BRACE_CAN_PART_SPACE_6 = 22,
    BRACE_CAN_PART_LOAD_0 = 32,
    BRACE_CAN_PART_LOAD_1 = 33,
    BRACE_CAN_PART_LOAD_2 = 34,
    BRACE_CAN_PART_LOAD_3 = 35,
    BRACE_CAN_PART_LOAD_4 = 36,
    BRACE_CAN_PART_LOAD_5 = 37,
    BRACE_CAN_PART_LOAD_ACROSS_0 = 48,
    BRACE_CAN_PART_LOAD_ACROSS_1 = 49,
    BRACE_CAN_PART_SIGMA_0 = 64,
    BRACE_CAN_PART_SIGMA_1 = 65,
    BRACE_CAN_PART_SIGMA_SPACE_0 = 80,
    BRACE_CAN_PART_SIGMA_SPACE_1 = 81,
    BRACE_CAN_PART_SIGMA_SPACE_2 = 82,
    BRACE_CAN_PART_SIGMA_SPACE_3 = 83,
    BRACE_CAN_PART_INTERVAL_0 = 96,
    BRACE_CAN_PART_INTERVAL_1 = 97,
    BRACE_CAN_PART_INTERVAL_2 = 98,
    BRACE_CAN_PART_INTERVAL_3 = 99,
    BRACE_CAN_PART_INTERVAL_ACROSS_0 = 112,
    BRACE_CAN_PART_INTERVAL_ACROSS_1 = 113,
};
uint32_t brace_can_details_part(const uint8_t *data);

/* Which frame of details_fd it is: BRACE_CAN_PART_..., or a number that this list lacks. */
enum {
    BRACE_CAN_PART_SPACE_FD = 16,
    BRACE_CAN_PART_LOAD_FD = 32,
    BRACE_CAN_PART_SIGMA_FD = 64,
    BRACE_CAN_PART_INTERVAL_FD = 96,
};
uint32_t brace_can_details_fd_part(const uint8_t *data);

/* a fault has come or gone, or the likeliest cause of a drift is another one */
typedef struct {
    /* the CANopen code of the fault that came: 0x7300 SENSOR_FEMUR, SENSOR_TIBIA, SENSOR_COXA; 0x7305
     * ENCODER_STUCK, JUMP_COXA, JUMP_FEMUR, JUMP_TIBIA; 0x6100 TICK_LATE; 0x6320 PARAMETERS, OLD_PARAMETERS;
     * 0x5530 STORE; 0x8140 CAN_BUS_OFF; 0xff01 MODEL_DRIFT; 0x6010 CRASHED; 0x7120 DRIVE_REFUSES; 0x5510 MEMORY;
     * 0xff01 also where a drift has another cause now; 0x1000 where one has gone and others are there; 0x0000
     * where the last one has gone */
    uint32_t error_code;
    /* 1 while any fault is there */
    uint32_t error_register;
    /* the likeliest cause of the drift while MODEL_DRIFT is there, else NONE */
    uint32_t drift_cause;
    /* what the controller is doing */
    uint32_t mode;
    /* the faults that are there now */
    uint32_t faults;
} brace_can_emergency_t;
uint32_t brace_can_pack_emergency(const brace_can_emergency_t *message, uint8_t data[8]);
void brace_can_unpack_emergency(const uint8_t data[8], brace_can_emergency_t *message);

/* K at the tip, first half; the second is stiffness_b of the same sequence */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
    /* the age of the joints' samples when the frame was made; 127 ms stands for 127 ms and more [ms, 0 to 127] */
    float age_ms;
} brace_can_stiffness_a_t;
#define BRACE_CAN_STIFFNESS_A_K_XX_N_PER_MM_MOST 4194.3035f
#define BRACE_CAN_STIFFNESS_A_K_XZ_N_PER_MM_MOST 4194.3035f
#define BRACE_CAN_STIFFNESS_A_AGE_MS_MOST 127.0f
uint32_t brace_can_pack_stiffness_a(const brace_can_stiffness_a_t *message, uint8_t data[8]);
void brace_can_unpack_stiffness_a(const uint8_t data[8], brace_can_stiffness_a_t *message);

/* K at the tip, second half, and what it is worth */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the quality of K */
    uint32_t flags;
    /* which side of the femur joint's backlash is loaded */
    uint32_t play_femur;
    /* which side of the tibia joint's backlash is loaded */
    uint32_t play_tibia;
    /* what the controller is doing */
    uint32_t mode;
} brace_can_stiffness_b_t;
#define BRACE_CAN_STIFFNESS_B_K_ZZ_N_PER_MM_MOST 4194.3035f
uint32_t brace_can_pack_stiffness_b(const brace_can_stiffness_b_t *message, uint8_t data[8]);
void brace_can_unpack_stiffness_b(const uint8_t data[8], brace_can_stiffness_b_t *message);

/* eigenvalues of K and the direction of the stiffer */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the smaller eigenvalue of K [N/mm, 0 to 524.287] */
    float lambda_min_n_per_mm;
    /* the larger eigenvalue of K [N/mm, 0 to 5242.87] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_eigenvalues_t;
#define BRACE_CAN_EIGENVALUES_LAMBDA_MIN_N_PER_MM_MOST 524.287f
#define BRACE_CAN_EIGENVALUES_LAMBDA_MAX_N_PER_MM_MOST 5242.87f
#define BRACE_CAN_EIGENVALUES_STIFF_AXIS_RAD_MOST 3.2767f
uint32_t brace_can_pack_eigenvalues(const brace_can_eigenvalues_t *message, uint8_t data[8]);
void brace_can_unpack_eigenvalues(const uint8_t data[8], brace_can_eigenvalues_t *message);

/* true joint angles of the snapshot, and the parameters in force */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the true angle of the femur, measured from +x [rad, -10.4857 to 10.4857] */
    float theta1_rad;
    /* the true flexion of the knee [rad, -10.4857 to 10.4857] */
    float theta2_rad;
    /* the low half of the CRC of the parameters in force */
    uint32_t parameter_tag;
} brace_can_posture_t;
#define BRACE_CAN_POSTURE_THETA1_RAD_MOST 10.48574f
#define BRACE_CAN_POSTURE_THETA2_RAD_MOST 10.48574f
uint32_t brace_can_pack_posture(const brace_can_posture_t *message, uint8_t data[8]);
void brace_can_unpack_posture(const uint8_t data[8], brace_can_posture_t *message);

/* the controller lives, and speaks this dictionary; the part condition of details follows each heartbeat */
typedef struct {
    /* the state as CANopen numbers it */
    uint32_t state;
    /* what the controller is doing */
    uint32_t mode;
    /* who may move the limb and write to this controller */
    uint32_t setting;
    /* the version of these frames */
    uint32_t protocol;
    /* a checksum over everything on the wire; two ends whose hashes differ cannot understand each other */
    uint32_t dictionary_hash;
} brace_can_heartbeat_t;
uint32_t brace_can_pack_heartbeat(const brace_can_heartbeat_t *message, uint8_t data[8]);
void brace_can_unpack_heartbeat(const uint8_t data[8], brace_can_heartbeat_t *message);

/* what is wrong, and who may move the limb; it follows each heartbeat */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the faults that are there now */
    uint32_t faults;
    /* what the controller is doing */
    uint32_t mode;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_condition_t;
uint32_t brace_can_pack_condition(const brace_can_condition_t *message, uint8_t data[8]);
void brace_can_unpack_condition(const uint8_t data[8], brace_can_condition_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 1 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along y, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xy_n_per_mm;
} brace_can_space_0_t;
#define BRACE_CAN_SPACE_0_K_XX_N_PER_MM_MOST 4194.3035f
#define BRACE_CAN_SPACE_0_K_XY_N_PER_MM_MOST 4194.3035f
uint32_t brace_can_pack_space_0(const brace_can_space_0_t *message, uint8_t data[8]);
void brace_can_unpack_space_0(const uint8_t data[8], brace_can_space_0_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 2 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
    /* the force along y per displacement along y [N/mm, -4194.3 to 4194.3] */
    float k_yy_n_per_mm;
} brace_can_space_1_t;
#define BRACE_CAN_SPACE_1_K_XZ_N_PER_MM_MOST 4194.3035f
#define BRACE_CAN_SPACE_1_K_YY_N_PER_MM_MOST 4194.3035f
uint32_t brace_can_pack_space_1(const brace_can_space_1_t *message, uint8_t data[8]);
void brace_can_unpack_space_1(const uint8_t data[8], brace_can_space_1_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 3 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force along y per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_yz_n_per_mm;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
} brace_can_space_2_t;
#define BRACE_CAN_SPACE_2_K_YZ_N_PER_MM_MOST 4194.3035f
#define BRACE_CAN_SPACE_2_K_ZZ_N_PER_MM_MOST 4194.3035f
uint32_t brace_can_pack_space_2(const brace_can_space_2_t *message, uint8_t data[8]);
void brace_can_unpack_space_2(const uint8_t data[8], brace_can_space_2_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 4 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the smallest eigenvalue of K in space [N/mm, 0 to 8388.61] */
    float lambda_1_n_per_mm;
    /* the middle eigenvalue of K in space [N/mm, 0 to 8388.61] */
    float lambda_2_n_per_mm;
} brace_can_space_3_t;
#define BRACE_CAN_SPACE_3_LAMBDA_1_N_PER_MM_MOST 8388.607f
#define BRACE_CAN_SPACE_3_LAMBDA_2_N_PER_MM_MOST 8388.607f
uint32_t brace_can_pack_space_3(const brace_can_space_3_t *message, uint8_t data[8]);
void brace_can_unpack_space_3(const uint8_t data[8], brace_can_space_3_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 5 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the largest eigenvalue of K in space [N/mm, 0 to 8388.61] */
    float lambda_3_n_per_mm;
    /* the quality of K in space */
    uint32_t flags;
    /* the age of the joints' samples when the frame was made; 127 ms stands for 127 ms and more [ms, 0 to 127] */
    float age_ms;
} brace_can_space_4_t;
#define BRACE_CAN_SPACE_4_LAMBDA_3_N_PER_MM_MOST 8388.607f
#define BRACE_CAN_SPACE_4_AGE_MS_MOST 127.0f
uint32_t brace_can_pack_space_4(const brace_can_space_4_t *message, uint8_t data[8]);
void brace_can_unpack_space_4(const uint8_t data[8], brace_can_space_4_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 6 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the x component of the unit vector along which K in space is largest [, -1.63835 to 1.63835] */
    float stiff_axis_x;
    /* the y component of the unit vector along which K in space is largest [, -1.63835 to 1.63835] */
    float stiff_axis_y;
    /* the z component of the unit vector along which K in space is largest [, -1.63835 to 1.63835] */
    float stiff_axis_z;
} brace_can_space_5_t;
#define BRACE_CAN_SPACE_5_STIFF_AXIS_X_MOST 1.63835f
#define BRACE_CAN_SPACE_5_STIFF_AXIS_Y_MOST 1.63835f
#define BRACE_CAN_SPACE_5_STIFF_AXIS_Z_MOST 1.63835f
uint32_t brace_can_pack_space_5(const brace_can_space_5_t *message, uint8_t data[8]);
void brace_can_unpack_space_5(const uint8_t data[8], brace_can_space_5_t *message);

/* K in space, in the robot's base frame; only a limb whose coxa joint is fitted sends it, each snapshot in all its
 * parts: frame 7 of 7 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the true angle of the coxa joint [rad, -10.4857 to 10.4857] */
    float theta0_rad;
    /* the force across the limb's plane per displacement across it [N/mm, 0 to 8388.61] */
    float k_across_n_per_mm;
    /* which side of the coxa joint's backlash is loaded */
    uint32_t play_coxa;
} brace_can_space_6_t;
#define BRACE_CAN_SPACE_6_THETA0_RAD_MOST 10.48574f
#define BRACE_CAN_SPACE_6_K_ACROSS_N_PER_MM_MOST 8388.607f
uint32_t brace_can_pack_space_6(const brace_can_space_6_t *message, uint8_t data[8]);
void brace_can_unpack_space_6(const uint8_t data[8], brace_can_space_6_t *message);

/* the load that K counts and what it does to the limb, and K without it; each snapshot in all its parts: frame 1
 * of 6 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* k_xx with neither the force on the tip nor the weight counted, every gap closed [N/mm, -4194.3 to 4194.3] */
    float unloaded_k_xx_n_per_mm;
    /* k_xz with neither the force on the tip nor the weight counted, every gap closed [N/mm, -4194.3 to 4194.3] */
    float unloaded_k_xz_n_per_mm;
} brace_can_load_0_t;
#define BRACE_CAN_LOAD_0_UNLOADED_K_XX_N_PER_MM_MOST 4194.3035f
#define BRACE_CAN_LOAD_0_UNLOADED_K_XZ_N_PER_MM_MOST 4194.3035f
uint32_t brace_can_pack_load_0(const brace_can_load_0_t *message, uint8_t data[8]);
void brace_can_unpack_load_0(const uint8_t data[8], brace_can_load_0_t *message);

/* the load that K counts and what it does to the limb, and K without it; each snapshot in all its parts: frame 2
 * of 6 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* k_zz with neither the force on the tip nor the weight counted, every gap closed [N/mm, -4194.3 to 4194.3] */
    float unloaded_k_zz_n_per_mm;
    /* the quality of K */
    uint32_t flags;
} brace_can_load_1_t;
#define BRACE_CAN_LOAD_1_UNLOADED_K_ZZ_N_PER_MM_MOST 4194.3035f
uint32_t brace_can_pack_load_1(const brace_can_load_1_t *message, uint8_t data[8]);
void brace_can_unpack_load_1(const uint8_t data[8], brace_can_load_1_t *message);

/* the load that K counts and what it does to the limb, and K without it; each snapshot in all its parts: frame 3
 * of 6 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force of the ground on the tip along x that K counts [N, -8388.61 to 8388.61] */
    float counted_force_x_n;
    /* the force of the ground on the tip along z that K counts [N, -8388.61 to 8388.61] */
    float counted_force_z_n;
} brace_can_load_2_t;
#define BRACE_CAN_LOAD_2_COUNTED_FORCE_X_N_MOST 8388.607f
#define BRACE_CAN_LOAD_2_COUNTED_FORCE_Z_N_MOST 8388.607f
uint32_t brace_can_pack_load_2(const brace_can_load_2_t *message, uint8_t data[8]);
void brace_can_unpack_load_2(const uint8_t data[8], brace_can_load_2_t *message);

/* the load that K counts and what it does to the limb, and K without it; each snapshot in all its parts: frame 4
 * of 6 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* how far force and weight have moved the tip along x [mm, -8388.61 to 8388.61] */
    float moved_x_mm;
    /* how far force and weight have moved the tip along z [mm, -8388.61 to 8388.61] */
    float moved_z_mm;
} brace_can_load_3_t;
#define BRACE_CAN_LOAD_3_MOVED_X_MM_MOST 8388.607f
#define BRACE_CAN_LOAD_3_MOVED_Z_MM_MOST 8388.607f
uint32_t brace_can_pack_load_3(const brace_can_load_3_t *message, uint8_t data[8]);
void brace_can_unpack_load_3(const uint8_t data[8], brace_can_load_3_t *message);

/* the load that K counts and what it does to the limb, and K without it; each snapshot in all its parts: frame 5
 * of 6 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the multiple of the load at which the limb, held as it stands, would have no stiffness left; infinity where
     * there is none */
    float buckling_factor;
    /* the direction in which the weight pulls, in the limb's plane, from +x [rad, -3.2767 to 3.2767] */
    float gravity_direction_rad;
} brace_can_load_4_t;
#define BRACE_CAN_LOAD_4_GRAVITY_DIRECTION_RAD_MOST 3.2767f
uint32_t brace_can_pack_load_4(const brace_can_load_4_t *message, uint8_t data[8]);
void brace_can_unpack_load_4(const uint8_t data[8], brace_can_load_4_t *message);

/* the load that K counts and what it does to the limb, and K without it; each snapshot in all its parts: frame 6
 * of 6 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* how far the weight's direction leans out of the limb's plane [rad, -3.2767 to 3.2767] */
    float gravity_lean_rad;
} brace_can_load_5_t;
#define BRACE_CAN_LOAD_5_GRAVITY_LEAN_RAD_MOST 3.2767f
uint32_t brace_can_pack_load_5(const brace_can_load_5_t *message, uint8_t data[8]);
void brace_can_unpack_load_5(const uint8_t data[8], brace_can_load_5_t *message);

/* the load across the limb's plane, and K there without it, of the same snapshot as load; only a limb whose coxa
 * joint is fitted sends it, each snapshot in all its parts: frame 1 of 2 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the force of the ground on the tip that K counts across the limb's plane, to the left [N, -8388.61 to
     * 8388.61] */
    float counted_force_y_n;
    /* how far force and weight have moved the tip across the limb's plane, to the left [mm, -8388.61 to 8388.61] */
    float moved_y_mm;
} brace_can_load_across_0_t;
#define BRACE_CAN_LOAD_ACROSS_0_COUNTED_FORCE_Y_N_MOST 8388.607f
#define BRACE_CAN_LOAD_ACROSS_0_MOVED_Y_MM_MOST 8388.607f
uint32_t brace_can_pack_load_across_0(const brace_can_load_across_0_t *message, uint8_t data[8]);
void brace_can_unpack_load_across_0(const uint8_t data[8], brace_can_load_across_0_t *message);

/* the load across the limb's plane, and K there without it, of the same snapshot as load; only a limb whose coxa
 * joint is fitted sends it, each snapshot in all its parts: frame 2 of 2 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* K across the limb's plane with neither the force on the tip nor the weight counted, every gap closed [N/mm,
     * 0 to 8388.61] */
    float unloaded_k_across_n_per_mm;
    /* the quality of K in space */
    uint32_t flags;
} brace_can_load_across_1_t;
#define BRACE_CAN_LOAD_ACROSS_1_UNLOADED_K_ACROSS_N_PER_MM_MOST 8388.607f
uint32_t brace_can_pack_load_across_1(const brace_can_load_across_1_t *message, uint8_t data[8]);
void brace_can_unpack_load_across_1(const uint8_t data[8], brace_can_load_across_1_t *message);

/* one sigma of K at the tip, of its eigenvalues and of its direction, every gap closed, of the same snapshot:
 * frame 1 of 2 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of k_xx [N/mm, 0 to 131.068] */
    float k_xx_n_per_mm;
    /* one sigma of k_xz [N/mm, 0 to 131.068] */
    float k_xz_n_per_mm;
    /* one sigma of k_zz [N/mm, 0 to 131.068] */
    float k_zz_n_per_mm;
} brace_can_sigma_0_t;
#define BRACE_CAN_SIGMA_0_K_XX_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_0_K_XZ_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_0_K_ZZ_N_PER_MM_MOST 131.068f
uint32_t brace_can_pack_sigma_0(const brace_can_sigma_0_t *message, uint8_t data[8]);
void brace_can_unpack_sigma_0(const uint8_t data[8], brace_can_sigma_0_t *message);

/* one sigma of K at the tip, of its eigenvalues and of its direction, every gap closed, of the same snapshot:
 * frame 2 of 2 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of lambda_min [N/mm, 0 to 32.767] */
    float lambda_min_n_per_mm;
    /* one sigma of lambda_max [N/mm, 0 to 262.136] */
    float lambda_max_n_per_mm;
    /* one sigma of stiff_axis [rad, 0 to 6.5534] */
    float stiff_axis_rad;
} brace_can_sigma_1_t;
#define BRACE_CAN_SIGMA_1_LAMBDA_MIN_N_PER_MM_MOST 32.767f
#define BRACE_CAN_SIGMA_1_LAMBDA_MAX_N_PER_MM_MOST 262.136f
#define BRACE_CAN_SIGMA_1_STIFF_AXIS_RAD_MOST 6.5534f
uint32_t brace_can_pack_sigma_1(const brace_can_sigma_1_t *message, uint8_t data[8]);
void brace_can_unpack_sigma_1(const uint8_t data[8], brace_can_sigma_1_t *message);

/* one sigma of K in space, of its eigenvalues and of K across the limb's plane, every gap closed, of the same
 * snapshot: frame 1 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of k_xx in space [N/mm, 0 to 131.068] */
    float k_xx_n_per_mm;
    /* one sigma of k_xy in space [N/mm, 0 to 131.068] */
    float k_xy_n_per_mm;
    /* one sigma of k_xz in space [N/mm, 0 to 131.068] */
    float k_xz_n_per_mm;
} brace_can_sigma_space_0_t;
#define BRACE_CAN_SIGMA_SPACE_0_K_XX_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_SPACE_0_K_XY_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_SPACE_0_K_XZ_N_PER_MM_MOST 131.068f
uint32_t brace_can_pack_sigma_space_0(const brace_can_sigma_space_0_t *message, uint8_t data[8]);
void brace_can_unpack_sigma_space_0(const uint8_t data[8], brace_can_sigma_space_0_t *message);

/* one sigma of K in space, of its eigenvalues and of K across the limb's plane, every gap closed, of the same
 * snapshot: frame 2 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of k_yy in space [N/mm, 0 to 131.068] */
    float k_yy_n_per_mm;
    /* one sigma of k_yz in space [N/mm, 0 to 131.068] */
    float k_yz_n_per_mm;
    /* one sigma of k_zz in space [N/mm, 0 to 131.068] */
    float k_zz_n_per_mm;
} brace_can_sigma_space_1_t;
#define BRACE_CAN_SIGMA_SPACE_1_K_YY_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_SPACE_1_K_YZ_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_SPACE_1_K_ZZ_N_PER_MM_MOST 131.068f
uint32_t brace_can_pack_sigma_space_1(const brace_can_sigma_space_1_t *message, uint8_t data[8]);
void brace_can_unpack_sigma_space_1(const uint8_t data[8], brace_can_sigma_space_1_t *message);

/* one sigma of K in space, of its eigenvalues and of K across the limb's plane, every gap closed, of the same
 * snapshot: frame 3 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of lambda_1 in space [N/mm, 0 to 32.767] */
    float lambda_1_n_per_mm;
    /* one sigma of lambda_2 in space [N/mm, 0 to 131.068] */
    float lambda_2_n_per_mm;
    /* one sigma of lambda_3 in space [N/mm, 0 to 262.136] */
    float lambda_3_n_per_mm;
} brace_can_sigma_space_2_t;
#define BRACE_CAN_SIGMA_SPACE_2_LAMBDA_1_N_PER_MM_MOST 32.767f
#define BRACE_CAN_SIGMA_SPACE_2_LAMBDA_2_N_PER_MM_MOST 131.068f
#define BRACE_CAN_SIGMA_SPACE_2_LAMBDA_3_N_PER_MM_MOST 262.136f
uint32_t brace_can_pack_sigma_space_2(const brace_can_sigma_space_2_t *message, uint8_t data[8]);
void brace_can_unpack_sigma_space_2(const uint8_t data[8], brace_can_sigma_space_2_t *message);

/* one sigma of K in space, of its eigenvalues and of K across the limb's plane, every gap closed, of the same
 * snapshot: frame 4 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of k_across [N/mm, 0 to 131.068] */
    float k_across_n_per_mm;
} brace_can_sigma_space_3_t;
#define BRACE_CAN_SIGMA_SPACE_3_K_ACROSS_N_PER_MM_MOST 131.068f
uint32_t brace_can_pack_sigma_space_3(const brace_can_sigma_space_3_t *message, uint8_t data[8]);
void brace_can_unpack_sigma_space_3(const uint8_t data[8], brace_can_sigma_space_3_t *message);

/* where the force on the tip and the loads of the joints lie with 90 %, of the same snapshot as load: friction in
 * the gears and the doubt of the torque by current are counted: frame 1 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low end of the interval in which the force of the ground on the tip along x lies with 90 % [N, -8388.61
     * to 8388.61] */
    float force_x_low_n;
    /* the high end of the interval in which the force of the ground on the tip along x lies with 90 % [N, -8388.61
     * to 8388.61] */
    float force_x_high_n;
} brace_can_interval_0_t;
#define BRACE_CAN_INTERVAL_0_FORCE_X_LOW_N_MOST 8388.607f
#define BRACE_CAN_INTERVAL_0_FORCE_X_HIGH_N_MOST 8388.607f
uint32_t brace_can_pack_interval_0(const brace_can_interval_0_t *message, uint8_t data[8]);
void brace_can_unpack_interval_0(const uint8_t data[8], brace_can_interval_0_t *message);

/* where the force on the tip and the loads of the joints lie with 90 %, of the same snapshot as load: friction in
 * the gears and the doubt of the torque by current are counted: frame 2 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low end of the interval in which the force of the ground on the tip along z lies with 90 % [N, -8388.61
     * to 8388.61] */
    float force_z_low_n;
    /* the high end of the interval in which the force of the ground on the tip along z lies with 90 % [N, -8388.61
     * to 8388.61] */
    float force_z_high_n;
} brace_can_interval_1_t;
#define BRACE_CAN_INTERVAL_1_FORCE_Z_LOW_N_MOST 8388.607f
#define BRACE_CAN_INTERVAL_1_FORCE_Z_HIGH_N_MOST 8388.607f
uint32_t brace_can_pack_interval_1(const brace_can_interval_1_t *message, uint8_t data[8]);
void brace_can_unpack_interval_1(const uint8_t data[8], brace_can_interval_1_t *message);

/* where the force on the tip and the loads of the joints lie with 90 %, of the same snapshot as load: friction in
 * the gears and the doubt of the torque by current are counted: frame 3 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low end of the interval in which the load behind the femur joint's gear lies with 90 % [N mm,
     * -1.67772e+06 to 1.67772e+06] */
    float load_femur_low_n_mm;
    /* the high end of the interval in which the load behind the femur joint's gear lies with 90 % [N mm,
     * -1.67772e+06 to 1.67772e+06] */
    float load_femur_high_n_mm;
} brace_can_interval_2_t;
#define BRACE_CAN_INTERVAL_2_LOAD_FEMUR_LOW_N_MM_MOST 1677721.4f
#define BRACE_CAN_INTERVAL_2_LOAD_FEMUR_HIGH_N_MM_MOST 1677721.4f
uint32_t brace_can_pack_interval_2(const brace_can_interval_2_t *message, uint8_t data[8]);
void brace_can_unpack_interval_2(const uint8_t data[8], brace_can_interval_2_t *message);

/* where the force on the tip and the loads of the joints lie with 90 %, of the same snapshot as load: friction in
 * the gears and the doubt of the torque by current are counted: frame 4 of 4 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low end of the interval in which the load behind the tibia joint's gear lies with 90 % [N mm,
     * -1.67772e+06 to 1.67772e+06] */
    float load_tibia_low_n_mm;
    /* the high end of the interval in which the load behind the tibia joint's gear lies with 90 % [N mm,
     * -1.67772e+06 to 1.67772e+06] */
    float load_tibia_high_n_mm;
} brace_can_interval_3_t;
#define BRACE_CAN_INTERVAL_3_LOAD_TIBIA_LOW_N_MM_MOST 1677721.4f
#define BRACE_CAN_INTERVAL_3_LOAD_TIBIA_HIGH_N_MM_MOST 1677721.4f
uint32_t brace_can_pack_interval_3(const brace_can_interval_3_t *message, uint8_t data[8]);
void brace_can_unpack_interval_3(const uint8_t data[8], brace_can_interval_3_t *message);

/* the same across the limb's plane; only a limb whose coxa joint is fitted sends it: frame 1 of 2 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low end of the interval in which the force of the ground on the tip across the limb's plane, to the left
     * lies with 90 % [N, -8388.61 to 8388.61] */
    float force_y_low_n;
    /* the high end of the interval in which the force of the ground on the tip across the limb's plane, to the
     * left lies with 90 % [N, -8388.61 to 8388.61] */
    float force_y_high_n;
} brace_can_interval_across_0_t;
#define BRACE_CAN_INTERVAL_ACROSS_0_FORCE_Y_LOW_N_MOST 8388.607f
#define BRACE_CAN_INTERVAL_ACROSS_0_FORCE_Y_HIGH_N_MOST 8388.607f
uint32_t brace_can_pack_interval_across_0(const brace_can_interval_across_0_t *message, uint8_t data[8]);
void brace_can_unpack_interval_across_0(const uint8_t data[8], brace_can_interval_across_0_t *message);

/* the same across the limb's plane; only a limb whose coxa joint is fitted sends it: frame 2 of 2 */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low end of the interval in which the load behind the coxa joint's gear lies with 90 % [N mm,
     * -1.67772e+06 to 1.67772e+06] */
    float load_coxa_low_n_mm;
    /* the high end of the interval in which the load behind the coxa joint's gear lies with 90 % [N mm,
     * -1.67772e+06 to 1.67772e+06] */
    float load_coxa_high_n_mm;
} brace_can_interval_across_1_t;
#define BRACE_CAN_INTERVAL_ACROSS_1_LOAD_COXA_LOW_N_MM_MOST 1677721.4f
#define BRACE_CAN_INTERVAL_ACROSS_1_LOAD_COXA_HIGH_N_MM_MOST 1677721.4f
uint32_t brace_can_pack_interval_across_1(const brace_can_interval_across_1_t *message, uint8_t data[8]);
void brace_can_unpack_interval_across_1(const uint8_t data[8], brace_can_interval_across_1_t *message);

/* a whole snapshot, in place of stiffness_a, stiffness_b, eigenvalues and posture, where
 * controller.can_fd_bit_rate is set and the bus can do it */
typedef struct {
    /* the number of the snapshot */
    uint32_t sequence;
    /* the low half of the CRC of the parameters in force */
    uint32_t parameter_tag;
    /* the age of the joints' samples when the frame was made; 32767 ms stands for 32767 ms and more [ms, 0 to
     * 32767] */
    float age_ms;
    /* the quality of K */
    uint32_t flags;
    /* what the controller is doing */
    uint32_t mode;
    /* which side of the femur joint's backlash is loaded */
    uint32_t play_femur;
    /* which side of the tibia joint's backlash is loaded */
    uint32_t play_tibia;
    /* the faults that are there now */
    uint32_t faults;
    /* the force along x per displacement along x */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse */
    float k_xz_n_per_mm;
    /* the force along z per displacement along z */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K */
    float lambda_min_n_per_mm;
    /* the larger eigenvalue of K */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x */
    float stiff_axis_rad;
    /* the true angle of the femur, measured from +x */
    float theta1_rad;
    /* the true flexion of the knee */
    float theta2_rad;
    /* how far the tip lies outwards from the femur axis */
    float tip_x_mm;
    /* how far the tip lies above the femur axis */
    float tip_z_mm;
    /* the force of the ground on the tip along x */
    float force_x_n;
    /* the force of the ground on the tip along z */
    float force_z_n;
} brace_can_snapshot_fd_t;
#define BRACE_CAN_SNAPSHOT_FD_AGE_MS_MOST 32767.0f
uint32_t brace_can_pack_snapshot_fd(const brace_can_snapshot_fd_t *message, uint8_t data[64]);
void brace_can_unpack_snapshot_fd(const uint8_t data[64], brace_can_snapshot_fd_t *message);

/* K in space of the same snapshot as snapshot_fd, in the robot's base frame; in place of space, sent only by a
 * limb whose coxa joint is fitted */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the age of the joints' samples when the frame was made; 32767 ms stands for 32767 ms and more [ms, 0 to
     * 32767] */
    float age_ms;
    /* the quality of K in space */
    uint32_t flags;
    /* the low half of the CRC of the parameters in force */
    uint32_t parameter_tag;
    /* what the controller is doing */
    uint32_t mode;
    /* which side of the coxa joint's backlash is loaded */
    uint32_t play_coxa;
    /* the x component of the unit vector along which K in space is largest [, -1.63835 to 1.63835] */
    float stiff_axis_x;
    /* the y component of the unit vector along which K in space is largest [, -1.63835 to 1.63835] */
    float stiff_axis_y;
    /* the z component of the unit vector along which K in space is largest [, -1.63835 to 1.63835] */
    float stiff_axis_z;
    /* the true angle of the coxa joint */
    float theta0_rad;
    /* the force across the limb's plane per displacement across it */
    float k_across_n_per_mm;
    /* the force along x per displacement along x */
    float k_xx_n_per_mm;
    /* the force along x per displacement along y, and the reverse */
    float k_xy_n_per_mm;
    /* the force along x per displacement along z, and the reverse */
    float k_xz_n_per_mm;
    /* the force along y per displacement along y */
    float k_yy_n_per_mm;
    /* the force along y per displacement along z, and the reverse */
    float k_yz_n_per_mm;
    /* the force along z per displacement along z */
    float k_zz_n_per_mm;
    /* the smallest eigenvalue of K in space */
    float lambda_1_n_per_mm;
    /* the middle eigenvalue of K in space */
    float lambda_2_n_per_mm;
    /* the largest eigenvalue of K in space */
    float lambda_3_n_per_mm;
} brace_can_space_fd_t;
#define BRACE_CAN_SPACE_FD_AGE_MS_MOST 32767.0f
#define BRACE_CAN_SPACE_FD_STIFF_AXIS_X_MOST 1.63835f
#define BRACE_CAN_SPACE_FD_STIFF_AXIS_Y_MOST 1.63835f
#define BRACE_CAN_SPACE_FD_STIFF_AXIS_Z_MOST 1.63835f
uint32_t brace_can_pack_space_fd(const brace_can_space_fd_t *message, uint8_t data[64]);
void brace_can_unpack_space_fd(const uint8_t data[64], brace_can_space_fd_t *message);

/* the load that K counts and what it does to the limb, and K without it, of one snapshot; in place of load */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the age of the joints' samples when the frame was made; 32767 ms stands for 32767 ms and more [ms, 0 to
     * 32767] */
    float age_ms;
    /* the quality of K */
    uint32_t flags;
    /* the low half of the CRC of the parameters in force */
    uint32_t parameter_tag;
    /* k_xx with neither the force on the tip nor the weight counted, every gap closed */
    float unloaded_k_xx_n_per_mm;
    /* k_xz with neither the force on the tip nor the weight counted, every gap closed */
    float unloaded_k_xz_n_per_mm;
    /* k_zz with neither the force on the tip nor the weight counted, every gap closed */
    float unloaded_k_zz_n_per_mm;
    /* the force of the ground on the tip along x that K counts; not known where no load is counted */
    float counted_force_x_n;
    /* the force of the ground on the tip along z that K counts; not known where no load is counted */
    float counted_force_z_n;
    /* how far force and weight have moved the tip along x */
    float moved_x_mm;
    /* how far force and weight have moved the tip along z */
    float moved_z_mm;
    /* the multiple of the load at which the limb, held as it stands, would have no stiffness left; infinity where
     * there is none */
    float buckling_factor;
    /* the direction in which the weight pulls, in the limb's plane, from +x */
    float gravity_direction_rad;
    /* how far that direction leans out of the limb's plane */
    float gravity_lean_rad;
    /* the force of the ground on the tip that K counts across the limb's plane, to the left; not known of a limb
     * without a coxa joint, and where no load is counted */
    float counted_force_y_n;
    /* how far force and weight have moved the tip across the limb's plane, to the left */
    float moved_y_mm;
    /* K across the limb's plane with neither the force on the tip nor the weight counted, every gap closed */
    float unloaded_k_across_n_per_mm;
} brace_can_load_fd_t;
#define BRACE_CAN_LOAD_FD_AGE_MS_MOST 32767.0f
uint32_t brace_can_pack_load_fd(const brace_can_load_fd_t *message, uint8_t data[64]);
void brace_can_unpack_load_fd(const uint8_t data[64], brace_can_load_fd_t *message);

/* one sigma of K of the same snapshot as snapshot_fd; in place of sigma and sigma_space */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* one sigma of stiff_axis [rad, 0 to 6.5534] */
    float stiff_axis_rad;
    /* one sigma of k_xx */
    float k_xx_n_per_mm;
    /* one sigma of k_xz */
    float k_xz_n_per_mm;
    /* one sigma of k_zz */
    float k_zz_n_per_mm;
    /* one sigma of lambda_min */
    float lambda_min_n_per_mm;
    /* one sigma of lambda_max */
    float lambda_max_n_per_mm;
    /* one sigma of k_xx in space; not known of a limb without a coxa joint */
    float space_k_xx_n_per_mm;
    /* one sigma of k_xy in space; not known of a limb without a coxa joint */
    float space_k_xy_n_per_mm;
    /* one sigma of k_xz in space; not known of a limb without a coxa joint */
    float space_k_xz_n_per_mm;
    /* one sigma of k_yy in space; not known of a limb without a coxa joint */
    float space_k_yy_n_per_mm;
    /* one sigma of k_yz in space; not known of a limb without a coxa joint */
    float space_k_yz_n_per_mm;
    /* one sigma of k_zz in space; not known of a limb without a coxa joint */
    float space_k_zz_n_per_mm;
    /* one sigma of lambda_1 in space */
    float space_lambda_1_n_per_mm;
    /* one sigma of lambda_2 in space */
    float space_lambda_2_n_per_mm;
    /* one sigma of lambda_3 in space */
    float space_lambda_3_n_per_mm;
    /* one sigma of k_across */
    float k_across_n_per_mm;
} brace_can_sigma_fd_t;
#define BRACE_CAN_SIGMA_FD_STIFF_AXIS_RAD_MOST 6.5534f
uint32_t brace_can_pack_sigma_fd(const brace_can_sigma_fd_t *message, uint8_t data[64]);
void brace_can_unpack_sigma_fd(const uint8_t data[64], brace_can_sigma_fd_t *message);

/* where the force on the tip and the loads of the joints lie with 90 %, of the same snapshot as snapshot_fd; in
 * place of interval and interval_across */
typedef struct {
    /* the number of the snapshot; the frames of one snapshot carry the same number */
    uint32_t sequence;
    /* the low half of the CRC of the parameters in force */
    uint32_t parameter_tag;
    /* the low end of the interval in which the force of the ground on the tip along x lies with 90 % */
    float force_x_low_n;
    /* the high end of the interval in which the force of the ground on the tip along x lies with 90 % */
    float force_x_high_n;
    /* the low end of the interval in which the force of the ground on the tip along z lies with 90 % */
    float force_z_low_n;
    /* the high end of the interval in which the force of the ground on the tip along z lies with 90 % */
    float force_z_high_n;
    /* the low end of the interval in which the load behind the femur joint's gear lies with 90 % */
    float load_femur_low_n_mm;
    /* the high end of the interval in which the load behind the femur joint's gear lies with 90 % */
    float load_femur_high_n_mm;
    /* the low end of the interval in which the load behind the tibia joint's gear lies with 90 % */
    float load_tibia_low_n_mm;
    /* the high end of the interval in which the load behind the tibia joint's gear lies with 90 % */
    float load_tibia_high_n_mm;
    /* the low end of the interval in which the force of the ground on the tip across the limb's plane, to the left
     * lies with 90 % */
    float force_y_low_n;
    /* the high end of the interval in which the force of the ground on the tip across the limb's plane, to the
     * left lies with 90 % */
    float force_y_high_n;
    /* the low end of the interval in which the load behind the coxa joint's gear lies with 90 % */
    float load_coxa_low_n_mm;
    /* the high end of the interval in which the load behind the coxa joint's gear lies with 90 % */
    float load_coxa_high_n_mm;
} brace_can_interval_fd_t;
uint32_t brace_can_pack_interval_fd(const brace_can_interval_fd_t *message, uint8_t data[64]);
void brace_can_unpack_interval_fd(const uint8_t data[64], brace_can_interval_fd_t *message);

typedef struct {
    uint32_t token;
    /* the number of the entry */
    uint32_t index;
} brace_can_read_entry_request_t;
uint32_t brace_can_pack_read_entry_request(const brace_can_read_entry_request_t *message, uint8_t data[8]);
void brace_can_unpack_read_entry_request(const uint8_t data[8], brace_can_read_entry_request_t *message);

typedef struct {
    uint32_t token;
    /* the number of the entry, as asked */
    uint32_t index;
    /* the 32 bits of a float or a whole number, as the entry's type says */
    uint32_t value;
} brace_can_read_entry_answer_0_t;
uint32_t brace_can_pack_read_entry_answer_0(const brace_can_read_entry_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_read_entry_answer_0(const uint8_t data[8], brace_can_read_entry_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the number of the entry */
    uint32_t index;
    /* the 32 bits of a float or a whole number, as the entry's type says */
    uint32_t value;
} brace_can_write_entry_request_t;
uint32_t brace_can_pack_write_entry_request(const brace_can_write_entry_request_t *message, uint8_t data[8]);
void brace_can_unpack_write_entry_request(const uint8_t data[8], brace_can_write_entry_request_t *message);

typedef struct {
    uint32_t token;
    /* the number of the entry, as asked */
    uint32_t index;
    /* the value that is staged now */
    uint32_t value;
} brace_can_write_entry_answer_0_t;
uint32_t brace_can_pack_write_entry_answer_0(const brace_can_write_entry_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_write_entry_answer_0(const uint8_t data[8], brace_can_write_entry_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the true angle of the femur, measured from +x [rad, -8.38861 to 8.38861] */
    float theta1_rad;
    /* the true flexion of the knee [rad, -8.38861 to 8.38861] */
    float theta2_rad;
} brace_can_k_at_posture_request_t;
uint32_t brace_can_pack_k_at_posture_request(const brace_can_k_at_posture_request_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_request(const uint8_t data[8], brace_can_k_at_posture_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
} brace_can_k_at_posture_answer_0_t;
uint32_t brace_can_pack_k_at_posture_answer_0(const brace_can_k_at_posture_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_0(const uint8_t data[8], brace_can_k_at_posture_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_min_n_per_mm;
} brace_can_k_at_posture_answer_1_t;
uint32_t brace_can_pack_k_at_posture_answer_1(const brace_can_k_at_posture_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_1(const uint8_t data[8], brace_can_k_at_posture_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_k_at_posture_answer_2_t;
uint32_t brace_can_pack_k_at_posture_answer_2(const brace_can_k_at_posture_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_2(const uint8_t data[8], brace_can_k_at_posture_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* the quality of K */
    uint32_t flags;
} brace_can_k_at_posture_answer_3_t;
uint32_t brace_can_pack_k_at_posture_answer_3(const brace_can_k_at_posture_answer_3_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_posture_answer_3(const uint8_t data[8], brace_can_k_at_posture_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* how far the tip lies outwards from the femur axis [mm, -8388.61 to 8388.61] */
    float x_mm;
    /* how far the tip lies above the femur axis [mm, -8388.61 to 8388.61] */
    float z_mm;
} brace_can_k_at_tip_knee_up_request_t;
uint32_t brace_can_pack_k_at_tip_knee_up_request(const brace_can_k_at_tip_knee_up_request_t *message, uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_request(const uint8_t data[8], brace_can_k_at_tip_knee_up_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
} brace_can_k_at_tip_knee_up_answer_0_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_0(const brace_can_k_at_tip_knee_up_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_0(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_min_n_per_mm;
} brace_can_k_at_tip_knee_up_answer_1_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_1(const brace_can_k_at_tip_knee_up_answer_1_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_1(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_k_at_tip_knee_up_answer_2_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_2(const brace_can_k_at_tip_knee_up_answer_2_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_2(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* the quality of K */
    uint32_t flags;
} brace_can_k_at_tip_knee_up_answer_3_t;
uint32_t brace_can_pack_k_at_tip_knee_up_answer_3(const brace_can_k_at_tip_knee_up_answer_3_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_up_answer_3(const uint8_t data[8], brace_can_k_at_tip_knee_up_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* how far the tip lies outwards from the femur axis [mm, -8388.61 to 8388.61] */
    float x_mm;
    /* how far the tip lies above the femur axis [mm, -8388.61 to 8388.61] */
    float z_mm;
} brace_can_k_at_tip_knee_down_request_t;
uint32_t brace_can_pack_k_at_tip_knee_down_request(const brace_can_k_at_tip_knee_down_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_request(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
} brace_can_k_at_tip_knee_down_answer_0_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_0(const brace_can_k_at_tip_knee_down_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_0(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_min_n_per_mm;
} brace_can_k_at_tip_knee_down_answer_1_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_1(const brace_can_k_at_tip_knee_down_answer_1_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_1(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_k_at_tip_knee_down_answer_2_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_2(const brace_can_k_at_tip_knee_down_answer_2_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_2(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* the quality of K */
    uint32_t flags;
} brace_can_k_at_tip_knee_down_answer_3_t;
uint32_t brace_can_pack_k_at_tip_knee_down_answer_3(const brace_can_k_at_tip_knee_down_answer_3_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_at_tip_knee_down_answer_3(const uint8_t data[8],
    brace_can_k_at_tip_knee_down_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* the displacement of the tip along x [mm, -838.861 to 838.861] */
    float dx_mm;
    /* the displacement of the tip along z [mm, -838.861 to 838.861] */
    float dz_mm;
} brace_can_contact_force_request_t;
uint32_t brace_can_pack_contact_force_request(const brace_can_contact_force_request_t *message, uint8_t data[8]);
void brace_can_unpack_contact_force_request(const uint8_t data[8], brace_can_contact_force_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x [N, -8388.61 to 8388.61] */
    float fx_n;
    /* the force along z [N, -8388.61 to 8388.61] */
    float fz_n;
} brace_can_contact_force_answer_0_t;
uint32_t brace_can_pack_contact_force_answer_0(const brace_can_contact_force_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_contact_force_answer_0(const uint8_t data[8], brace_can_contact_force_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the least force that any displacement of this size gives [N, 0 to 16777.2] */
    float low_n;
    /* the greatest force that any displacement of this size gives [N, 0 to 16777.2] */
    float high_n;
} brace_can_contact_force_answer_1_t;
uint32_t brace_can_pack_contact_force_answer_1(const brace_can_contact_force_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_contact_force_answer_1(const uint8_t data[8], brace_can_contact_force_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the force along x [N, -8388.61 to 8388.61] */
    float fx_n;
    /* the force along z [N, -8388.61 to 8388.61] */
    float fz_n;
} brace_can_sag_for_load_request_t;
uint32_t brace_can_pack_sag_for_load_request(const brace_can_sag_for_load_request_t *message, uint8_t data[8]);
void brace_can_unpack_sag_for_load_request(const uint8_t data[8], brace_can_sag_for_load_request_t *message);

typedef struct {
    uint32_t token;
    /* the displacement along x [mm, -838.861 to 838.861] */
    float dx_mm;
    /* the displacement along z [mm, -838.861 to 838.861] */
    float dz_mm;
} brace_can_sag_for_load_answer_0_t;
uint32_t brace_can_pack_sag_for_load_answer_0(const brace_can_sag_for_load_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_sag_for_load_answer_0(const uint8_t data[8], brace_can_sag_for_load_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the direction of the surface's normal towards the limb, measured from +x [rad, -3.2767 to 3.2767] */
    float normal_rad;
    /* the friction coefficient, at most 10 [1, 0 to 65.534] */
    float friction_ratio;
} brace_can_friction_margin_request_t;
uint32_t brace_can_pack_friction_margin_request(const brace_can_friction_margin_request_t *message, uint8_t data[8]);
void brace_can_unpack_friction_margin_request(const uint8_t data[8], brace_can_friction_margin_request_t *message);

typedef struct {
    uint32_t token;
    /* the force that may be added along the surface before the foot slides [N, -8388.61 to 8388.61] */
    float margin_n;
    /* the angle from the force to the edge of the friction cone [rad, -3.2767 to 3.2767] */
    float angle_left_rad;
    /* what the foot does on that surface */
    uint32_t contact;
} brace_can_friction_margin_answer_0_t;
uint32_t brace_can_pack_friction_margin_answer_0(const brace_can_friction_margin_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_friction_margin_answer_0(const uint8_t data[8], brace_can_friction_margin_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the mode that is wanted: CONFIGURATION or MONITOR */
    uint32_t mode;
    /* 0xc0de, so that no stray frame changes the mode */
    uint32_t key;
} brace_can_set_mode_request_t;
uint32_t brace_can_pack_set_mode_request(const brace_can_set_mode_request_t *message, uint8_t data[8]);
void brace_can_unpack_set_mode_request(const uint8_t data[8], brace_can_set_mode_request_t *message);

typedef struct {
    uint32_t token;
    /* the controller's mode now; on the way back to MONITOR it is START until there are samples */
    uint32_t mode;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_set_mode_answer_0_t;
uint32_t brace_can_pack_set_mode_answer_0(const brace_can_set_mode_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_set_mode_answer_0(const uint8_t data[8], brace_can_set_mode_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* how many bytes the block has */
    uint32_t bytes;
    /* the CRC-32 that ends the block */
    uint32_t crc;
} brace_can_upload_begin_request_t;
uint32_t brace_can_pack_upload_begin_request(const brace_can_upload_begin_request_t *message, uint8_t data[8]);
void brace_can_unpack_upload_begin_request(const uint8_t data[8], brace_can_upload_begin_request_t *message);

typedef struct {
    uint32_t token;
    /* how many words the controller expects */
    uint32_t words;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_upload_begin_answer_0_t;
uint32_t brace_can_pack_upload_begin_answer_0(const brace_can_upload_begin_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_upload_begin_answer_0(const uint8_t data[8], brace_can_upload_begin_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the number of the 4-byte word of the block, from 0 */
    uint32_t word;
    /* the word's bytes, the first byte lowest */
    uint32_t data;
} brace_can_upload_word_request_t;
uint32_t brace_can_pack_upload_word_request(const brace_can_upload_word_request_t *message, uint8_t data[8]);
void brace_can_unpack_upload_word_request(const uint8_t data[8], brace_can_upload_word_request_t *message);

typedef struct {
    uint32_t token;
    /* the number of the 4-byte word of the block, from 0 */
    uint32_t word;
    /* the word's bytes, the first byte lowest */
    uint32_t data;
} brace_can_upload_word_answer_0_t;
uint32_t brace_can_pack_upload_word_answer_0(const brace_can_upload_word_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_upload_word_answer_0(const uint8_t data[8], brace_can_upload_word_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the CRC of the block uploaded, or of the whole set where entries are staged; 0 for staged entries, on a
     * bench only */
    uint32_t crc;
} brace_can_commit_request_t;
uint32_t brace_can_pack_commit_request(const brace_can_commit_request_t *message, uint8_t data[8]);
void brace_can_unpack_commit_request(const uint8_t data[8], brace_can_commit_request_t *message);

typedef struct {
    uint32_t token;
    /* the sequence number of the set now in force */
    uint32_t sequence;
} brace_can_commit_answer_0_t;
uint32_t brace_can_pack_commit_answer_0(const brace_can_commit_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_commit_answer_0(const uint8_t data[8], brace_can_commit_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the CRC of the set now in force */
    uint32_t crc;
    /* who may move the limb and write to this controller */
    uint32_t setting;
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
    /* the sequence number of the set now in force */
    uint32_t sequence;
} brace_can_rollback_answer_0_t;
uint32_t brace_can_pack_rollback_answer_0(const brace_can_rollback_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_rollback_answer_0(const uint8_t data[8], brace_can_rollback_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the CRC of the set now in force */
    uint32_t crc;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_rollback_answer_1_t;
uint32_t brace_can_pack_rollback_answer_1(const brace_can_rollback_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_rollback_answer_1(const uint8_t data[8], brace_can_rollback_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the number of the 4-byte word of the block, from 0 */
    uint32_t word;
} brace_can_download_word_request_t;
uint32_t brace_can_pack_download_word_request(const brace_can_download_word_request_t *message, uint8_t data[8]);
void brace_can_unpack_download_word_request(const uint8_t data[8], brace_can_download_word_request_t *message);

typedef struct {
    uint32_t token;
    /* the number of the 4-byte word of the block, from 0 */
    uint32_t word;
    /* the word's bytes, the first byte lowest; of word 65535 the low half counts the block's bytes, and the high
     * half says where the set comes from (0 DEFAULT, 1 SLOT_A, 2 SLOT_B) */
    uint32_t data;
} brace_can_download_word_answer_0_t;
uint32_t brace_can_pack_download_word_answer_0(const brace_can_download_word_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_download_word_answer_0(const uint8_t data[8], brace_can_download_word_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the joint: 0 coxa, 1 femur, 2 tibia */
    uint32_t joint;
    /* the side of the play that shall be loaded: +1 or -1 */
    int32_t flank;
} brace_can_take_up_request_t;
uint32_t brace_can_pack_take_up_request(const brace_can_take_up_request_t *message, uint8_t data[8]);
void brace_can_unpack_take_up_request(const uint8_t data[8], brace_can_take_up_request_t *message);

typedef struct {
    uint32_t token;
    /* where the joint's take-up stood when this was asked */
    uint32_t phase;
    /* who may move the limb and write to this controller */
    uint32_t setting;
    /* the motion begins when the owner's sign of life carries this number back */
    uint32_t begin;
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
    /* the controller's mode now */
    uint32_t mode;
    /* who may move the limb and write to this controller */
    uint32_t setting;
    /* the motion begins when the owner's sign of life carries this number back */
    uint32_t begin;
} brace_can_let_go_answer_0_t;
uint32_t brace_can_pack_let_go_answer_0(const brace_can_let_go_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_let_go_answer_0(const uint8_t data[8], brace_can_let_go_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the axis: 0 x, 1 z */
    uint32_t axis;
    /* how many steps the test takes to each side, 2 to 60 */
    uint32_t steps_per_side;
    /* how far the tip moves in one step, 0.001 to 50 mm [mm, 0 to 65.534] */
    float step_mm;
    /* how long the test stands at each step, 20 to 10000 ms */
    uint32_t dwell_ms;
} brace_can_loading_test_start_request_t;
uint32_t brace_can_pack_loading_test_start_request(const brace_can_loading_test_start_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_loading_test_start_request(const uint8_t data[8],
    brace_can_loading_test_start_request_t *message);

typedef struct {
    uint32_t token;
    /* how many rows the test will record */
    uint32_t rows;
    /* who may move the limb and write to this controller */
    uint32_t setting;
    /* the motion begins when the owner's sign of life carries this number back */
    uint32_t begin;
} brace_can_loading_test_start_answer_0_t;
uint32_t brace_can_pack_loading_test_start_answer_0(const brace_can_loading_test_start_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_loading_test_start_answer_0(const uint8_t data[8],
    brace_can_loading_test_start_answer_0_t *message);

typedef struct {
    uint32_t token;
} brace_can_loading_test_stop_request_t;
uint32_t brace_can_pack_loading_test_stop_request(const brace_can_loading_test_stop_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_loading_test_stop_request(const uint8_t data[8], brace_can_loading_test_stop_request_t *message);

typedef struct {
    uint32_t token;
    /* how many rows there are now */
    uint32_t rows;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_loading_test_stop_answer_0_t;
uint32_t brace_can_pack_loading_test_stop_answer_0(const brace_can_loading_test_stop_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_loading_test_stop_answer_0(const uint8_t data[8],
    brace_can_loading_test_stop_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the row; 0 is the oldest */
    uint32_t row;
    /* the column: 0 run, 1 config, 2 theta1_rad, 3 theta2_rad, 4 axis (0 x, 1 z), 5 rep, 6 step, 7 t_s, 8
     * temp_degc, 9 dx_mm, 10 dz_mm, 11 fx_n, 12 fz_n, 13 enc1_rad, 14 enc2_rad; docs/datasets.md says what they
     * are */
    uint32_t column;
} brace_can_fetch_row_request_t;
uint32_t brace_can_pack_fetch_row_request(const brace_can_fetch_row_request_t *message, uint8_t data[8]);
void brace_can_unpack_fetch_row_request(const uint8_t data[8], brace_can_fetch_row_request_t *message);

typedef struct {
    uint32_t token;
    /* the row, as asked */
    uint32_t row;
    /* the column, as asked */
    uint32_t column;
    /* the number asked for */
    float value;
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
    /* the first number of the firmware's version */
    uint32_t major;
    /* the second number of the firmware's version */
    uint32_t minor;
    /* the third number of the firmware's version */
    uint32_t patch;
    /* the version of these frames */
    uint32_t protocol;
    /* the node's number on the bus */
    uint32_t node;
} brace_can_identify_answer_0_t;
uint32_t brace_can_pack_identify_answer_0(const brace_can_identify_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_0(const uint8_t data[8], brace_can_identify_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* a checksum over names, places, types and units of everything on the wire; two ends whose hashes differ
     * cannot understand each other */
    uint32_t dictionary_hash;
} brace_can_identify_answer_1_t;
uint32_t brace_can_pack_identify_answer_1(const brace_can_identify_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_1(const uint8_t data[8], brace_can_identify_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* a checksum over the parameter block's list of members */
    uint32_t schema_hash;
} brace_can_identify_answer_2_t;
uint32_t brace_can_pack_identify_answer_2(const brace_can_identify_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_2(const uint8_t data[8], brace_can_identify_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* the CRC of the parameter set in force */
    uint32_t parameter_crc;
    /* where that set comes from */
    uint32_t origin;
} brace_can_identify_answer_3_t;
uint32_t brace_can_pack_identify_answer_3(const brace_can_identify_answer_3_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_3(const uint8_t data[8], brace_can_identify_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* the faults that are there now */
    uint32_t faults;
    /* what the controller is doing */
    uint32_t mode;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_identify_answer_4_t;
uint32_t brace_can_pack_identify_answer_4(const brace_can_identify_answer_4_t *message, uint8_t data[8]);
void brace_can_unpack_identify_answer_4(const uint8_t data[8], brace_can_identify_answer_4_t *message);

typedef struct {
    uint32_t token;
    /* the number: 0 loading_outcome, 1 loading_rows, and so on in the order of the entries below */
    uint32_t item;
} brace_can_loading_test_result_request_t;
uint32_t brace_can_pack_loading_test_result_request(const brace_can_loading_test_result_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_loading_test_result_request(const uint8_t data[8],
    brace_can_loading_test_result_request_t *message);

typedef struct {
    uint32_t token;
    /* the number's place, as asked */
    uint32_t item;
    /* how the test went */
    int32_t outcome;
    /* the number asked for */
    float value;
} brace_can_loading_test_result_answer_0_t;
uint32_t brace_can_pack_loading_test_result_answer_0(const brace_can_loading_test_result_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_loading_test_result_answer_0(const uint8_t data[8],
    brace_can_loading_test_result_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the bits of the faults to clear */
    uint32_t faults;
} brace_can_clear_request_t;
uint32_t brace_can_pack_clear_request(const brace_can_clear_request_t *message, uint8_t data[8]);
void brace_can_unpack_clear_request(const uint8_t data[8], brace_can_clear_request_t *message);

typedef struct {
    uint32_t token;
    /* the faults that are there now */
    uint32_t faults;
    /* who may move the limb and write to this controller */
    uint32_t setting;
} brace_can_clear_answer_0_t;
uint32_t brace_can_pack_clear_answer_0(const brace_can_clear_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_clear_answer_0(const uint8_t data[8], brace_can_clear_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the true angle of the coxa joint, before the load turns the joint [rad, -3.2767 to 3.2767] */
    float theta0_rad;
    /* the true angle of the femur, measured from +x, before the load turns the joint [rad, -3.2767 to 3.2767] */
    float theta1_rad;
    /* the true flexion of the knee, before the load turns the joint [rad, -3.2767 to 3.2767] */
    float theta2_rad;
} brace_can_k_in_space_at_posture_request_t;
uint32_t brace_can_pack_k_in_space_at_posture_request(const brace_can_k_in_space_at_posture_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_request(const uint8_t data[8],
    brace_can_k_in_space_at_posture_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along y, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xy_n_per_mm;
} brace_can_k_in_space_at_posture_answer_0_t;
uint32_t brace_can_pack_k_in_space_at_posture_answer_0(const brace_can_k_in_space_at_posture_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_answer_0(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
    /* the force along y per displacement along y [N/mm, -4194.3 to 4194.3] */
    float k_yy_n_per_mm;
} brace_can_k_in_space_at_posture_answer_1_t;
uint32_t brace_can_pack_k_in_space_at_posture_answer_1(const brace_can_k_in_space_at_posture_answer_1_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_answer_1(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the force along y per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_yz_n_per_mm;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
} brace_can_k_in_space_at_posture_answer_2_t;
uint32_t brace_can_pack_k_in_space_at_posture_answer_2(const brace_can_k_in_space_at_posture_answer_2_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_answer_2(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* the smallest eigenvalue of K in space [N/mm, 0 to 8388.61] */
    float lambda_1_n_per_mm;
    /* the middle eigenvalue of K in space [N/mm, 0 to 8388.61] */
    float lambda_2_n_per_mm;
} brace_can_k_in_space_at_posture_answer_3_t;
uint32_t brace_can_pack_k_in_space_at_posture_answer_3(const brace_can_k_in_space_at_posture_answer_3_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_answer_3(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* the largest eigenvalue of K in space [N/mm, 0 to 8388.61] */
    float lambda_3_n_per_mm;
    /* the quality of that K */
    uint32_t flags;
    /* 1 where a tip_force_in_space came before, else 0 */
    uint32_t force_is_told;
} brace_can_k_in_space_at_posture_answer_4_t;
uint32_t brace_can_pack_k_in_space_at_posture_answer_4(const brace_can_k_in_space_at_posture_answer_4_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_answer_4(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_4_t *message);

typedef struct {
    uint32_t token;
    /* how far force and weight move the tip outwards in the limb's plane [mm, -327.67 to 327.67] */
    float dx_mm;
    /* how far force and weight move the tip across that plane, to the left [mm, -327.67 to 327.67] */
    float dy_mm;
    /* how far force and weight move the tip upwards in that plane [mm, -327.67 to 327.67] */
    float dz_mm;
} brace_can_k_in_space_at_posture_answer_5_t;
uint32_t brace_can_pack_k_in_space_at_posture_answer_5(const brace_can_k_in_space_at_posture_answer_5_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_in_space_at_posture_answer_5(const uint8_t data[8],
    brace_can_k_in_space_at_posture_answer_5_t *message);

typedef struct {
    uint32_t token;
} brace_can_drift_request_t;
uint32_t brace_can_pack_drift_request(const brace_can_drift_request_t *message, uint8_t data[8]);
void brace_can_unpack_drift_request(const uint8_t data[8], brace_can_drift_request_t *message);

typedef struct {
    uint32_t token;
    /* what the check is doing */
    uint32_t state;
    /* the likeliest cause of a change */
    uint32_t cause;
    /* every cause that is nearly as likely */
    uint32_t could_be;
    /* what to do next about a drift */
    uint32_t next_step;
    /* the log likelihood ratio of the likeliest cause against no change; the alarm is at 20 [, 0 to 16777.2] */
    float evidence;
} brace_can_drift_answer_0_t;
uint32_t brace_can_pack_drift_answer_0(const brace_can_drift_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_drift_answer_0(const uint8_t data[8], brace_can_drift_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the share of its stiffness that the likeliest cause has lost; it is negative where that part has become
     * stiffer [1, -83.8861 to 83.8861] */
    float loss_ratio;
    /* one sigma of that loss [1, 0 to 167.772] */
    float loss_sigma_ratio;
} brace_can_drift_answer_1_t;
uint32_t brace_can_pack_drift_answer_1(const brace_can_drift_answer_1_t *message, uint8_t data[8]);
void brace_can_unpack_drift_answer_1(const uint8_t data[8], brace_can_drift_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* how many readings of loading tests came since the likeliest change began; 65535 means as many or more */
    uint32_t since_readings;
    /* how many readings of loading tests the check has taken in since it began to learn */
    uint32_t readings;
} brace_can_drift_answer_2_t;
uint32_t brace_can_pack_drift_answer_2(const brace_can_drift_answer_2_t *message, uint8_t data[8]);
void brace_can_unpack_drift_answer_2(const uint8_t data[8], brace_can_drift_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* the joint: 0 coxa, 1 femur, 2 tibia */
    uint32_t joint;
} brace_can_take_up_result_request_t;
uint32_t brace_can_pack_take_up_result_request(const brace_can_take_up_result_request_t *message, uint8_t data[8]);
void brace_can_unpack_take_up_result_request(const uint8_t data[8], brace_can_take_up_result_request_t *message);

typedef struct {
    uint32_t token;
    /* the joint, as asked */
    uint32_t joint;
    /* how the last take-up went */
    int32_t outcome;
    /* where the take-up stands now */
    uint32_t phase;
    /* the motor's torque at the joint, as of now [N mm, -838861 to 838861] */
    float torque_n_mm;
} brace_can_take_up_result_answer_0_t;
uint32_t brace_can_pack_take_up_result_answer_0(const brace_can_take_up_result_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_take_up_result_answer_0(const uint8_t data[8], brace_can_take_up_result_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the direction of down in the limb's plane, from +x [rad, -8.38861 to 8.38861] */
    float direction_rad;
    /* how far down leans out of the limb's plane [rad, -8.38861 to 8.38861] */
    float lean_rad;
} brace_can_set_gravity_request_t;
uint32_t brace_can_pack_set_gravity_request(const brace_can_set_gravity_request_t *message, uint8_t data[8]);
void brace_can_unpack_set_gravity_request(const uint8_t data[8], brace_can_set_gravity_request_t *message);

typedef struct {
    uint32_t token;
    /* the direction that holds now [rad, -8.38861 to 8.38861] */
    float direction_rad;
    /* the lean that holds now [rad, -8.38861 to 8.38861] */
    float lean_rad;
} brace_can_set_gravity_answer_0_t;
uint32_t brace_can_pack_set_gravity_answer_0(const brace_can_set_gravity_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_set_gravity_answer_0(const uint8_t data[8], brace_can_set_gravity_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along x [N, -8388.61 to 8388.61] */
    float fx_n;
    /* the force along z [N, -8388.61 to 8388.61] */
    float fz_n;
} brace_can_tip_force_request_t;
uint32_t brace_can_pack_tip_force_request(const brace_can_tip_force_request_t *message, uint8_t data[8]);
void brace_can_unpack_tip_force_request(const uint8_t data[8], brace_can_tip_force_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x, as asked [N, -8388.61 to 8388.61] */
    float fx_n;
    /* the force along z, as asked [N, -8388.61 to 8388.61] */
    float fz_n;
} brace_can_tip_force_answer_0_t;
uint32_t brace_can_pack_tip_force_answer_0(const brace_can_tip_force_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_tip_force_answer_0(const uint8_t data[8], brace_can_tip_force_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the true angle of the femur, measured from +x, before the load turns the joint [rad, -8.38861 to 8.38861] */
    float theta1_rad;
    /* the true flexion of the knee, before the load turns the joint [rad, -8.38861 to 8.38861] */
    float theta2_rad;
} brace_can_k_under_load_at_posture_request_t;
uint32_t brace_can_pack_k_under_load_at_posture_request(const brace_can_k_under_load_at_posture_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_posture_request(const uint8_t data[8],
    brace_can_k_under_load_at_posture_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
} brace_can_k_under_load_at_posture_answer_0_t;
uint32_t brace_can_pack_k_under_load_at_posture_answer_0(const brace_can_k_under_load_at_posture_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_posture_answer_0(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_min_n_per_mm;
} brace_can_k_under_load_at_posture_answer_1_t;
uint32_t brace_can_pack_k_under_load_at_posture_answer_1(const brace_can_k_under_load_at_posture_answer_1_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_posture_answer_1(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_k_under_load_at_posture_answer_2_t;
uint32_t brace_can_pack_k_under_load_at_posture_answer_2(const brace_can_k_under_load_at_posture_answer_2_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_posture_answer_2(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* how far force and weight move the tip along x [mm, -8388.61 to 8388.61] */
    float dx_mm;
    /* how far force and weight move the tip along z [mm, -8388.61 to 8388.61] */
    float dz_mm;
} brace_can_k_under_load_at_posture_answer_3_t;
uint32_t brace_can_pack_k_under_load_at_posture_answer_3(const brace_can_k_under_load_at_posture_answer_3_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_posture_answer_3(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* the multiple of the load at which the limb, held as it stands, would have no stiffness left; infinity where
     * there is none */
    float buckling_factor;
    /* the quality of K */
    uint32_t flags;
} brace_can_k_under_load_at_posture_answer_4_t;
uint32_t brace_can_pack_k_under_load_at_posture_answer_4(const brace_can_k_under_load_at_posture_answer_4_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_posture_answer_4(const uint8_t data[8],
    brace_can_k_under_load_at_posture_answer_4_t *message);

typedef struct {
    uint32_t token;
    /* how far the tip lies outwards from the femur axis [mm, -8388.61 to 8388.61] */
    float x_mm;
    /* how far the tip lies above the femur axis [mm, -8388.61 to 8388.61] */
    float z_mm;
} brace_can_k_under_load_at_tip_knee_up_request_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_up_request(const brace_can_k_under_load_at_tip_knee_up_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_up_request(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
} brace_can_k_under_load_at_tip_knee_up_answer_0_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_0(const brace_can_k_under_load_at_tip_knee_up_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_up_answer_0(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_min_n_per_mm;
} brace_can_k_under_load_at_tip_knee_up_answer_1_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_1(const brace_can_k_under_load_at_tip_knee_up_answer_1_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_up_answer_1(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_k_under_load_at_tip_knee_up_answer_2_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_2(const brace_can_k_under_load_at_tip_knee_up_answer_2_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_up_answer_2(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* how far force and weight move the tip along x [mm, -8388.61 to 8388.61] */
    float dx_mm;
    /* how far force and weight move the tip along z [mm, -8388.61 to 8388.61] */
    float dz_mm;
} brace_can_k_under_load_at_tip_knee_up_answer_3_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_3(const brace_can_k_under_load_at_tip_knee_up_answer_3_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_up_answer_3(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* the multiple of the load at which the limb, held as it stands, would have no stiffness left; infinity where
     * there is none */
    float buckling_factor;
    /* the quality of K */
    uint32_t flags;
} brace_can_k_under_load_at_tip_knee_up_answer_4_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_up_answer_4(const brace_can_k_under_load_at_tip_knee_up_answer_4_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_up_answer_4(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_up_answer_4_t *message);

typedef struct {
    uint32_t token;
    /* how far the tip lies outwards from the femur axis [mm, -8388.61 to 8388.61] */
    float x_mm;
    /* how far the tip lies above the femur axis [mm, -8388.61 to 8388.61] */
    float z_mm;
} brace_can_k_under_load_at_tip_knee_down_request_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_down_request(const brace_can_k_under_load_at_tip_knee_down_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_down_request(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_request_t *message);

typedef struct {
    uint32_t token;
    /* the force along x per displacement along x [N/mm, -4194.3 to 4194.3] */
    float k_xx_n_per_mm;
    /* the force along x per displacement along z, and the reverse [N/mm, -4194.3 to 4194.3] */
    float k_xz_n_per_mm;
} brace_can_k_under_load_at_tip_knee_down_answer_0_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_0(const brace_can_k_under_load_at_tip_knee_down_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_down_answer_0(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the force along z per displacement along z [N/mm, -4194.3 to 4194.3] */
    float k_zz_n_per_mm;
    /* the smaller eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_min_n_per_mm;
} brace_can_k_under_load_at_tip_knee_down_answer_1_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_1(const brace_can_k_under_load_at_tip_knee_down_answer_1_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_down_answer_1(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_1_t *message);

typedef struct {
    uint32_t token;
    /* the larger eigenvalue of K [N/mm, 0 to 8388.61] */
    float lambda_max_n_per_mm;
    /* the direction of lambda_max, measured from +x [rad, -3.2767 to 3.2767] */
    float stiff_axis_rad;
} brace_can_k_under_load_at_tip_knee_down_answer_2_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_2(const brace_can_k_under_load_at_tip_knee_down_answer_2_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_down_answer_2(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_2_t *message);

typedef struct {
    uint32_t token;
    /* how far force and weight move the tip along x [mm, -8388.61 to 8388.61] */
    float dx_mm;
    /* how far force and weight move the tip along z [mm, -8388.61 to 8388.61] */
    float dz_mm;
} brace_can_k_under_load_at_tip_knee_down_answer_3_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_3(const brace_can_k_under_load_at_tip_knee_down_answer_3_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_down_answer_3(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_3_t *message);

typedef struct {
    uint32_t token;
    /* the multiple of the load at which the limb, held as it stands, would have no stiffness left; infinity where
     * there is none */
    float buckling_factor;
    /* the quality of K */
    uint32_t flags;
} brace_can_k_under_load_at_tip_knee_down_answer_4_t;
uint32_t brace_can_pack_k_under_load_at_tip_knee_down_answer_4(const brace_can_k_under_load_at_tip_knee_down_answer_4_t *message,
    uint8_t data[8]);
void brace_can_unpack_k_under_load_at_tip_knee_down_answer_4(const uint8_t data[8],
    brace_can_k_under_load_at_tip_knee_down_answer_4_t *message);

typedef struct {
    uint32_t token;
    /* the force outwards in the limb's plane [N, -327.67 to 327.67] */
    float fx_n;
    /* the force across that plane, to the left [N, -327.67 to 327.67] */
    float fy_n;
    /* the force upwards in that plane [N, -327.67 to 327.67] */
    float fz_n;
} brace_can_tip_force_in_space_request_t;
uint32_t brace_can_pack_tip_force_in_space_request(const brace_can_tip_force_in_space_request_t *message,
    uint8_t data[8]);
void brace_can_unpack_tip_force_in_space_request(const uint8_t data[8],
    brace_can_tip_force_in_space_request_t *message);

typedef struct {
    uint32_t token;
    /* the force outwards in the limb's plane, as asked [N, -327.67 to 327.67] */
    float fx_n;
    /* the force across that plane, to the left, as asked [N, -327.67 to 327.67] */
    float fy_n;
    /* the force upwards in that plane, as asked [N, -327.67 to 327.67] */
    float fz_n;
} brace_can_tip_force_in_space_answer_0_t;
uint32_t brace_can_pack_tip_force_in_space_answer_0(const brace_can_tip_force_in_space_answer_0_t *message,
    uint8_t data[8]);
void brace_can_unpack_tip_force_in_space_answer_0(const uint8_t data[8],
    brace_can_tip_force_in_space_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* low half of the number that the controller has sent: in the answer to the sign before, in the answer to the
     * command that begins now, as life_number */
    uint32_t heard;
    /* on a bench that whole number; on a guarded board the check over challenge and number */
    uint32_t check;
} brace_can_sign_of_life_request_t;
uint32_t brace_can_pack_sign_of_life_request(const brace_can_sign_of_life_request_t *message, uint8_t data[8]);
void brace_can_unpack_sign_of_life_request(const uint8_t data[8], brace_can_sign_of_life_request_t *message);

typedef struct {
    uint32_t token;
    /* the port of the one whose session is open */
    uint32_t owner;
    /* who may move the limb and write to this controller */
    uint32_t setting;
    /* the number for the next sign of life */
    uint32_t number;
} brace_can_sign_of_life_answer_0_t;
uint32_t brace_can_pack_sign_of_life_answer_0(const brace_can_sign_of_life_answer_0_t *message, uint8_t data[8]);
void brace_can_unpack_sign_of_life_answer_0(const uint8_t data[8], brace_can_sign_of_life_answer_0_t *message);

typedef struct {
    uint32_t token;
    /* the code of the request */
    uint32_t code;
    /* why: docs/errors.md, statuses and refusals */
    int32_t status;
    /* what more there is to say: an index, a mode, a hash */
    uint32_t detail;
} brace_can_refusal_t;
uint32_t brace_can_pack_refusal(const brace_can_refusal_t *message, uint8_t data[8]);
void brace_can_unpack_refusal(const uint8_t data[8], brace_can_refusal_t *message);

#endif
