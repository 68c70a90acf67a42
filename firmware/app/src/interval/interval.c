#include "interval/interval.h"

#include "brace/play_parameters.h"

/* Half of the play operator's width: coarse encoders flicker by a step. */
#define STEPS 1.5f
#define LEAST_RAD 2e-4f
#define BEHIND_RATIO 0.9f /* where the anchor is put: a joint that stands is not moved by rounding */

/* A joint whose anchor has stood for so long stands: slower than an encoder's step in this time it creeps, and creeping
 * friction is that of standing. */
#define STANDS_US 40000u
#define STILL_MOST_US 0x40000000u

#define TORQUE_MEAN_US 20000.0f /* as sense/joints.c takes the torque's mean */

enum { PART_X = BRACE_LINK_COUNT, PART_Z, PART_Y, PARTS };

static const brace_load_band_t nothing = {0.0f, 0.0f, 0.0f, 0.0f};

static brace_interval_t unknown(void)
{
    return (brace_interval_t){__builtin_nanf(""), __builtin_nanf("")};
}

void interval_start(interval_t *interval)
{
    *interval = (interval_t){.x_n = unknown(), .y_n = unknown(), .z_n = unknown()};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        interval->turn[i].anchor_rad = interval->band[i].middle_n_mm = __builtin_nanf("");
        interval->load_n_mm[i] = unknown();
    }
}

static void follow(interval_turn_t *turn, float angle_rad, float step_rad, uint32_t passed_us)
{
    const float slack_rad = STEPS * step_rad + LEAST_RAD, moved_rad = angle_rad - turn->anchor_rad;
    if (!(turn->anchor_rad == turn->anchor_rad)) {
        turn->anchor_rad = angle_rad;
        turn->still_us = STANDS_US;
    } else if (__builtin_fabsf(moved_rad) > slack_rad) {
        turn->way = moved_rad > 0.0f ? 1.0f : -1.0f;
        turn->anchor_rad = angle_rad - turn->way * BEHIND_RATIO * slack_rad;
        turn->still_us = 0;
    } else if (turn->still_us < STILL_MOST_US) {
        turn->still_us += passed_us;
    }
}

/* The variance of the noise in a joint's load. It sums the noise of the torque's mean, the mean's lag beyond what noise
 * explains, the torque's bias, and the uncertainty of the torque by current. */
static float variance_n2_mm2(const interval_inputs_t *inputs, int index, float middle_n_mm)
{
    const brace_drive_t *drive = &inputs->parameters->drive[index];
    const float tick_us = (float)inputs->parameters->controller.tick_us;
    const float noise2 = drive->torque_noise_n_mm * drive->torque_noise_n_mm;
    const float lag_n_mm = flank_lag_n_mm(inputs->flank, inputs->joints, index);
    const float lags = lag_n_mm * lag_n_mm - 2.0f * noise2, gain_n_mm = drive->torque_gain_rel * middle_n_mm;
    return noise2 * tick_us / (2.0f * TORQUE_MEAN_US + tick_us) + (lags > 0.0f ? lags : 0.0f) +
           0.333f * drive->torque_bias_n_mm * drive->torque_bias_n_mm + gain_n_mm * gain_n_mm;
}

static void take_joint(interval_t *interval, const interval_inputs_t *inputs, int index)
{
    const joint_t *joint = &inputs->joints->joint[index];
    const flank_joint_t *flank = &inputs->flank->joint[index];
    interval_turn_t *turn = &interval->turn[index];
    brace_load_band_t *band = &interval->band[index];
    if (!joint->sound) {
        turn->anchor_rad = band->middle_n_mm = __builtin_nanf("");
        turn->way = 0.0f;
        interval->load_n_mm[index] = unknown();
        return;
    }
    const brace_gear_t gear = brace_gear(inputs->parameters, index);
    follow(turn, joint->sample.motor_rad, inputs->parameters->drive[index].angle_step_rad,
           (uint32_t)PARTS * inputs->parameters->controller.tick_us);
    brace_load_band(&gear, flank->watched ? flank->machine.torque_n_mm : joint->torque_n_mm, turn->way,
                    turn->still_us < STANDS_US, band);
    band->noise_n_mm = __builtin_sqrtf(variance_n2_mm2(inputs, index, band->middle_n_mm));
    interval->load_n_mm[index] = brace_load_band_alone(band);
}

static brace_interval_t sensed(const interval_inputs_t *inputs, float force_n)
{
    const float noise_n = inputs->parameters->sensor.noise_n;
    const float gain_n = inputs->parameters->limb.uncertainty.gain_rel * force_n;
    const float off_n = BRACE_NORMAL_90_SIGMAS * __builtin_sqrtf(noise_n * noise_n + gain_n * gain_n);
    return (brace_interval_t){force_n - off_n, force_n + off_n};
}

/* The area that the levers of femur and tibia joint span: a joint's load moves the force by the other's lever over
 * it. */
static float spanned_mm2(const brace_pose_t *pose)
{
    return pose->lever_femur.x_mm * pose->lever_tibia.z_mm - pose->lever_femur.z_mm * pose->lever_tibia.x_mm;
}

static void take_x(interval_t *interval, const interval_inputs_t *inputs)
{
    const posture_t *posture = inputs->posture;
    const brace_load_band_t *femur = &interval->band[BRACE_FEMUR], *tibia = &interval->band[BRACE_TIBIA];
    if (inputs->is_sensed) {
        interval->x_n = sensed(inputs, inputs->force->x_n);
        return;
    }
    float x_n;
    posture_force_of_loads(posture, inputs->parameters, inputs->down, femur->middle_n_mm, tibia->middle_n_mm, &x_n,
                           &interval->z_middle_n);
    const float per_mm2 = 1.0f / spanned_mm2(&posture->pose);
    interval->x_n = brace_load_band_sum(femur, -posture->pose.lever_tibia.z_mm * per_mm2, tibia,
                                        -posture->pose.lever_femur.z_mm * per_mm2, x_n);
}

static void take_z(interval_t *interval, const interval_inputs_t *inputs)
{
    const brace_pose_t *pose = &inputs->posture->pose;
    const float per_mm2 = 1.0f / spanned_mm2(pose);
    interval->z_n =
        inputs->is_sensed
            ? sensed(inputs, inputs->force->z_n)
            : brace_load_band_sum(&interval->band[BRACE_FEMUR], pose->lever_tibia.x_mm * per_mm2,
                                  &interval->band[BRACE_TIBIA], pose->lever_femur.x_mm * per_mm2, interval->z_middle_n);
}

/* Across the plane only the coxa joint measures. What the force outwards turns a tip that stands aside is left out. */
static void take_y(interval_t *interval, const interval_inputs_t *inputs)
{
    const brace_load_band_t *coxa = &interval->band[BRACE_COXA];
    if (!inputs->joints->joint[BRACE_COXA].sound) {
        interval->y_n = unknown();
        return;
    }
    float x_n = 0.5f * (interval->x_n.low + interval->x_n.high);
    const float y_n = posture_force_across_n(inputs->posture, inputs->parameters, inputs->down, coxa->middle_n_mm,
                                             !inputs->is_sensed, &x_n);
    const float lever_mm = inputs->parameters->limb.coxa_mm + inputs->posture->pose.tip.x_mm;
    interval->y_n = brace_load_band_sum(coxa, -1.0f / lever_mm, &nothing, 0.0f, y_n);
}

void interval_step(interval_t *interval, const interval_inputs_t *inputs)
{
    switch (interval->part) {
    case PART_X: take_x(interval, inputs); break;
    case PART_Z: take_z(interval, inputs); break;
    case PART_Y: take_y(interval, inputs); break;
    default: take_joint(interval, inputs, interval->part); break;
    }
    interval->part = (uint8_t)((interval->part + 1u) % (uint32_t)PARTS);
}
