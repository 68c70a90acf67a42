#include "sense/joints.h"

#define ANGLE_ABSURD_RAD 100.0f
#define SPEED_MOST_RAD_PER_US 50e-6f /* no joint of a limb turns so fast: ten times a servo without load */
#define REACH_MARGIN_RAD 0.01f       /* of steps and jitter */
#define TORQUE_ABSURD 2.0f /* of the motor's greatest; bias and noise never add as much again */

/* The torque's mean begins as the median of the first three samples. Afterwards it follows only what two samples in a
 * row agree on, so that a single wild sample does not move it. */
#define TORQUE_MEAN_US 20000.0f
#define SAMPLES_FIRST 3u

#define US2_PER_S2 1e12f

/* The backlash machine's filters bear a stretch of four ticks without a sample. */
#define PROVING_TICKS 4u

static bool is_sound(const brace_hal_joint_t *sample, const brace_drive_t *drive)
{
    return __builtin_fabsf(sample->motor_rad) <= ANGLE_ABSURD_RAD &&
           __builtin_fabsf(sample->torque_n_mm) <= TORQUE_ABSURD * drive->torque_range_n_mm;
}

/* What an encoder behind the gearbox says; NaN: there is none, or it is absurd. */
static float link_angle_rad(const brace_hal_joint_t *sample)
{
    return __builtin_fabsf(sample->link_rad) <= ANGLE_ABSURD_RAD ? sample->link_rad : __builtin_nanf("");
}

/* Can a joint have moved from one sample's angles to the other's? What is NaN, or a link's angle that is absurd, says
 * nothing. */
static bool can_reach(const brace_hal_joint_t *from, const brace_hal_joint_t *to)
{
    const float motor_moved_rad = __builtin_fabsf(to->motor_rad - from->motor_rad);
    const float link_moved_rad = __builtin_fabsf(to->link_rad - from->link_rad);
    if (motor_moved_rad <= REACH_MARGIN_RAD && !(link_moved_rad > REACH_MARGIN_RAD)) {
        return true;
    }
    const float most_rad = REACH_MARGIN_RAD + SPEED_MOST_RAD_PER_US * (float)(to->taken_us - from->taken_us);
    return !(motor_moved_rad > most_rad ||
             (link_moved_rad > most_rad && link_moved_rad <= ANGLE_ABSURD_RAD));
}

/* Is the sample where the joint can be? One that is not is kept: if the next one agrees with it, the joint is there. */
static bool is_within_reach(joint_t *joint, const brace_hal_joint_t *fresh)
{
    if (joint->samples_seen == 0u || can_reach(&joint->sample, fresh)) {
        joint->has_wild = false;
        return true;
    }
    const bool is_there = joint->has_wild && can_reach(&joint->wild, fresh);
    joint->has_wild = !is_there;
    joint->wild = *fresh;
    return is_there;
}

/* What two changes agree on: nothing when their signs differ, else the smaller. */
static float agreed(float a, float b)
{
    const float smaller = __builtin_fabsf(a) < __builtin_fabsf(b) ? a : b;
    return a * b > 0.0f ? smaller : 0.0f;
}

/* What accelerates the motor. An encoder behind the gear does not tell how it moves. */
static float inertial_n_mm(const joint_t *joint, float faster_rad_per_us, float per_us, const brace_drive_t *drive)
{
    if (joint->is_link_only) {
        return 0.0f;
    }
    return joint->samples_seen < SAMPLES_FIRST - 1u
               ? __builtin_nanf("")
               : US2_PER_S2 * drive->motor_inertia_n_mm_s2_per_rad * per_us * faster_rad_per_us;
}

static void take_carried(joint_t *joint, const brace_hal_joint_t *fresh, const brace_drive_t *drive)
{
    const float per_us = 1.0f / (float)(fresh->taken_us - joint->sample.taken_us);
    const float speed_rad_per_us = (fresh->motor_rad - joint->sample.motor_rad) * per_us;
    for (int i = JOINTS_CARRIED - 1; i > 0; i--) {
        joint->carries_n_mm[i] = joint->carries_n_mm[i - 1];
    }
    joint->carries_n_mm[0] =
        fresh->torque_n_mm - inertial_n_mm(joint, speed_rad_per_us - joint->speed_rad_per_us, per_us, drive);
    joint->speed_rad_per_us = speed_rad_per_us;
}

static void take_sample(joint_t *joint, const brace_hal_joint_t *fresh, const brace_drive_t *drive, uint32_t tick_us)
{
    take_carried(joint, fresh, drive);
    const float mean_n_mm = joint->torque_n_mm;
    const float moves_n_mm = agreed(joint->sample.torque_n_mm - mean_n_mm, fresh->torque_n_mm - mean_n_mm);
    joint->sample = *fresh;
    if (joint->samples_seen < SAMPLES_FIRST) {
        joint->torque_n_mm = joint->samples_seen == 0u ? fresh->torque_n_mm : mean_n_mm + moves_n_mm;
        joint->samples_seen++;
    } else {
        const float share = (float)tick_us / (TORQUE_MEAN_US + (float)tick_us);
        joint->torque_n_mm = mean_n_mm + share * moves_n_mm;
    }
}

static void read_one(joints_t *joints, int index, const brace_hal_t *hal, const brace_parameters_t *parameters,
                     uint32_t now_us, uint32_t *samples_bad)
{
    const uint32_t tick_us = parameters->controller.tick_us;
    joint_t *joint = &joints->joint[index];
    const brace_drive_t *drive = &parameters->drive[index];
    brace_hal_joint_t fresh;
    const int32_t answer = hal->joint_read(hal->context, index, &fresh);
    const bool none_yet = joint->sample.motor_rad != joint->sample.motor_rad;
    const bool newer = answer == BRACE_HAL_OK && (none_yet || fresh.taken_us != joint->sample.taken_us);
    const bool is_link_only = newer && fresh.motor_rad != fresh.motor_rad;
    if (is_link_only) {
        fresh.motor_rad = fresh.link_rad;
    }
    if (newer && is_sound(&fresh, drive) && is_within_reach(joint, &fresh)) {
        joint->is_link_only = is_link_only;
        take_sample(joint, &fresh, drive, tick_us);
    } else if (newer || (answer != BRACE_HAL_OK && answer != BRACE_HAL_AGAIN)) {
        brace_count(samples_bad);
    }
    /* A sample that was once too old stays unseen, or the clock's wrap would make it young again. A sample from the
     * future is not young either. */
    const int32_t age_us = (int32_t)(now_us - joint->sample.taken_us);
    const int32_t limit_us = (int32_t)parameters->controller.age_limit_us;
    joint->sound = joint->samples_seen != 0u && age_us <= limit_us && age_us >= -limit_us;
    joint->samples_seen = joint->sound ? joint->samples_seen : 0u;
    joint->is_new_enough_to_prove_a_flank = joint->sound && age_us <= (int32_t)(PROVING_TICKS * tick_us);
}

void joints_start(joints_t *joints, const brace_hal_t *hal)
{
    const float unknown = __builtin_nanf("");
    brace_hal_joint_t ignored;
    *joints = (joints_t){0};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        joints->joint[i] = (joint_t){.fitted = true, .sample = {unknown, unknown, unknown, unknown, 0}};
    }
    joints->joint[BRACE_COXA].fitted =
        hal->joint_read(hal->context, BRACE_COXA, &ignored) != BRACE_HAL_E_UNSUPPORTED;
}

void joints_read(joints_t *joints, const brace_hal_t *hal, const brace_parameters_t *parameters,
                 uint32_t now_us, uint32_t *samples_bad)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (joints->joint[i].fitted) {
            read_one(joints, i, hal, parameters, now_us, samples_bad);
        }
    }
}

void joints_link_angles(const joints_t *joints, float link_rad[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        link_rad[i] = link_angle_rad(&joints->joint[i].sample);
    }
}

uint32_t joints_taken_us(const joints_t *joints)
{
    uint32_t oldest_us = joints->joint[BRACE_FEMUR].sample.taken_us;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const joint_t *joint = &joints->joint[i];
        if (joint->sound && (int32_t)(joint->sample.taken_us - oldest_us) < 0) {
            oldest_us = joint->sample.taken_us;
        }
    }
    return oldest_us;
}

void joints_temperatures(const joints_t *joints, float temp_degc[BRACE_LINK_COUNT])
{
    const float femur = joints->joint[BRACE_FEMUR].sample.temp_degc;
    const float tibia = joints->joint[BRACE_TIBIA].sample.temp_degc;
    temp_degc[BRACE_COXA] = joints->joint[BRACE_COXA].sample.temp_degc;
    temp_degc[BRACE_FEMUR] = femur == femur ? femur : tibia;
    temp_degc[BRACE_TIBIA] = tibia == tibia ? tibia : femur;
}

float joints_warmest_degc(const joints_t *joints)
{
    float temp_degc[BRACE_LINK_COUNT];
    joints_temperatures(joints, temp_degc);
    return temp_degc[BRACE_FEMUR] > temp_degc[BRACE_TIBIA] ? temp_degc[BRACE_FEMUR] : temp_degc[BRACE_TIBIA];
}
