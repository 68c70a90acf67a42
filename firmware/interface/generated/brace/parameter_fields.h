/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_PARAMETER_FIELDS_H
#define BRACE_PARAMETER_FIELDS_H

#include <stdint.h>

#include "brace/limb_fields.h"

/* A joint's drive and its instruments, on the joint's side of the reduction. */
typedef struct {
    /* the dry friction at the joint [N mm, 0 to 1e+09] */
    float coulomb_n_mm;
    /* the share of the spring's torque that is added to the dry friction at the joint [0 to 0.9] */
    float coulomb_per_load_ratio;
    /* the cubic stiffening at the joint [N mm/rad^3, 0 to 1e+30] */
    float hardening_n_mm_per_rad3;
    /* the Coulomb friction of the joint's motor and gears, before the play, at the joint [N mm, 0 to 1e+06] */
    float motor_friction_n_mm;
    /* how far the motor's friction may be off, relative to itself, as it sticks, creeps and changes with load and
     * place; measured gears have 1 [0 to 1] */
    float motor_friction_tolerance_ratio;
    /* the inertia of the joint's motor and gears, at the joint [N mm s^2/rad, 0 to 1e+06] */
    float motor_inertia_n_mm_s2_per_rad;
    /* the greatest torque of the joint's motor, at the joint [N mm, above 0 to 1e+06] */
    float torque_range_n_mm;
    /* one sigma of a sample of the motor's torque; at most the torque range [N mm, 0 to 1e+06] */
    float torque_noise_n_mm;
    /* the bound of the torque sample's offset; at most the torque range [N mm, 0 to 1e+06] */
    float torque_bias_n_mm;
    /* the resolution of the motor's angle, at the joint [rad, 1e-07 to 0.01] */
    float angle_step_rad;
    /* the least commanded angle of the travel at the joint [rad, -7.9 to 7.9] */
    float angle_min_rad;
    /* the greatest commanded angle of the travel at the joint [rad, -7.9 to 7.9] */
    float angle_max_rad;
    /* the bound of the joint's motor torque while play is taken up; at most the torque range [N mm, above 0 to
     * 1e+06] */
    float takeup_torque_n_mm;
    /* the share of the motor's torque that is added to the joint's motor friction, because gears rub harder under
     * load; docs/joints.md has published values [0 to 0.9] */
    float motor_friction_per_torque_ratio;
    /* the share of the load behind the joint's gear that is added to its motor friction [0 to 0.9] */
    float motor_friction_per_load_ratio;
    /* the least share of the joint's motor friction that is left while the joint moves; published fits of geared
     * servos have 0.4 to 0.9 [0 to 1] */
    float motor_friction_sliding_ratio;
    /* how far the joint's torque by current is trusted, as one sigma relative to it; makers' constants and
     * published fits of the same servos are apart by this much [0 to 1] */
    float torque_gain_rel;
} brace_drive_t;

/* The force sensor at the tip. */
typedef struct {
    /* a constant added to every reading along x [N, -1e+06 to 1e+06] */
    float bias_x_n;
    /* a constant added to every reading along z [N, -1e+06 to 1e+06] */
    float bias_z_n;
    /* the factor on every force [above 0 to 1000] */
    float gain;
    /* how far the sensor is turned in the limb's plane [rad, -3.14159 to 3.14159] */
    float rotation_rad;
    /* the share of the force along z that the sensor reads on x [-1 to 1] */
    float crosstalk_xz;
    /* the share of the force along x that the sensor reads on z [-1 to 1] */
    float crosstalk_zx;
    /* the drift of the reading along x [N/s, -1000 to 1000] */
    float drift_x_n_per_s;
    /* the drift of the reading along z [N/s, -1000 to 1000] */
    float drift_z_n_per_s;
    /* the magnitude at which the sensor clips each reading [N, above 0 to inf] */
    float saturation_n;
    /* one sigma of a reading, its resolution included [N, 0 to 1e+06] */
    float noise_n;
} brace_sensor_t;

/* Effects that come with time or temperature, or at the contact. The controller keeps the change of a link for the
 * host; nothing on the limb follows it. */
typedef struct {
    /* the delayed deflection of each joint relative to its elastic one [0 to 1000] */
    float creep_ratio;
    /* the time constant of the delayed deflection [s, above 0 to inf] */
    float creep_time_constant_s;
    /* the relative change of the joints' compliance [1/degC, -1 to 1] */
    float joint_compliance_per_degc;
    /* the temperature that the compliances are given for [degC, -273.15 to 1000] */
    float reference_degc;
    /* the full clearance of the tip's ball joint, per axis [mm, 0 to 1000] */
    float contact_play_mm;
    /* the time at which a link's bending changed; inf: it did not change [s, -inf to inf] */
    float change_at_s;
    /* the link that changed [0 coxa, 1 femur, 2 tibia] */
    uint32_t change_link;
    /* the factor on that link's bending compliance before then: [link] has today's [above 0 to 1000] */
    float change_bending_factor;
} brace_slow_effects_t;

/* The controller's own settings. */
typedef struct {
    /* the limb's number on the CAN bus; 0 means unset: the controller listens and sends nothing [0 to 127] */
    uint32_t node_id;
    /* the CAN bus's bit rate [bit/s, 125000, 250000, 500000, 1000000] */
    uint32_t can_bit_rate;
    /* the period of the controller's tick [us, 500 to 5000] */
    uint32_t tick_us;
    /* the age above which K is called stale; at least the tick [us, 1000 to 1e+07] */
    uint32_t age_limit_us;
    /* how often K goes out on CAN; 0 means never [Hz, 0 to 1000] */
    uint32_t stiffness_hz;
    /* how often eigenvalues and posture go out on CAN, together with a K; 0 means never [Hz, 0 to 1000] */
    uint32_t posture_hz;
    /* how often the load that K counts and K without it go out on CAN, together with a K; 0 means never [Hz, 0 to
     * 1000] */
    uint32_t load_hz;
    /* how often K's uncertainty goes out on CAN, together with a K; 0 means never [Hz, 0 to 1000] */
    uint32_t sigma_hz;
    /* how often the heartbeat goes out [Hz, 1 to 10] */
    uint32_t heartbeat_hz;
    /* the share of the bus that K, its uncertainty, eigenvalues, posture and load of this controller may take; the
     * controller sends them less often where they would take more [above 0 to 1] */
    float bus_load_ratio;
    /* the bit rate of a CAN FD snapshot's data; 0 means that classic frames are sent [bit/s, 0 to 8e+06] */
    uint32_t can_fd_bit_rate;
    /* how many milliseconds after its owner has fallen silent the limb lets go by itself; 0 means never: it holds
     * its set-points [0 to 600000] */
    uint32_t let_go_after_ms;
    /* the identifier of the CAN frame that stops every limb of the bus, whatever the frame carries; it wins over
     * all other identifiers of a controller, and holds from the next start on [1 to 127] */
    uint32_t stop_id;
    /* the controller's address on Modbus [1 to 247] */
    uint32_t modbus_address;
    /* the baud rate of Modbus RTU [bit/s, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400] */
    uint32_t modbus_baud;
} brace_controller_t;

/* Everything a controller is sent once and keeps. */
typedef struct {
    brace_limb_t limb;
    brace_drive_t drive[BRACE_LINK_COUNT];
    brace_gravity_t gravity;
    brace_sensor_t sensor;
    brace_slow_effects_t slow;
    brace_controller_t controller;
} brace_parameters_t;

#endif
