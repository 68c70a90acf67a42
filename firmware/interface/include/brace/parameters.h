/* Everything a controller is told once and keeps: the limb, its drives, its instruments, and its own manners.
 *
 * One struct of plain numbers. The dictionary (firmware/interface/dictionary.toml) lists every member with its key in
 * limb.toml, unit, range and default; the table of members is generated from it. A parameter block is this struct as
 * bytes: header, members little-endian in the dictionary's order, CRC.
 *
 *   offset  0  magic "BRCE"           4
 *           4  format = 1             2
 *           6  header bytes           2
 *           8  schema hash            4   CRC-32 of the member list's names, types and units: the dictionary's
 *          12  members' bytes         4
 *          16  sequence               4   of the parameter set; newer is larger, modulo 2^32
 *          20  members ...
 *        last  CRC-32 of all before   4   (IEEE 802.3, as zlib)
 *
 * Pure functions; any thread. Refused calls leave their outputs untouched.
 */
#ifndef BRACE_PARAMETERS_H
#define BRACE_PARAMETERS_H

#include <stddef.h>
#include <stdint.h>

#include "brace/limb.h"
#include "brace/status.h"

/* A joint's drive and its instruments, joint side of the reduction. */
typedef struct {
    float coulomb_n_mm;             /* dry friction at the joint [0, 1e9] */
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
    float bias_x_n, bias_z_n, gain, rotation_rad, crosstalk_xz, crosstalk_zx, drift_x_n_per_s, drift_z_n_per_s, saturation_n;
    float noise_n; /* one sigma of a reading [0, 1e6] */
} brace_sensor_t;

typedef struct {
    float creep_ratio, creep_time_constant_s;
    float joint_compliance_per_degc, reference_degc;
    float contact_play_mm;
    float change_at_s, change_link, change_bending_factor; /* kept for the host; nothing on the limb follows them */
} brace_slow_effects_t;

typedef struct {
    uint32_t node_id;         /* on CAN [0, 127]; 0: unset, listen only */
    uint32_t can_bit_rate;    /* [bit/s] */
    uint32_t tick_us;         /* period of the application's tick [500, 5000] */
    uint32_t age_limit_us;    /* K older than this is STALE [1000, 1e7] */
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

#endif
