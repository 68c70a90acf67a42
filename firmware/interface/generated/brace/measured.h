/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_MEASURED_H
#define BRACE_MEASURED_H

#include <stdint.h>

/* Entries of the dictionary by number: parameters from 0 on, these from here on. As Modbus input registers: two
 * each, high word first, from 0 on and from 0x1000 on. */
enum {
    BRACE_ENTRY_MEASURED = 0x1000,
    BRACE_ENTRY_ANSWERED = 0x1800
};

/* First Modbus register of the commands, two each. */
enum { BRACE_REGISTER_COMMANDS = 0x4000 };

/* All of one tick. A float that is not known is NaN, a u32 all ones. */
typedef struct {
    float probe_f32; /* 12345.5 always: does the reader take the words in the right order? */
    uint32_t probe_u32; /* 16909060 (0x01020304) always */
    uint32_t dictionary_hash; /* of everything that matters on the wire */
    uint32_t firmware_version; /* major * 65536 + minor * 256 + patch */
    uint32_t sequence; /* of the snapshot; wraps */
    uint32_t age_us; /* of the samples when this was read */
    uint32_t mode; /* what the controller is doing */
    uint32_t faults; /* faults that are there now */
    uint32_t k_is_valid; /* 1: K may be used, with its flags */
    uint32_t flags; /* quality of K */
    float k_xx_n_per_mm; /* force along x per displacement along x */
    float k_xz_n_per_mm; /* force along x per displacement along z, and the reverse */
    float k_zz_n_per_mm; /* force along z per displacement along z */
    float lambda_min_n_per_mm; /* smaller eigenvalue of K */
    float lambda_max_n_per_mm; /* larger eigenvalue of K */
    float stiff_axis_rad; /* direction of lambda_max from +x */
    float engaged_k_xx_n_per_mm; /* k_xx once every gap has closed */
    float engaged_k_xz_n_per_mm; /* k_xz once every gap has closed */
    float engaged_k_zz_n_per_mm; /* k_zz once every gap has closed */
    float engaged_lambda_min_n_per_mm; /* lambda_min once every gap has closed */
    float engaged_lambda_max_n_per_mm; /* lambda_max once every gap has closed */
    float theta1_rad; /* true angle of the femur from +x */
    float theta2_rad; /* true flexion of the knee */
    float tip_x_mm; /* tip outwards from the femur axis */
    float tip_z_mm; /* tip above the femur axis */
    float force_x_n; /* of the ground on the tip, along x */
    float force_z_n; /* of the ground on the tip, along z */
    uint32_t force_is_sensed; /* 1: by the tip's sensor; 0: from the joints' loads */
    float play_shift_x_mm; /* of the tip by the joints' play, along x */
    float play_shift_z_mm; /* of the tip by the joints' play, along z */
    uint32_t play_femur; /* which flank of the femur joint's play carries */
    float play_femur_offset_rad; /* true angle less motor angle at the femur joint, by its play */
    float load_femur_n_mm; /* that the femur joint's gap transmits */
    float motor_femur_rad; /* motor angle of theta1 */
    float torque_femur_n_mm; /* motor torque of theta1 */
    uint32_t play_tibia; /* which flank of the tibia joint's play carries */
    float play_tibia_offset_rad; /* true angle less motor angle at the tibia joint, by its play */
    float load_tibia_n_mm; /* that the tibia joint's gap transmits */
    float motor_tibia_rad; /* motor angle of theta2 */
    float torque_tibia_n_mm; /* motor torque of theta2 */
    float temperature_degc; /* of the joints, the warmer one */
    uint32_t parameter_crc; /* of the parameters in force */
    uint32_t parameter_origin; /* where they come from */
    uint32_t parameter_sequence; /* of the parameter set in force */
    uint32_t loading_outcome; /* of the last loading test: 0 none, 1 running, 2 done, 3 stopped; else why it ended, 256 less 1 force, 2 torque, 3 travel beyond its bound, 4 not done in time, 5 no force known, 6 a fault or a flank let go, 7 the motors do not follow */
    uint32_t loading_rows; /* recorded and not fetched away */
    float loading_k_x_n_per_mm; /* force along x per displacement along the test's axis, least squares */
    float loading_k_z_n_per_mm; /* force along z per displacement along the test's axis, least squares */
    float loading_ratio_k_x_n_per_mm; /* the same by the paper's mean of ratios, along x */
    float loading_ratio_k_z_n_per_mm; /* the same by the paper's mean of ratios, along z */
    float loading_score_x; /* measured less the model's, in sigmas of both, along x */
    float loading_score_z; /* measured less the model's, in sigmas of both, along z */
    uint32_t ticks_late; /* counted since start */
    uint32_t samples_bad; /* counted since start */
    uint32_t frames_refused; /* CAN: counted since start */
    uint32_t frames_unknown; /* CAN: counted since start */
    uint32_t modbus_broken; /* frames with a wrong CRC or length: counted since start */
    uint32_t modbus_refused; /* answered with an exception: counted since start */
} brace_measured_t;

enum { BRACE_MEASURED_COUNT = 58 };
#ifndef __cplusplus
_Static_assert(sizeof(brace_measured_t) == 4 * BRACE_MEASURED_COUNT, "32 bits each");
#endif

/* K at the posture asked for over Modbus. */
typedef struct {
    float asked_k_xx_n_per_mm; /* k_xx at the posture or tip asked for */
    float asked_k_xz_n_per_mm; /* k_xz at the posture or tip asked for */
    float asked_k_zz_n_per_mm; /* k_zz at the posture or tip asked for */
    float asked_lambda_min_n_per_mm; /* lambda_min at the posture or tip asked for */
    float asked_lambda_max_n_per_mm; /* lambda_max at the posture or tip asked for */
    float asked_stiff_axis_rad; /* stiff axis at the posture or tip asked for */
    uint32_t asked_flags; /* quality of that K */
    float asked_force_x_n; /* force of the ground on the tip for the displacement asked for, outwards */
    float asked_force_z_n; /* the same, upwards */
    float asked_force_low_n; /* what any displacement of that size gives at least */
    float asked_force_high_n; /* what any displacement of that size gives at most */
    float asked_sag_x_mm; /* how far the tip yields to the load asked for, outwards */
    float asked_sag_z_mm; /* the same, upwards */
    float asked_margin_n; /* what may be added along the surface asked for before the foot slides */
    float asked_angle_left_rad; /* from the force of now to the edge of the friction cone */
    uint32_t asked_contact; /* what the foot does there */
} brace_answered_t;

enum { BRACE_ANSWERED_COUNT = 16 };
#ifndef __cplusplus
_Static_assert(sizeof(brace_answered_t) == 4 * BRACE_ANSWERED_COUNT, "32 bits each");
#endif

/* What was last written to the command registers. */
typedef struct {
    uint32_t set_mode; /* 0xc0de0002: CONFIGURATION; 0xc0de0001: back to MONITOR, as by itself after 10 s in which nothing was written or stored */
    uint32_t commit; /* 0xc0de0001: stores the holding registers' parameters, reads back, puts them in force; CONFIGURATION only */
    uint32_t rollback; /* 0xc0de0001: puts the set before back in force; CONFIGURATION only */
    uint32_t clear_faults; /* bits of faults to clear */
    uint32_t take_up; /* joint (1 femur, 2 tibia) + 256 for the positive flank, + 512 for the negative */
    uint32_t let_go; /* any value: lets every joint go, ends a loading test */
    float asked_theta1_rad; /* a posture to know K at; write both in one request */
    float asked_theta2_rad; /* a posture to know K at; write both in one request */
    float asked_tip_x_mm; /* a place of the tip to know K at, outwards from the hip; write tip_x, tip_z and knee in one request */
    float asked_tip_z_mm; /* the same, upwards */
    uint32_t asked_knee; /* 0: knee up, 1: knee down */
    float asked_dx_mm; /* a displacement of the tip to know the contact force of; write both in one request */
    float asked_dz_mm; /* the same, upwards */
    float asked_load_x_n; /* a load on the tip to know the sag of; write both in one request */
    float asked_load_z_n; /* the same, upwards */
    float asked_normal_rad; /* direction of the surface's normal, to know how far the foot is from sliding; write both in one request */
    float asked_friction; /* friction coefficient of that surface */
} brace_commands_t;

enum { BRACE_COMMANDS_COUNT = 17 };
#ifndef __cplusplus
_Static_assert(sizeof(brace_commands_t) == 4 * BRACE_COMMANDS_COUNT, "32 bits each");
#endif

/* What numbers are called, and bits, from 0: to initialise arrays of const char * with. */
#define BRACE_MODE_NAMES \
    { "START", "MONITOR", "CONFIGURATION", "TAKING_UP", "LOADING_TEST", "FAULT" }
#define BRACE_FAULTS_NAMES \
    { "SENSOR_FEMUR", "SENSOR_TIBIA", "ENCODER_STUCK", "TICK_LATE", "PARAMETERS", "STORE", "CAN_BUS_OFF", \
      "MODEL_DRIFT", "CRASHED" }
#define BRACE_FLAGS_NAMES \
    { "UNCALIBRATED", "NEAR_SINGULAR", "SATURATED", "GAP_OPEN", "STALE", "OUT_OF_RANGE" }
#define BRACE_PLAY_FEMUR_NAMES \
    { "UNKNOWN", "TAKING_UP", "ENGAGED_POSITIVE", "ENGAGED_NEGATIVE", "CROSSING", "FAULT" }
#define BRACE_PLAY_TIBIA_NAMES \
    { "UNKNOWN", "TAKING_UP", "ENGAGED_POSITIVE", "ENGAGED_NEGATIVE", "CROSSING", "FAULT" }
#define BRACE_PARAMETER_ORIGIN_NAMES \
    { "DEFAULT", "SLOT_A", "SLOT_B" }
#define BRACE_ASKED_CONTACT_NAMES \
    { "HOLDS", "SLIDES", "LIFTS" }

#endif
