#include "motion/joints.h"

#include "measure/force.h"

#define ANGLE_ABSURD_RAD 100.0f
#define TORQUE_ABSURD 2.0f /* of the motor's greatest; bias and noise do not add as much again */

/* An encoder that stands while its motor's torque swings by a quarter of its range, or by what friction can hide four
 * times over, is stuck: any position servo gives way by more than an encoder step under that. */
#define STUCK_US 250000u
#define STUCK_SWING_OF_RANGE 0.25f
#define STUCK_SWING_OF_FRICTION 4.0f
#define STUCK_LINK_RAD 0.005f

/* The torque's mean begins as the median of the first three samples and follows what two in a row agree on: a wild one
 * does not move it. Its time is that of a step; where noise hides the step it takes up to twice as long. */
#define TORQUE_MEAN_US 20000.0f
#define SAMPLES_FIRST 3u

/* What is older proves no flank: the state machines' filters know nothing of a longer stretch without a sample. */
#define PROVING_TICKS 4u

static bool is_sound(const brace_hal_joint_t *sample, const brace_drive_t *drive)
{
    return __builtin_fabsf(sample->motor_rad) <= ANGLE_ABSURD_RAD &&
           __builtin_fabsf(sample->torque_n_mm) <= TORQUE_ABSURD * drive->torque_range_n_mm;
}

static void stands_anew(brace_app_joint_t *joint)
{
    joint->still_rad = joint->sample.motor_rad;
    joint->still_us = 0;
    joint->torque_low_n_mm = joint->torque_high_n_mm = joint->torque_n_mm;
    joint->link_low_rad = joint->link_high_rad = joint->sample.link_rad;
    joint->stuck = false;
}

static float lower(float a, float b)
{
    return b < a ? b : a;
}

static float higher(float a, float b)
{
    return b > a ? b : a;
}

static void watch_encoder(brace_app_joint_t *joint, const brace_drive_t *drive, const brace_joint_t *spring,
                          uint32_t tick_us)
{
    if (__builtin_fabsf(joint->sample.motor_rad - joint->still_rad) > 0.5f * drive->angle_step_rad) {
        stands_anew(joint);
        return;
    }
    joint->still_us += joint->still_us < 0x40000000u ? tick_us : 0u;
    joint->torque_low_n_mm = lower(joint->torque_low_n_mm, joint->torque_n_mm);
    joint->torque_high_n_mm = higher(joint->torque_high_n_mm, joint->torque_n_mm);
    const float link_rad = joint->sample.link_rad;
    if (__builtin_fabsf(link_rad) <= ANGLE_ABSURD_RAD) { /* there is an encoder behind the gearbox */
        joint->link_low_rad = lower(joint->link_low_rad, link_rad);
        joint->link_high_rad = higher(joint->link_high_rad, link_rad);
    }
    if (joint->still_us < STUCK_US || joint->stuck) {
        return;
    }
    const float swing = joint->torque_high_n_mm - joint->torque_low_n_mm;
    /* NaN unless it was there from the beginning */
    const float link_swing = joint->link_high_rad - joint->link_low_rad;
    const bool torque_works = swing > STUCK_SWING_OF_RANGE * drive->torque_range_n_mm &&
                              swing > STUCK_SWING_OF_FRICTION * drive->motor_friction_n_mm;
    const bool link_moves =
        link_swing > STUCK_LINK_RAD + spring->gap_rad + swing * spring->compliance_rad_per_n_mm;
    joint->stuck = torque_works || link_moves;
}

/* What two changes have in common: none of different signs, else the smaller. */
static float agreed(float a, float b)
{
    const float smaller = __builtin_fabsf(a) < __builtin_fabsf(b) ? a : b;
    return a * b > 0.0f ? smaller : 0.0f;
}

static void take_sample(brace_app_joint_t *joint, const brace_hal_joint_t *fresh, float share)
{
    const float mean_n_mm = joint->torque_n_mm;
    const float moves_n_mm = agreed(joint->sample.torque_n_mm - mean_n_mm, fresh->torque_n_mm - mean_n_mm);
    joint->sample = *fresh;
    if (joint->seen < SAMPLES_FIRST) {
        joint->torque_n_mm = joint->seen == 0u ? fresh->torque_n_mm : mean_n_mm + moves_n_mm;
        joint->seen++;
        stands_anew(joint);
    } else {
        joint->torque_n_mm = mean_n_mm + share * moves_n_mm;
    }
}

static void read_one(brace_app_t *app, int index, uint32_t now_us)
{
    brace_app_joint_t *joint = &app->joint[index];
    const brace_drive_t *drive = &app->parameters.drive[BRACE_FEMUR + index];
    brace_hal_joint_t fresh;
    const int32_t answer = app->hal->joint_read(app->hal->context, BRACE_FEMUR + index, &fresh);
    const bool none_yet = joint->sample.motor_rad != joint->sample.motor_rad;
    const bool newer = answer == BRACE_HAL_OK && (none_yet || fresh.taken_us != joint->sample.taken_us);
    if (newer && is_sound(&fresh, drive)) {
        take_sample(joint, &fresh, app->torque_share);
    } else if (newer || (answer != BRACE_HAL_OK && answer != BRACE_HAL_AGAIN)) {
        app->counters.samples_bad += app->counters.samples_bad < UINT32_MAX;
    }
    /* one a tick is enough; new or not, or a drive sampled every other tick would have one joint never watched */
    if (joint->seen != 0u && app->joint_of_tick == index) {
        watch_encoder(joint, drive, &app->parameters.limb.joint[BRACE_FEMUR + index], BRACE_APP_JOINTS * app->tick_us);
    }
    /* once too old it stays unseen, or the clock's wrap would make it young again; nor is one from the future young */
    const int32_t age_us = (int32_t)(now_us - joint->sample.taken_us);
    const int32_t limit_us = (int32_t)app->parameters.controller.age_limit_us;
    joint->sound = joint->seen != 0u && age_us <= limit_us && age_us >= -limit_us;
    joint->seen = joint->sound ? joint->seen : 0u;
    joint->proves = joint->sound && age_us <= (int32_t)(PROVING_TICKS * app->tick_us);
}

void joints_configure(brace_app_t *app)
{
    const float tick_us = (float)app->tick_us;
    app->torque_share = tick_us / (TORQUE_MEAN_US + tick_us);
}

void joints_read(brace_app_t *app, uint32_t now_us)
{
    app->joint_of_tick = app->joint_of_tick + 1 < BRACE_APP_JOINTS ? app->joint_of_tick + 1 : 0;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        read_one(app, i, now_us);
    }
}

void joints_play(brace_app_t *app, uint32_t now_us, brace_snapshot_t *snapshot)
{
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        const brace_hal_joint_t *sample = &app->joint[i].sample;
        brace_backlash_out_t *out = &snapshot->play[BRACE_FEMUR + i];
        if (app->play[i].watched) {
            brace_backlash_sample_t seen = {.now_us = now_us, .motor_rad = sample->motor_rad,
                                            .torque_n_mm = sample->torque_n_mm};
            if (!app->joint[i].proves) {
                seen.motor_rad = __builtin_nanf(""); /* the state machine's own way into FAULT, and out of it */
            }
            force_expect(app, i, &seen);
            (void)brace_backlash_tick(&app->play[i].backlash, &seen, out);
        } else {
            *out = (brace_backlash_out_t){.valid = !app->play[i].unwatchable && app->joint[i].sound,
                                          .offset_off_rad = 0.5f * app->parameters.limb.joint[BRACE_FEMUR + i].gap_rad,
                                          .load_n_mm = app->joint[i].torque_n_mm};
        }
    }
}

bool joints_angles(const brace_app_t *app, brace_snapshot_t *snapshot)
{
    bool inside = true;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        const int joint = BRACE_FEMUR + i;
        const brace_drive_t *drive = &app->parameters.drive[joint];
        const float motor_rad = app->joint[i].sample.motor_rad;
        const float theta_rad =
            brace_limb_true_angle(&app->parameters.limb, joint, motor_rad + snapshot->play[joint].offset_rad);
        snapshot->motor_rad[joint] = motor_rad;
        snapshot->torque_n_mm[joint] = app->joint[i].sample.torque_n_mm;
        snapshot->theta_rad[joint] = theta_rad;
        inside = inside && theta_rad >= drive->angle_min_rad && theta_rad <= drive->angle_max_rad;
    }
    return inside;
}
