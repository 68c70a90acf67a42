#include "brace/play_parameters.h"

#define TAKEUP_RATE_RAD_PER_S 0.1f
#define TAKEUP_TIME_US 8000000u
#define TAKEUP_VERIFY_US 100000u
#define TAKEUP_SPARE_RAD 0.004f
#define TAKEUP_TRAVEL_MOST_RAD 1.0f
#define TAKEUP_DROOP_RAD 0.2f /* by which a soft servo gives way at the take-up's torque */

/* The take-up may travel the gap and three tenths of it more, and what the joint's spring gives way by. */
static brace_takeup_bounds_t takeup_bounds(const brace_drive_t *drive, const brace_joint_t *joint)
{
    const float yields_rad = drive->takeup_torque_n_mm * joint->compliance_rad_per_n_mm;
    const float wanted_rad = 1.3f * joint->gap_rad + yields_rad + TAKEUP_SPARE_RAD;
    const float travel_rad = wanted_rad < TAKEUP_TRAVEL_MOST_RAD ? wanted_rad : TAKEUP_TRAVEL_MOST_RAD;
    return (brace_takeup_bounds_t){.torque_max_n_mm = drive->takeup_torque_n_mm,
                                   .travel_max_rad = travel_rad,
                                   .reach_max_rad = travel_rad + TAKEUP_DROOP_RAD,
                                   .rate_rad_per_s = TAKEUP_RATE_RAD_PER_S,
                                   .time_max_us = TAKEUP_TIME_US,
                                   .verify_us = TAKEUP_VERIFY_US};
}

brace_backlash_params_t brace_play_watched(const brace_parameters_t *parameters, int joint_index)
{
    const brace_drive_t *drive = &parameters->drive[joint_index];
    const brace_joint_t *joint = &parameters->limb.joint[joint_index];
    return (brace_backlash_params_t){.tick_us = parameters->controller.tick_us,
                                     .gap_rad = joint->gap_rad,
                                     .friction_n_mm = drive->motor_friction_n_mm,
                                     .friction_tolerance_ratio = drive->motor_friction_tolerance_ratio,
                                     .inertia_n_mm_s2_per_rad = drive->motor_inertia_n_mm_s2_per_rad,
                                     .torque_range_n_mm = drive->torque_range_n_mm,
                                     .torque_noise_n_mm = drive->torque_noise_n_mm,
                                     .torque_bias_n_mm = drive->torque_bias_n_mm,
                                     .angle_step_rad = drive->angle_step_rad,
                                     .takeup = takeup_bounds(drive, joint)};
}

brace_play_joint_t brace_play_joint(const brace_parameters_t *parameters, int joint_index)
{
    const brace_drive_t *drive = &parameters->drive[joint_index];
    return (brace_play_joint_t){.coulomb_n_mm = drive->coulomb_n_mm,
                                .coulomb_per_load_ratio = drive->coulomb_per_load_ratio,
                                .noise_n = parameters->sensor.noise_n,
                                .gain_rel = parameters->limb.uncertainty.gain_rel};
}

brace_gear_t brace_gear(const brace_parameters_t *parameters, int joint_index)
{
    const brace_drive_t *drive = &parameters->drive[joint_index];
    return (brace_gear_t){.friction_n_mm = drive->motor_friction_n_mm,
                          .per_torque_ratio = drive->motor_friction_per_torque_ratio,
                          .per_load_ratio = drive->motor_friction_per_load_ratio,
                          .tolerance_ratio = drive->motor_friction_tolerance_ratio,
                          .sliding_ratio = drive->motor_friction_sliding_ratio,
                          .joint_n_mm = drive->coulomb_n_mm,
                          .joint_per_load_ratio = drive->coulomb_per_load_ratio};
}
