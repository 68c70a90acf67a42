/* Everything a controller is told once and keeps: the limb, its drives, its instruments, and its own manners.
 *
 * One struct of plain 32-bit numbers. The dictionary (firmware/interface/dictionary.toml) lists every member in the
 * struct's order, with its key in limb.toml, unit, range and default; the tables are generated from it
 * (generated/brace/parameter_list.h has count, schema hash and an index for each member). A parameter block is this
 * struct as bytes: header, members little-endian in the same order, CRC.
 *
 *   offset  0  magic "BRCE"           4
 *           4  format = 1             2
 *           6  header bytes = 20      2
 *           8  schema hash            4   CRC-32 of the member list's keys, types and units
 *          12  members' bytes         4
 *          16  sequence               4   of the parameter set; newer is larger, modulo 2^32
 *          20  members ...
 *        last  CRC-32 of all before   4   (IEEE 802.3, as zlib)
 *
 * Pure functions, any thread, not for the tick; no heap, no recursion, loops over the fixed list of members. Refused
 * calls leave their outputs untouched, save where said. Costs: Cortex-M4F, instructions that the
 * bench's plugin counts over the unit tests.
 */
#ifndef BRACE_PARAMETERS_H
#define BRACE_PARAMETERS_H

#include <stddef.h>
#include <stdint.h>

#include "brace/limb.h"
#include "brace/parameter_list.h"
#include "brace/status.h"

/* A joint's drive and its instruments, joint side of the reduction. */
typedef struct {
    float coulomb_n_mm;             /* dry friction at the joint [0, 1e9] */
    float coulomb_per_load_ratio;   /* further friction, of the spring's torque, as gears have it [0, 0.9] */
    float hardening_n_mm_per_rad3;  /* torque = deflection / compliance + this * deflection^3 [0, 1e30] */
    float motor_friction_n_mm;      /* Coulomb friction of motor and gears, before the gap [0, 1e6] */
    float motor_friction_tolerance_ratio; /* how far that may be off [0, 1] */
    float motor_inertia_n_mm_s2_per_rad;  /* [0, 1e6] */
    float torque_range_n_mm;        /* of the motor (0, 1e6] */
    float torque_noise_n_mm;        /* one sigma of a torque sample [0, torque_range] */
    float torque_bias_n_mm;         /* bound of its offset [0, torque_range] */
    float angle_step_rad;           /* resolution of the motor's angle [1e-7, 0.01] */
    float angle_min_rad, angle_max_rad; /* of the joint's travel [-7.9, 7.9] */
    float takeup_torque_n_mm;       /* bound of the motor torque while taking up play (0, torque_range] */
} brace_drive_t;

typedef struct {
    float femur_n, tibia_n, knee_n;
} brace_gravity_t;

typedef struct {
    float bias_x_n, bias_z_n, gain, rotation_rad, crosstalk_xz, crosstalk_zx, drift_x_n_per_s, drift_z_n_per_s,
        saturation_n;
    float noise_n; /* one sigma of a reading [0, 1e6] */
} brace_sensor_t;

typedef struct {
    float creep_ratio, creep_time_constant_s;
    float joint_compliance_per_degc, reference_degc;
    float contact_play_mm;
    float change_at_s;             /* this and the next two: kept for the host; nothing on the limb follows them */
    uint32_t change_link;          /* [BRACE_COXA, BRACE_TIBIA] */
    float change_bending_factor;
} brace_slow_effects_t;

typedef struct {
    uint32_t node_id;         /* on CAN [0, 127]; 0: unset, listen only */
    uint32_t can_bit_rate;    /* [bit/s] */
    uint32_t tick_us;         /* period of the application's tick [500, 5000] */
    uint32_t age_limit_us;    /* K older than this is STALE [1000, 1e7] */
    uint32_t stiffness_hz;    /* stiffness_a and _b on CAN [0, 1000]; 0: not sent */
    uint32_t posture_hz;      /* eigenvalues and posture on CAN [0, 1000] */
    uint32_t heartbeat_hz;    /* [1, 10] */
    float bus_load_ratio;     /* process data are thinned to this share of the bus (0, 1] */
    uint32_t can_fd_bit_rate; /* of a CAN FD snapshot's data [bit/s]; 0: classic frames */
    uint32_t modbus_address;  /* [1, 247] */
    uint32_t modbus_baud;     /* [bit/s] */
} brace_controller_t;

typedef struct {
    brace_limb_t limb;
    brace_drive_t drive[BRACE_LINK_COUNT];
    brace_gravity_t gravity;
    brace_sensor_t sensor;
    brace_slow_effects_t slow;
    brace_controller_t controller;
} brace_parameters_t;

/* Where the parameters in force come from. */
typedef enum {
    BRACE_PARAMETERS_DEFAULT = 0, /* no valid set is kept: safe defaults, every K is UNCALIBRATED */
    BRACE_PARAMETERS_SLOT_A = 1,
    BRACE_PARAMETERS_SLOT_B = 2
} brace_parameter_origin_t;

enum {
    BRACE_BLOCK_FORMAT = 1,
    BRACE_BLOCK_HEADER_BYTES = 20,
    BRACE_BLOCK_BYTES = BRACE_BLOCK_HEADER_BYTES + 4 * BRACE_PARAMETER_COUNT + 4
};

/* What a block's header says of itself. */
typedef struct {
    uint32_t format;
    uint32_t schema_hash;
    uint32_t block_bytes; /* header, members and CRC */
    uint32_t sequence;
} brace_block_header_t;

/* Safe defaults: a limb that can exist (the paper's), no effect but compliance, node unset, listen only. K computed
 * from them is UNCALIBRATED. Null is ignored. */
void brace_parameters_default(brace_parameters_t *parameters);

/* Could a controller run on these? Every member in its range, then what members say together: noise, bias and take-up
 * torque within the torque range, travel from below to above, bit rates that exist, an age limit above the tick; then
 * brace_limb_check.
 *   wrong_index (out, may be null): the first member at fault (BRACE_PARAMETER_..., brace_parameter_key), or
 *     BRACE_PARAMETER_COUNT when it is the limb as a whole; written only with BRACE_E_PARAMETER, BRACE_E_NOT_FINITE
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE (NaN), BRACE_E_PARAMETER
 * cost: 3,200 instructions; stack 100 bytes */
brace_status_t brace_parameters_check(const brace_parameters_t *parameters, uint32_t *wrong_index);

/* The same in pieces, for a tick: 0 to BRACE_CHECK_PIECES - 1, in this order until one refuses. The last one is what
 * members say together; it takes for granted that each is in its range.
 * returns also BRACE_E_RANGE (no such piece); cost: at most 1,000 instructions */
enum {
    BRACE_CHECK_MEMBERS = 24, /* a piece */
    BRACE_CHECK_TOGETHER = (BRACE_PARAMETER_COUNT + BRACE_CHECK_MEMBERS - 1) / BRACE_CHECK_MEMBERS,
    BRACE_CHECK_PIECES = BRACE_CHECK_TOGETHER + 1
};
brace_status_t brace_parameters_check_piece(const brace_parameters_t *parameters, uint32_t piece,
                                            uint32_t *wrong_index);

/* Is one member, as its 32 bits, in its own range? What members say together is brace_parameters_check's.
 * returns BRACE_OK, BRACE_E_RANGE (no such member), BRACE_E_PARAMETER, BRACE_E_NOT_FINITE;
 * cost: at most 60 instructions */
brace_status_t brace_parameter_in_range(uint32_t index, uint32_t word);

/* Parameters to a block of BRACE_BLOCK_BYTES. What brace_parameters_check refuses is refused.
 *   room: bytes that block has
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_LENGTH (room), BRACE_E_NOT_FINITE, BRACE_E_PARAMETER
 * cost: 8,100 instructions; stack 150 bytes */
brace_status_t brace_parameters_pack(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block,
                                     uint32_t room);

/* The same in pieces: a block but for its last four bytes, the CRC-32 of all before them; nothing is checked. Not null.
 * cost: 560 instructions */
void brace_block_compose(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block);

/* A block to parameters; nothing of it is believed before the CRC is right.
 *   length: bytes of the block, exactly
 *   sequence (out, may be null)
 *   wrong_index (out, may be null): as brace_parameters_check, and written by the same refusals only
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_LENGTH (too short for a header, or other than the header says),
 *   BRACE_E_MAGIC, BRACE_E_FORMAT, BRACE_E_CHECKSUM, BRACE_E_SCHEMA (sound, but of another dictionary;
 *   brace_block_header tells its hash, ours is BRACE_SCHEMA_HASH), BRACE_E_NOT_FINITE, BRACE_E_PARAMETER
 * cost: 8,400 instructions; stack 560 bytes */
brace_status_t brace_parameters_unpack(const uint8_t *block, uint32_t length, brace_parameters_t *parameters,
                                       uint32_t *sequence, uint32_t *wrong_index);

/* A block's header alone, whoever wrote it: nothing is checked but magic and format, so that both hashes can be shown.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_LENGTH (less than a header, or it names an impossible length),
 *   BRACE_E_MAGIC, BRACE_E_FORMAT; cost: 40 instructions */
brace_status_t brace_block_header(const uint8_t *block, uint32_t length, brace_block_header_t *header);

/* The members of a block that brace_parameters_unpack has taken, or would take: nothing is checked. Not null.
 * cost: 430 instructions */
void brace_block_members(const uint8_t *block, brace_parameters_t *parameters);

/* Identity of a set of values: CRC-32 of schema hash and members, whatever its sequence. Equal values, equal number, on
 * every controller and in every tool. 0 for null. cost: 6,000 instructions */
uint32_t brace_parameters_crc(const brace_parameters_t *parameters);

/* CRC-32 (IEEE 802.3, reflected, as zlib's crc32): of `count` bytes, going on from `crc` (0 at first).
 * cost: 14 instructions a byte */
uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count);

/* Member by index, for services and messages; constant storage. key: as in limb.toml; "the limb as a whole" from
 * BRACE_PARAMETER_COUNT on. For hosts: an image that never asks carries no texts. */
const char *brace_parameter_key(uint32_t index);
const char *brace_parameter_unit(uint32_t index);

#endif
