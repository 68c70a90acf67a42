/* The preload state machine on the record of a joint on the bench: what it says to every sample. */
#include "brace/backlash.h"

typedef struct {
    double tick_us, gap_rad, friction_n_mm, friction_tolerance_ratio;
    double torque_range_n_mm, torque_noise_n_mm, torque_bias_n_mm, angle_step_rad;
} measured_joint_t;

typedef struct {
    double flank, valid, offset_rad;
} said_t;

/* Gives the time in which an open gap has to be noticed [us], or a negative status. The motor goes slowly: its inertia
 * is left out. */
int backlash_measured(const measured_joint_t *joint, int count, const double *motor_rad, const double *torque_n_mm,
                      said_t *said)
{
    const float torque_max_n_mm = (float)joint->torque_range_n_mm;
    const brace_backlash_params_t params = {
        .tick_us = (uint32_t)joint->tick_us,
        .gap_rad = (float)joint->gap_rad,
        .friction_n_mm = (float)joint->friction_n_mm,
        .friction_tolerance_ratio = (float)joint->friction_tolerance_ratio,
        .torque_range_n_mm = (float)joint->torque_range_n_mm,
        .torque_noise_n_mm = (float)joint->torque_noise_n_mm,
        .torque_bias_n_mm = (float)joint->torque_bias_n_mm,
        .angle_step_rad = (float)joint->angle_step_rad,
        .takeup = {.torque_max_n_mm = torque_max_n_mm, /* none is asked for */
                   .travel_max_rad = 1.0f,
                   .reach_max_rad = 1.0f,
                   .rate_rad_per_s = 0.1f,
                   .time_max_us = 1000000,
                   .verify_us = 100000},
    };
    brace_backlash_t machine;
    brace_status_t status = brace_backlash_init(&machine, &params);
    for (int i = 0; i < count && status == BRACE_OK; i++) {
        const brace_backlash_sample_t sample = {.now_us = (uint32_t)i * params.tick_us,
                                                .motor_rad = (float)motor_rad[i],
                                                .torque_n_mm = (float)torque_n_mm[i]};
        brace_backlash_out_t out;
        status = brace_backlash_tick(&machine, &sample, &out);
        said[i] = (said_t){out.flank, out.valid, (double)out.offset_rad};
    }
    return status == BRACE_OK ? (int)brace_backlash_detection_us(&machine) : status;
}
