/* Written by tools/interface from dictionary.toml; do not edit. */
#ifndef BRACE_MEASURED_H
#define BRACE_MEASURED_H

#include <stdint.h>

/* Entries of the dictionary by number: parameters from 0 on, these from here on. */
enum {
    BRACE_ENTRY_MEASURED = 0x1000,
    BRACE_ENTRY_ANSWERED = 0x1800,
    BRACE_ENTRY_COMMANDS = 0x2000
};

/* The first Modbus register of each struct below: input registers of what is measured and answered,
 * holding registers of the commands. Every value takes two, high word first, in the struct's order. */
enum {
    BRACE_REGISTER_MEASURED = 0x0000,
    BRACE_REGISTER_ANSWERED = 0x1000,
    BRACE_REGISTER_COMMANDS = 0x4000
};

/* All of one tick. A float that is not known is NaN, a u32 all ones. */
typedef struct {
    /* always 12345.5: a reader that gets another number swaps words or bytes */
    float probe_f32;
    /* always 16909060 (0x01020304): a reader that gets another number swaps words or bytes */
    uint32_t probe_u32;
    /* a checksum over names, places, types and units of everything on the wire; two ends whose hashes differ
     * cannot understand each other */
    uint32_t dictionary_hash;
    /* the version of the firmware: major * 65536 + minor * 256 + patch */
    uint32_t firmware_version;
    /* the number of the snapshot; it counts up in every tick and wraps at 2^32 */
    uint32_t sequence;
    /* the age of the joints' samples when this was read */
    uint32_t age_us;
    /* what the controller is doing */
    uint32_t mode;
    /* the faults that are there now */
    uint32_t faults;
    /* 1 where K may be used with its flags, else 0 */
    uint32_t k_is_valid;
    /* the quality of K */
    uint32_t flags;
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
    /* k_xx once every gap has closed */
    float engaged_k_xx_n_per_mm;
    /* k_xz once every gap has closed */
    float engaged_k_xz_n_per_mm;
    /* k_zz once every gap has closed */
    float engaged_k_zz_n_per_mm;
    /* lambda_min once every gap has closed */
    float engaged_lambda_min_n_per_mm;
    /* lambda_max once every gap has closed */
    float engaged_lambda_max_n_per_mm;
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
    /* 1 where the tip's sensor measures the force, 0 where the controller works it out from the joints' loads */
    uint32_t force_is_sensed;
    /* how far the joints' play shifts the tip along x */
    float play_shift_x_mm;
    /* how far the joints' play shifts the tip along z */
    float play_shift_z_mm;
    /* which side of the femur joint's backlash is loaded */
    uint32_t play_femur;
    /* the true angle less the motor angle at the femur joint, as far as its play makes it */
    float play_femur_offset_rad;
    /* the load that the femur joint's gap transmits */
    float load_femur_n_mm;
    /* the motor angle of theta1 */
    float motor_femur_rad;
    /* the motor torque of theta1 */
    float torque_femur_n_mm;
    /* which side of the tibia joint's backlash is loaded */
    uint32_t play_tibia;
    /* the true angle less the motor angle at the tibia joint, as far as its play makes it */
    float play_tibia_offset_rad;
    /* the load that the tibia joint's gap transmits */
    float load_tibia_n_mm;
    /* the motor angle of theta2 */
    float motor_tibia_rad;
    /* the motor torque of theta2 */
    float torque_tibia_n_mm;
    /* the temperature of the femur's or the tibia's joint, whichever is warmer; the coxa joint does not count */
    float temperature_degc;
    /* the CRC of the parameters in force */
    uint32_t parameter_crc;
    /* where the parameters in force come from */
    uint32_t parameter_origin;
    /* the sequence number of the parameter set in force */
    uint32_t parameter_sequence;
    /* how the last loading test went; a negative number is sent as 256 plus it */
    uint32_t loading_outcome;
    /* how many rows of the last loading test the recorder holds */
    uint32_t loading_rows;
    /* the force along x per displacement along the test's axis, by least squares */
    float loading_k_x_n_per_mm;
    /* the force along z per displacement along the test's axis, by least squares */
    float loading_k_z_n_per_mm;
    /* the force along x per displacement along the test's axis, by the paper's mean of ratios */
    float loading_ratio_k_x_n_per_mm;
    /* the force along z per displacement along the test's axis, by the paper's mean of ratios */
    float loading_ratio_k_z_n_per_mm;
    /* loading_k_x less the model's, in sigmas of both together */
    float loading_score_x;
    /* loading_k_z less the model's, in sigmas of both together */
    float loading_score_z;
    /* how many ticks came more than two periods late, counted since start */
    uint32_t ticks_late;
    /* how many samples that were refused, not finite or out of range, counted since start */
    uint32_t samples_bad;
    /* how many CAN frames that the bus did not take, counted since start */
    uint32_t frames_refused;
    /* how many CAN frames that came and are of no known kind or form, counted since start */
    uint32_t frames_unknown;
    /* how many Modbus frames that came with a wrong CRC or length, counted since start */
    uint32_t modbus_broken;
    /* how many Modbus requests that were answered with an exception, counted since start */
    uint32_t modbus_refused;
    /* 1 where the coxa joint is fitted and the values that begin with space_ may be used with space_flags, else 0 */
    uint32_t k_is_in_space;
    /* the true angle of the coxa joint; it is 0 where the limb's plane is the x-z plane of the robot's base */
    float theta0_rad;
    /* K in space: the force along x per displacement along x, in the robot's base frame */
    float space_k_xx_n_per_mm;
    /* K in space: the force along x per displacement along y, and the reverse, in the robot's base frame */
    float space_k_xy_n_per_mm;
    /* K in space: the force along x per displacement along z, and the reverse, in the robot's base frame */
    float space_k_xz_n_per_mm;
    /* K in space: the force along y per displacement along y, in the robot's base frame */
    float space_k_yy_n_per_mm;
    /* K in space: the force along y per displacement along z, and the reverse, in the robot's base frame */
    float space_k_yz_n_per_mm;
    /* K in space: the force along z per displacement along z, in the robot's base frame */
    float space_k_zz_n_per_mm;
    /* the smallest eigenvalue of K in space */
    float space_lambda_1_n_per_mm;
    /* the middle eigenvalue of K in space */
    float space_lambda_2_n_per_mm;
    /* the largest eigenvalue of K in space */
    float space_lambda_3_n_per_mm;
    /* the x component of the unit vector along which K in space is largest */
    float space_stiff_axis_x;
    /* the y component of the unit vector along which K in space is largest */
    float space_stiff_axis_y;
    /* the z component of the unit vector along which K in space is largest */
    float space_stiff_axis_z;
    /* the quality of K in space */
    uint32_t space_flags;
    /* the force across the limb's plane per displacement across it */
    float k_across_n_per_mm;
    /* which side of the coxa joint's backlash is loaded */
    uint32_t play_coxa;
    /* the true angle less the motor angle at the coxa joint, as far as its play makes it */
    float play_coxa_offset_rad;
    /* the load that the coxa joint's gap transmits */
    float load_coxa_n_mm;
    /* the motor angle of theta0 */
    float motor_coxa_rad;
    /* the motor torque of theta0 */
    float torque_coxa_n_mm;
    /* space_k_xx once every gap has closed */
    float engaged_space_k_xx_n_per_mm;
    /* space_k_xy once every gap has closed */
    float engaged_space_k_xy_n_per_mm;
    /* space_k_xz once every gap has closed */
    float engaged_space_k_xz_n_per_mm;
    /* space_k_yy once every gap has closed */
    float engaged_space_k_yy_n_per_mm;
    /* space_k_yz once every gap has closed */
    float engaged_space_k_yz_n_per_mm;
    /* space_k_zz once every gap has closed */
    float engaged_space_k_zz_n_per_mm;
    /* space_lambda_1 once every gap has closed */
    float engaged_space_lambda_1_n_per_mm;
    /* space_lambda_2 once every gap has closed */
    float engaged_space_lambda_2_n_per_mm;
    /* space_lambda_3 once every gap has closed */
    float engaged_space_lambda_3_n_per_mm;
    /* what the check of model against measurement is doing */
    uint32_t drift_state;
    /* the likeliest cause of a change of the limb */
    uint32_t drift_cause;
    /* every cause that is nearly as likely as the likeliest */
    uint32_t drift_could_be;
    /* the log likelihood ratio of the likeliest cause against no change; the alarm is at 20 */
    float drift_evidence;
    /* the share of its stiffness that the likeliest cause has lost; it is negative where that part has become
     * stiffer */
    float drift_loss_ratio;
    /* one sigma of drift_loss_ratio */
    float drift_loss_sigma_ratio;
    /* how many readings of loading tests came since the likeliest change began; 65535 means as many or more */
    uint32_t drift_since_readings;
    /* how many readings of loading tests the check has taken in since it began to learn */
    uint32_t drift_readings;
    /* what to do next about a drift */
    uint32_t drift_next_step;
    /* how the last take-up of the coxa joint went; a negative number is sent as 256 plus it */
    uint32_t take_up_coxa;
    /* how the last take-up of the femur joint went; a negative number is sent as 256 plus it */
    uint32_t take_up_femur;
    /* how the last take-up of the tibia joint went; a negative number is sent as 256 plus it */
    uint32_t take_up_tibia;
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
    /* the force of the ground on the tip that K counts across the limb's plane, to the left, of a limb with a coxa
     * joint; not known where no load is counted */
    float counted_force_y_n;
    /* how far force and weight have moved the tip across the limb's plane, to the left */
    float moved_y_mm;
    /* K across the limb's plane with neither the force on the tip nor the weight counted, every gap closed */
    float unloaded_k_across_n_per_mm;
    /* how many requests over CAN found no room in the controller's ring, counted since CAN was set up */
    uint32_t frames_lost;
    /* how many commands a drive refused, counted since start */
    uint32_t commands_failed;
    /* who may move the limb and write to this controller */
    uint32_t setting;
    /* the port of the one whose session is open */
    uint32_t owner;
    /* 1 while what moves the limb stands, because its owner has fallen silent or somebody has stopped it; else 0 */
    uint32_t is_held;
    /* the number that a session is opened with, low half: docs/security.md; all ones where there is none */
    uint32_t challenge_low;
    /* the number that a session is opened with, high half */
    uint32_t challenge_high;
    /* how many commands and life signs came without the key or from somebody who is not the owner, counted since
     * start */
    uint32_t strangers_refused;
    /* how many sealed commands came a second time, and how many life signs came late, counted since start */
    uint32_t replays_refused;
    /* how often an owner fell silent while the limb moved, counted since start */
    uint32_t silences;
    /* how many commits came less than 10 s after the one before, or named another set, counted since start */
    uint32_t commits_refused;
    /* how often a slot of the parameters was erased, counted since start */
    uint32_t erases;
    /* the status of the last command that was refused over any wire (docs/errors.md), in 8 bits; 0 while there was
     * none */
    uint32_t last_refusal;
    /* how many questions were refused as busy, because so many of the same asker waited already, counted since
     * start */
    uint32_t questions_busy;
    /* how many requests over CAN and Modbus TCP found no room, or their answers did not, counted since start */
    uint32_t requests_lost;
    /* one sigma of k_xx, every gap closed; not known while K is not valid, and until it has been worked out */
    float sigma_k_xx_n_per_mm;
    /* one sigma of k_xz, every gap closed; not known while K is not valid, and until it has been worked out */
    float sigma_k_xz_n_per_mm;
    /* one sigma of k_zz, every gap closed; not known while K is not valid, and until it has been worked out */
    float sigma_k_zz_n_per_mm;
    /* one sigma of lambda_min, every gap closed; not known while K is not valid, and until it has been worked out */
    float sigma_lambda_min_n_per_mm;
    /* one sigma of lambda_max, every gap closed; not known while K is not valid, and until it has been worked out */
    float sigma_lambda_max_n_per_mm;
    /* one sigma of stiff_axis, every gap closed */
    float sigma_stiff_axis_rad;
    /* one sigma of space_k_xx; not known of a limb without a coxa joint */
    float sigma_space_k_xx_n_per_mm;
    /* one sigma of space_k_xy; not known of a limb without a coxa joint */
    float sigma_space_k_xy_n_per_mm;
    /* one sigma of space_k_xz; not known of a limb without a coxa joint */
    float sigma_space_k_xz_n_per_mm;
    /* one sigma of space_k_yy; not known of a limb without a coxa joint */
    float sigma_space_k_yy_n_per_mm;
    /* one sigma of space_k_yz; not known of a limb without a coxa joint */
    float sigma_space_k_yz_n_per_mm;
    /* one sigma of space_k_zz; not known of a limb without a coxa joint */
    float sigma_space_k_zz_n_per_mm;
    /* one sigma of space_lambda_1 */
    float sigma_space_lambda_1_n_per_mm;
    /* one sigma of space_lambda_2 */
    float sigma_space_lambda_2_n_per_mm;
    /* one sigma of space_lambda_3 */
    float sigma_space_lambda_3_n_per_mm;
    /* one sigma of k_across */
    float sigma_k_across_n_per_mm;
    /* the sequence number of the set that was stored last; another one than parameter_sequence while
     * OLD_PARAMETERS is there, because that set is not whole any more */
    uint32_t parameter_sequence_wanted;
    /* the controller's number of now, which the next sign of life carries back: docs/security.md */
    uint32_t life_number;
    /* the number that the sign of life carries back with which the motion that was asked for begins; all ones
     * where none waits */
    uint32_t begin_number;
    /* the low end of the interval in which force_x lies with 90 %: by the joints' torques and the friction in
     * their gears, or by the sensor at the tip; of at most eleven ticks before; not known where force_x is not */
    float force_x_low_n;
    /* the high end of the interval in which force_x lies with 90 % */
    float force_x_high_n;
    /* the low end of the interval in which force_z lies with 90 % */
    float force_z_low_n;
    /* the high end of the interval in which force_z lies with 90 % */
    float force_z_high_n;
    /* the low end of the interval in which the force of the ground on the tip across the limb's plane, to the
     * left, lies with 90 %; not known of a limb without a coxa joint */
    float force_y_low_n;
    /* the high end of the interval in which the force across the limb's plane lies with 90 % */
    float force_y_high_n;
    /* the low end of the interval in which the load behind the coxa joint's gear lies with 90 %, by its motor's
     * torque and the friction in its gear; of at most six ticks before */
    float load_coxa_low_n_mm;
    /* the high end of the interval in which the load behind the coxa joint's gear lies with 90 % */
    float load_coxa_high_n_mm;
    /* the low end of the interval in which the load behind the femur joint's gear lies with 90 % */
    float load_femur_low_n_mm;
    /* the high end of the interval in which the load behind the femur joint's gear lies with 90 % */
    float load_femur_high_n_mm;
    /* the low end of the interval in which the load behind the tibia joint's gear lies with 90 % */
    float load_tibia_low_n_mm;
    /* the high end of the interval in which the load behind the tibia joint's gear lies with 90 % */
    float load_tibia_high_n_mm;
} brace_measured_t;

enum { BRACE_MEASURED_COUNT = 159 };
#ifndef __cplusplus
_Static_assert(sizeof(brace_measured_t) == 4 * BRACE_MEASURED_COUNT, "32 bits each");
#endif

/* The answers to what was last asked over Modbus. */
typedef struct {
    /* the k_xx at the posture or tip asked for */
    float asked_k_xx_n_per_mm;
    /* the k_xz at the posture or tip asked for */
    float asked_k_xz_n_per_mm;
    /* the k_zz at the posture or tip asked for */
    float asked_k_zz_n_per_mm;
    /* the lambda_min at the posture or tip asked for */
    float asked_lambda_min_n_per_mm;
    /* the lambda_max at the posture or tip asked for */
    float asked_lambda_max_n_per_mm;
    /* the stiff axis at the posture or tip asked for */
    float asked_stiff_axis_rad;
    /* the quality of that K */
    uint32_t asked_flags;
    /* the force of the ground on the tip along x for the displacement asked for */
    float asked_force_x_n;
    /* the force of the ground on the tip along z for the displacement asked for */
    float asked_force_z_n;
    /* the least force that any displacement of that size gives */
    float asked_force_low_n;
    /* the greatest force that any displacement of that size gives */
    float asked_force_high_n;
    /* how far the tip yields along x to the load asked for */
    float asked_sag_x_mm;
    /* how far the tip yields along z to the load asked for */
    float asked_sag_z_mm;
    /* the force that may be added along the surface asked for before the foot slides */
    float asked_margin_n;
    /* the angle from the force of now to the edge of the friction cone */
    float asked_angle_left_rad;
    /* what the foot does on that surface */
    uint32_t asked_contact;
    /* the k_xx at the posture or tip asked for, under the force asked for */
    float asked_loaded_k_xx_n_per_mm;
    /* the k_xz there */
    float asked_loaded_k_xz_n_per_mm;
    /* the k_zz there */
    float asked_loaded_k_zz_n_per_mm;
    /* the lambda_min there */
    float asked_loaded_lambda_min_n_per_mm;
    /* the lambda_max there */
    float asked_loaded_lambda_max_n_per_mm;
    /* the stiff axis there */
    float asked_loaded_stiff_axis_rad;
    /* how far force and weight move the tip along x there */
    float asked_moved_x_mm;
    /* how far force and weight move the tip along z there */
    float asked_moved_z_mm;
    /* the buckling factor there; infinity where there is none */
    float asked_buckling_factor;
    /* the quality of that K */
    uint32_t asked_loaded_flags;
    /* the direction of down that was taken when another one was asked for */
    float taken_gravity_direction_rad;
    /* its lean out of the limb's plane */
    float taken_gravity_lean_rad;
    /* K in space at the posture asked for, under the force asked for: k_xx */
    float asked_space_k_xx_n_per_mm;
    /* the k_xy of that K in space */
    float asked_space_k_xy_n_per_mm;
    /* the k_xz of that K in space */
    float asked_space_k_xz_n_per_mm;
    /* the k_yy of that K in space */
    float asked_space_k_yy_n_per_mm;
    /* the k_yz of that K in space */
    float asked_space_k_yz_n_per_mm;
    /* the k_zz of that K in space */
    float asked_space_k_zz_n_per_mm;
    /* the smallest eigenvalue of that K in space */
    float asked_space_lambda_1_n_per_mm;
    /* the middle eigenvalue of that K in space */
    float asked_space_lambda_2_n_per_mm;
    /* the largest eigenvalue of that K in space */
    float asked_space_lambda_3_n_per_mm;
    /* the quality of that K in space */
    uint32_t asked_space_flags;
    /* 1, because a question over Modbus has its force */
    uint32_t asked_space_force_is_told;
    /* how far force and weight move the tip outwards in the limb's plane there */
    float asked_space_moved_x_mm;
    /* how far force and weight move the tip across that plane, to the left */
    float asked_space_moved_y_mm;
    /* how far force and weight move the tip upwards in that plane */
    float asked_space_moved_z_mm;
} brace_answered_t;

enum { BRACE_ANSWERED_COUNT = 42 };
#ifndef __cplusplus
_Static_assert(sizeof(brace_answered_t) == 4 * BRACE_ANSWERED_COUNT, "32 bits each");
#endif

/* What was last written to the command registers. */
typedef struct {
    /* the mode that is asked for: 0xc0de0002 asks for CONFIGURATION, 0xc0de0001 for MONITOR; CONFIGURATION ends by
     * itself after 10 s in which nothing was written or stored */
    uint32_t set_mode;
    /* the order to store the holding registers' parameters, read them back and put them in force: write
     * 0xc0de0001, in CONFIGURATION only */
    uint32_t commit;
    /* the order to put the parameter set before this one back in force: write 0xc0de0001, in CONFIGURATION only */
    uint32_t rollback;
    /* the bits of the faults to clear */
    uint32_t clear_faults;
    /* the joint whose play is to be taken up (0 coxa, 1 femur, 2 tibia), plus 256 for the positive side of the
     * play or 512 for the negative one */
    uint32_t take_up;
    /* the order to let every joint go and to end a loading test: write any value */
    uint32_t let_go;
    /* an angle of the posture to know K at; write both in one request */
    float asked_theta1_rad;
    /* an angle of the posture to know K at; write both in one request */
    float asked_theta2_rad;
    /* how far outwards from the hip the tip is to know K at; write tip_x, tip_z and knee in one request */
    float asked_tip_x_mm;
    /* how far above the hip that place of the tip is */
    float asked_tip_z_mm;
    /* how the knee stands at that place of the tip: 0 up, 1 down */
    uint32_t asked_knee;
    /* the displacement of the tip along x to know the contact force of; write both in one request */
    float asked_dx_mm;
    /* the displacement of the tip along z to know the contact force of */
    float asked_dz_mm;
    /* the load on the tip along x to know the sag of; write both in one request */
    float asked_load_x_n;
    /* the load on the tip along z to know the sag of */
    float asked_load_z_n;
    /* the direction of the surface's normal, to know how far the foot is from sliding; write both in one request */
    float asked_normal_rad;
    /* the friction coefficient of that surface */
    float asked_friction;
    /* the direction of down in the limb's plane that is to hold until the next start; write both in one request;
     * NaN for both: that of the parameters again */
    float asked_gravity_direction_rad;
    /* how far down leans out of the limb's plane */
    float asked_gravity_lean_rad;
    /* the force of the ground on the tip along x to know K under; write the two forces and the two angles in one
     * request */
    float asked_posture_force_x_n;
    /* the force of the ground on the tip along z to know K under */
    float asked_posture_force_z_n;
    /* an angle of the posture to know K at under that force; angles are those before the load turns the joints */
    float asked_loaded_theta1_rad;
    /* an angle of the posture to know K at under that force */
    float asked_loaded_theta2_rad;
    /* the force of the ground on the tip along x to know K under; write the two forces, tip_x, tip_z and knee in
     * one request */
    float asked_tip_force_x_n;
    /* the force of the ground on the tip along z to know K under */
    float asked_tip_force_z_n;
    /* how far outwards from the hip the tip is to know K at under that force; where it is before the load moves it */
    float asked_loaded_tip_x_mm;
    /* how far above the hip that place of the tip is */
    float asked_loaded_tip_z_mm;
    /* how the knee stands at that place of the tip: 0 up, 1 down */
    uint32_t asked_loaded_knee;
    /* the force of the ground on the tip, outwards in the limb's plane, to know K in space under; write the three
     * forces and the three angles in one request */
    float asked_space_force_x_n;
    /* the same force across that plane, to the left */
    float asked_space_force_y_n;
    /* the same force upwards in that plane */
    float asked_space_force_z_n;
    /* the coxa joint's angle of the posture to know K in space at; angles are those before the load turns the
     * joints */
    float asked_space_theta0_rad;
    /* the femur's angle of that posture */
    float asked_space_theta1_rad;
    /* the knee's angle of that posture */
    float asked_space_theta2_rad;
    /* the order to hold every set-point where it is: write any value; anybody may */
    uint32_t stop;
    /* the order to store the holding registers' parameters if this is the CRC of the whole set, as parameter_crc
     * shows it once they are in force */
    uint32_t commit_crc;
    /* the life sign of the owner, with life_mac in one request, at least every 100 ms while the limb moves:
     * life_number as it has just been read, or begin_number */
    uint32_t life_heard;
    /* the check of that life sign; on a bench any value. On a guarded board the first one opens a session */
    uint32_t life_mac;
    /* the seal of the next write of this master, with seal_mac in one request: its number, larger than any before */
    uint32_t seal_counter;
    /* the check of that next write */
    uint32_t seal_mac;
    /* the order to end a loading test, or one that stands because it was stopped, and to go back to where it
     * began: write any value */
    uint32_t end_test;
} brace_commands_t;

enum { BRACE_COMMANDS_COUNT = 41 };
#ifndef __cplusplus
_Static_assert(sizeof(brace_commands_t) == 4 * BRACE_COMMANDS_COUNT, "32 bits each");
#endif

#endif
