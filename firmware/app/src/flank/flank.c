#include "flank/flank.h"

#include "brace/play_parameters.h"

void flank_configure(flank_t *flank, int joint_index, const joints_t *joints, const brace_parameters_t *parameters)
{
    flank_joint_t *ours = &flank->joint[joint_index];
    const brace_backlash_params_t params = brace_play_watched(parameters, joint_index);
    ours->has_play = joints->joint[joint_index].fitted && params.gap_rad >= BRACE_BACKLASH_LEAST_GAP_RAD;
    ours->out = (brace_backlash_out_t){.valid = false}; /* what a joint that is not watched leaves as it is */
    ours->watched = ours->has_play && brace_backlash_init(&ours->machine, &params) == BRACE_OK;
}

int flank_expect_load(brace_backlash_sample_t *sample, int index, const tip_force_t *force, const posture_t *posture,
                      brace_vec3_t down, const brace_parameters_t *parameters)
{
    const brace_point_t lever = index == BRACE_FEMUR ? posture->pose.lever_femur : posture->pose.lever_tibia;
    const float expected_n_mm = posture_gravity_n_mm(posture, &parameters->gravity, down, index) +
                                posture_tip_load_n_mm(posture, force->x_n, force->z_n, index);
    const brace_play_joint_t joint = brace_play_joint(parameters, index);
    const brace_play_t play =
        brace_play_under_load(&joint, expected_n_mm, __builtin_fabsf(lever.x_mm) + __builtin_fabsf(lever.z_mm));
    sample->load_is_expected = true;
    sample->expected_n_mm = expected_n_mm;
    sample->expected_off_n_mm = play.off_n_mm;
    return play.flank;
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
            const bool is_expected =
                i != BRACE_COXA && force->known && posture->has_levers && ours->machine.phase == BRACE_TAKEUP_IDLE;
            const int held = is_expected ? flank_expect_load(&sample, i, force, posture, down, parameters) : 0;
            (void)brace_backlash_tick(&ours->machine, &sample, &ours->out);
            const brace_engagement_t engagement =
                brace_play_engagement(ours->out.flank, ours->out.valid, is_expected, held);
            ours->is_engaged = engagement.is_engaged;
            ours->is_assumed = engagement.is_assumed;
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
