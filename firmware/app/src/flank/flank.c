#include "flank/flank.h"

#include "brace/play.h"

#define LEAST_GAP_RAD 1e-5f /* below it there is no play to watch */

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

void flank_configure(flank_t *flank, int joint_index, const joints_t *joints, const brace_parameters_t *parameters)
{
    flank_joint_t *ours = &flank->joint[joint_index];
    const brace_drive_t *drive = &parameters->drive[joint_index];
    const brace_joint_t *joint = &parameters->limb.joint[joint_index];
    const brace_backlash_params_t params = {.tick_us = parameters->controller.tick_us,
                                            .gap_rad = joint->gap_rad,
                                            .friction_n_mm = drive->motor_friction_n_mm,
                                            .friction_tolerance_ratio = drive->motor_friction_tolerance_ratio,
                                            .inertia_n_mm_s2_per_rad = drive->motor_inertia_n_mm_s2_per_rad,
                                            .torque_range_n_mm = drive->torque_range_n_mm,
                                            .torque_noise_n_mm = drive->torque_noise_n_mm,
                                            .torque_bias_n_mm = drive->torque_bias_n_mm,
                                            .angle_step_rad = drive->angle_step_rad,
                                            .takeup = takeup_bounds(drive, joint)};
    ours->has_play = joints->joint[joint_index].fitted && joint->gap_rad >= LEAST_GAP_RAD;
    ours->out = (brace_backlash_out_t){.valid = false}; /* what a joint that is not watched leaves as it is */
    ours->watched = ours->has_play && brace_backlash_init(&ours->machine, &params) == BRACE_OK;
}

int flank_expect_load(brace_backlash_sample_t *sample, int index, const tip_force_t *force, const posture_t *posture,
                       brace_vec3_t down, const brace_parameters_t *parameters)
{
    const brace_point_t lever = index == BRACE_FEMUR ? posture->pose.lever_femur : posture->pose.lever_tibia;
    const float expected_n_mm = posture_gravity_n_mm(posture, &parameters->gravity, down, index) +
                                posture_tip_load_n_mm(posture, force->x_n, force->z_n, index);
    const brace_drive_t *drive = &parameters->drive[index];
    const brace_play_joint_t joint = {.coulomb_n_mm = drive->coulomb_n_mm,
                                      .coulomb_per_load_ratio = drive->coulomb_per_load_ratio,
                                      .noise_n = parameters->sensor.noise_n,
                                      .gain_rel = parameters->limb.uncertainty.gain_rel};
    const brace_play_t play =
        brace_play_under_load(&joint, expected_n_mm, __builtin_fabsf(lever.x_mm) + __builtin_fabsf(lever.z_mm));
    sample->load_is_expected = true;
    sample->expected_n_mm = expected_n_mm;
    sample->expected_off_n_mm = play.off_n_mm;
    return play.flank;
}

/* Proven by the motor's torque, or named by the machine and held by the load, where the load is told by the tip's
 * force. Where nobody tells the load, the side that the machine names is assumed. */
static void engage(flank_joint_t *ours, bool is_expected, int held)
{
    const bool is_named = ours->out.flank != 0 && (!is_expected || held == ours->out.flank);
    ours->is_engaged = ours->out.valid || is_named;
    ours->is_assumed = is_named && !ours->out.valid;
}

void flank_tick(flank_t *flank, const joints_t *joints, const tip_force_t *force, const posture_t *posture,
                brace_vec3_t down, const brace_parameters_t *parameters, bool stands, uint32_t now_us)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const joint_t *joint = &joints->joint[i];
        flank_joint_t *ours = &flank->joint[i];
        ours->is_engaged = ours->is_assumed = false;
        if (!joint->fitted) {
            ours->out.valid = false;
        } else if (!ours->watched) {
            ours->out.valid = !ours->has_play && joint->sound;
            ours->out.offset_off_rad = 0.5f * parameters->limb.joint[i].gap_rad;
            ours->out.load_n_mm = joint->torque_n_mm;
        } else {
            brace_backlash_sample_t sample = {.now_us = now_us,
                                              .motor_rad = joint->sample.motor_rad,
                                              .torque_n_mm = joint->sample.torque_n_mm,
                                              .load_is_expected = false,
                                              .expected_n_mm = 0.0f,
                                              .expected_off_n_mm = 0.0f,
                                              .stands = stands};
            if (!joint->is_new_enough_to_prove_a_flank) {
                sample.motor_rad = __builtin_nanf(""); /* the machine goes to FAULT, and comes back by itself */
            }
            /* A take-up proves its flank by the load itself. The force across the plane is not sensed. */
            const bool is_expected = i != BRACE_COXA && force->known && posture->has_levers &&
                                     ours->machine.phase == BRACE_TAKEUP_IDLE;
            const int held =
                is_expected ? flank_expect_load(&sample, i, force, posture, down, parameters) : 0;
            (void)brace_backlash_tick(&ours->machine, &sample, &ours->out);
            engage(ours, is_expected, held);
        }
    }
}

float flank_lag_n_mm(const flank_t *flank, const joints_t *joints, int index)
{
    const joint_t *joint = &joints->joint[index];
    const flank_joint_t *ours = &flank->joint[index];
    /* For a watched joint, load_n_mm has friction subtracted. The mean torque itself is in its machine. */
    const float mean_n_mm = ours->watched ? ours->machine.torque_n_mm : joint->torque_n_mm;
    float squares_n2_mm2 = 0.0f;
    for (int i = 0; i < JOINTS_CARRIED; i++) {
        const float off_n_mm = joint->carries_n_mm[i] - mean_n_mm;
        squares_n2_mm2 += off_n_mm * off_n_mm;
    }
    return __builtin_copysignf(__builtin_sqrtf(squares_n2_mm2 / (float)JOINTS_CARRIED),
                               joint->carries_n_mm[0] - mean_n_mm);
}

uint32_t flank_open_gaps(const flank_t *flank)
{
    uint32_t open = 0;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const flank_joint_t *ours = &flank->joint[i];
        open |= ours->has_play && !ours->is_engaged ? 1u << i : 0u;
    }
    return open;
}

uint32_t flank_assumed(const flank_t *flank)
{
    uint32_t assumed = 0;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        assumed |= flank->joint[i].is_assumed ? 1u << i : 0u;
    }
    return assumed;
}
