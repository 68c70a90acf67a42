#include "plant.h"

#include <math.h>
#include <string.h>

enum { TICK_US = 1000 };
#define PI 3.14159265358979323846

uint32_t lot_bits(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    const uint32_t word = ((*state >> ((*state >> 28) + 4u)) ^ *state) * 277803737u;
    return (word >> 22) ^ word;
}

double lot_between(uint32_t *state, double low, double high)
{
    return low + (high - low) * (lot_bits(state) / 4294967296.0);
}

static double log_between(uint32_t *state, double low, double high)
{
    return exp(lot_between(state, log(low), log(high)));
}

/* Noise of one sensor in one tick: the same whoever asks, of variance 1. */
static double noise(const plant_t *plant, int32_t tick, uint32_t sensor)
{
    uint32_t state = plant->seed * 2654435761u ^ (uint32_t)tick * 40503u ^ sensor * 97u;
    (void)lot_bits(&state);
    double sum = 0.0;
    for (int i = 0; i < 12; i++) {
        sum += lot_bits(&state) / 4294967296.0;
    }
    return sum - 6.0;
}

static void draw_limb(brace_parameters_t *p, uint32_t *lots)
{
    brace_parameters_default(p);
    brace_limb_t *limb = &p->limb;
    const double femur_mm = (double)limb->femur_mm, tibia_mm = (double)limb->tibia_mm;
    limb->femur_mm = (float)log_between(lots, 60.0, 350.0);
    limb->tibia_mm = (float)((double)limb->femur_mm * lot_between(lots, 0.8, 1.8));
    limb->link[BRACE_FEMUR].bending_mm_per_n *= (float)pow((double)limb->femur_mm / femur_mm, 3.0);
    limb->link[BRACE_TIBIA].bending_mm_per_n *= (float)pow((double)limb->tibia_mm / tibia_mm, 3.0);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb->joint[i] = (brace_joint_t){.compliance_rad_per_n_mm = (float)log_between(lots, 2e-6, 3e-5),
                                         .zero_offset_rad = (float)lot_between(lots, -0.05, 0.05)};
        brace_drive_t *drive = &p->drive[i];
        drive->torque_range_n_mm = (float)log_between(lots, 4000.0, 20000.0);
        drive->torque_noise_n_mm = (float)((double)drive->torque_range_n_mm * log_between(lots, 0.002, 0.02));
        drive->torque_bias_n_mm = (float)((double)drive->torque_range_n_mm * lot_between(lots, 0.0, 0.01));
        drive->motor_friction_n_mm = (float)((double)drive->torque_range_n_mm * lot_between(lots, 0.002, 0.02));
        drive->motor_friction_tolerance_ratio = 0.5f;
        drive->takeup_torque_n_mm = 0.5f * drive->torque_range_n_mm;
        drive->angle_step_rad = (float)(2.0 * PI / (double)(1u << (12u + lot_bits(lots) % 9u)));
    }
    limb->uncertainty = (brace_uncertainty_t){.length_mm = (float)lot_between(lots, 0.1, 0.5),
                                              .angle_rad = (float)lot_between(lots, 0.002, 0.005),
                                              .compliance_rel = (float)lot_between(lots, 0.01, 0.05),
                                              .gain_rel = (float)lot_between(lots, 0.0, 0.02)};
    p->gravity.femur_n = (float)lot_between(lots, 0.0, 2.0);
    p->gravity.tibia_n = (float)lot_between(lots, 0.0, 1.0);
    p->gravity.knee_n = (float)lot_between(lots, 0.0, 2.0);
    p->sensor.noise_n = (float)lot_between(lots, 0.01, 0.1);
    p->sensor.saturation_n = 60.0f;
    p->controller.tick_us = TICK_US;
}

void plant_draw(plant_t *plant, uint32_t seed, phase_t phase)
{
    uint32_t lots = seed * 2246822519u + 3266489917u;
    (void)lot_bits(&lots);
    memset(plant, 0, sizeof *plant);
    plant->seed = seed;
    plant->phase = phase;
    draw_limb(&plant->parameters, &lots);
    plant->has_coxa = lot_bits(&lots) % 4u == 0u;
    plant->has_link_encoders = lot_bits(&lots) % 2u == 0u;
    plant->has_force = lot_bits(&lots) % 2u == 0u;
    plant->has_temperature = lot_bits(&lots) % 2u == 0u;
    plant->degc = lot_between(&lots, 10.0, 60.0);
    if (plant->has_temperature) {
        plant->parameters.slow.joint_compliance_per_degc = (float)lot_between(&lots, -0.002, 0.006);
    }
    plant->start_rad[BRACE_COXA] = lot_between(&lots, -0.8, 0.8);
    plant->start_rad[BRACE_FEMUR] = lot_between(&lots, 0.1, 1.2);
    plant->start_rad[BRACE_TIBIA] = lot_between(&lots, 0.6, 2.2);
    for (int i = 0; i < BRACE_LINK_COUNT && phase == PHASE_MOVES; i++) {
        plant->swing_rad[i] = lot_between(&lots, 0.05, 0.4);
    }
    plant->swing_hz = log_between(&lots, 0.2, 1.5);
    const double force_n = phase == PHASE_RESTS ? 0.0 : lot_between(&lots, 0.5, 6.0);
    const double direction_rad = lot_between(&lots, 0.25 * PI, 0.75 * PI);
    plant->force_n[0] = force_n * cos(direction_rad);
    plant->force_n[1] = force_n * sin(direction_rad);
    plant->force_swing_ratio = phase == PHASE_PRESSED ? lot_between(&lots, 0.0, 0.3) : 0.0;
    plant->force_hz = log_between(&lots, 0.2, 2.0);
}

/* Torques that the motors of femur and tibia joint carry at these true angles, each in its own sense. */
static void carry(const plant_t *plant, const double theta_rad[BRACE_LINK_COUNT], const double force_n[2],
                  double torque_n_mm[BRACE_LINK_COUNT])
{
    const brace_parameters_t *p = &plant->parameters;
    const double shank_rad = theta_rad[BRACE_FEMUR] - theta_rad[BRACE_TIBIA];
    const double femur_mm = p->limb.femur_mm, tibia_mm = p->limb.tibia_mm;
    const double knee_x = femur_mm * cos(theta_rad[BRACE_FEMUR]), knee_z = femur_mm * sin(theta_rad[BRACE_FEMUR]);
    const double shank_x = tibia_mm * cos(shank_rad), shank_z = tibia_mm * sin(shank_rad);
    const double tip_x = knee_x + shank_x, tip_z = knee_z + shank_z;
    const double about_femur = tip_x * force_n[1] - tip_z * force_n[0];
    const double about_knee = shank_x * force_n[1] - shank_z * force_n[0];
    const double weigh_femur = 0.5 * knee_x * (double)p->gravity.femur_n + knee_x * (double)p->gravity.knee_n +
                               (knee_x + 0.5 * shank_x) * (double)p->gravity.tibia_n;
    const double weigh_knee = 0.5 * shank_x * (double)p->gravity.tibia_n;
    torque_n_mm[BRACE_COXA] = 0.0;
    torque_n_mm[BRACE_FEMUR] = weigh_femur - about_femur;
    torque_n_mm[BRACE_TIBIA] = about_knee - weigh_knee;
}

void plant_sense(const plant_t *plant, int32_t tick, uint32_t taken_us, sensors_t *sensors)
{
    const brace_parameters_t *p = &plant->parameters;
    const double time_s = 1e-6 * TICK_US * tick;
    const double share = 1.0 + plant->force_swing_ratio * sin(2.0 * PI * plant->force_hz * time_s);
    const double force_n[2] = {plant->force_n[0] * share, plant->force_n[1] * share};
    double motor_rad[BRACE_LINK_COUNT], theta_rad[BRACE_LINK_COUNT], torque_n_mm[BRACE_LINK_COUNT] = {0.0};
    const double warmer_degc = plant->degc - (double)p->slow.reference_degc;
    const double warmer = 1.0 + (double)p->slow.joint_compliance_per_degc * warmer_degc;
    for (int round = 0; round < 4; round++) { /* springs are stiff: the statics settle at once */
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            motor_rad[i] = plant->start_rad[i] + plant->swing_rad[i] * sin(2.0 * PI * plant->swing_hz * time_s);
            theta_rad[i] = motor_rad[i] + (double)p->limb.joint[i].zero_offset_rad -
                           warmer * (double)p->limb.joint[i].compliance_rad_per_n_mm * torque_n_mm[i];
        }
        carry(plant, theta_rad, force_n, torque_n_mm);
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const double step_rad = (double)p->drive[i].angle_step_rad;
        const double bias_n_mm = 0.5 * (double)p->drive[i].torque_bias_n_mm * (i == BRACE_FEMUR ? 1.0 : -1.0);
        brace_hal_joint_t *joint = &sensors->joint[i];
        joint->motor_rad = (float)(step_rad * rint(motor_rad[i] / step_rad));
        joint->link_rad = plant->has_link_encoders ? (float)(step_rad * rint(theta_rad[i] / step_rad)) : NAN;
        joint->torque_n_mm = (float)(torque_n_mm[i] + bias_n_mm +
                                     (double)p->drive[i].torque_noise_n_mm * noise(plant, tick, (uint32_t)i));
        const double degc = plant->degc + 0.2 * noise(plant, tick, 8u + (uint32_t)i);
        joint->temp_degc = plant->has_temperature ? (float)degc : NAN;
        joint->taken_us = taken_us;
        sensors->joint_answer[i] = BRACE_HAL_OK;
    }
    sensors->joint_answer[BRACE_COXA] = plant->has_coxa ? BRACE_HAL_OK : BRACE_HAL_E_UNSUPPORTED;
    sensors->force_x_n = (float)(force_n[0] + (double)p->sensor.noise_n * noise(plant, tick, 16u));
    sensors->force_z_n = (float)(force_n[1] + (double)p->sensor.noise_n * noise(plant, tick, 17u));
    sensors->force_answer = BRACE_HAL_OK;
}
