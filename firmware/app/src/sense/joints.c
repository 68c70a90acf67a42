#include "sense/joints.h"

#include "brace/limb.h"

#define ANGLE_ABSURD_RAD 100.0f
#define SPEED_MOST_RAD_PER_US 50e-6f /* no joint of a limb turns so fast: ten times a servo without load */
#define REACH_MARGIN_RAD 0.01f       /* of steps and jitter */
#define REACH_MOST_RAD 0.25f         /* between two samples, whatever their time stamps say */
#define REACH_UNSEEN_RAD 0.06f       /* while nobody looked; as much as between two samples a millisecond apart */
#define TORQUE_SIGMAS 6.0f /* of noise, beyond the motor's greatest torque and the bias */

/* After a wild sample, a joint is watched more closely: only what goes on as before is believed. Where samples are wild
 * again and again, none is, until as many good ones have come. */
#define WILD_COUNTS 10u
#define WILD_MOST 40u
#define WILD_DISTRUSTED 30u
#define WARY_SPEEDS 2.0f /* as fast as before, twice */

#define COLDEST_DEGC (-60.0f)
#define WARMEST_DEGC 150.0f

/* How far a joint's two encoders may be apart beyond its play and what its spring gives way by. */
#define APART_MARGIN_RAD 0.005f
#define APART_STEPS 2.0f
#define APART_SIGMAS 3.0f
#define SPRING_OFF_RATIO 0.5f /* a spring that is warm, or softer than it was calibrated */
#define CONTRADICTS_US 50000u /* a motor takes up a load that has come at once within some 10 ms */

/* The torque's mean begins as the median of the first three samples. Afterwards it follows only what two samples in a
 * row agree on, so that a single wild sample does not move it. */
#define TORQUE_MEAN_US 20000.0f
#define SAMPLES_FIRST 3u

/* How far a joint may have moved since its last sample before K is called stale: it may go on as fast as it was, and
 * faster, and by a step that its encoder was about to make. */
#define FASTER_RAD_PER_US2 1e-10f /* 100 rad/s^2, of a joint that carries a limb */
#define UNSEEN_SIGMAS 1.5f /* of the angle: a way that K's uncertainty covers */
#define UNSEEN_SIGMA_RAD 0.002f /* where the parameters know of less */
#define UNSEEN_MARGIN_RAD 0.001f

#define LATELY_RATIO 0.98f /* a sample: coarse encoders stand for several samples and then move by a step */

#define US2_PER_S2 1e12f

/* The backlash machine's filters bear a stretch of four ticks without a sample. */
#define PROVING_TICKS 4u

static bool is_sound(const brace_hal_joint_t *sample, const brace_drive_t *drive)
{
    const float most_n_mm =
        drive->torque_range_n_mm + drive->torque_bias_n_mm + TORQUE_SIGMAS * drive->torque_noise_n_mm;
    return __builtin_fabsf(sample->motor_rad) <= ANGLE_ABSURD_RAD && __builtin_fabsf(sample->torque_n_mm) <= most_n_mm;
}

/* What an encoder behind the gearbox says; NaN: there is none, or it is absurd. */
static float link_angle_rad(const brace_hal_joint_t *sample)
{
    return __builtin_fabsf(sample->link_rad) <= ANGLE_ABSURD_RAD ? sample->link_rad : __builtin_nanf("");
}

/* Can an encoder have come from its place to this angle? An angle that is not known, NaN, says nothing. */
static bool can_reach(const joint_place_t *from, float to_rad, uint32_t taken_us)
{
    const float moved_rad = __builtin_fabsf(to_rad - from->rad);
    if (!(moved_rad > REACH_MARGIN_RAD)) {
        return true;
    }
    const float by_speed_rad = REACH_MARGIN_RAD + SPEED_MOST_RAD_PER_US * (float)(taken_us - from->taken_us);
    const float seen_rad = by_speed_rad < REACH_MOST_RAD ? by_speed_rad : REACH_MOST_RAD;
    return moved_rad <= (from->is_old ? REACH_UNSEEN_RAD : seen_rad);
}

static bool both_can_reach(const joint_place_t from[JOINT_ENCODERS], const float to_rad[JOINT_ENCODERS],
                           uint32_t taken_us)
{
    return can_reach(&from[JOINT_MOTOR], to_rad[JOINT_MOTOR], taken_us) &&
           can_reach(&from[JOINT_LINK], to_rad[JOINT_LINK], taken_us);
}

/* Do both encoders go on as they did before? */
static bool both_go_on(const joint_t *joint, const float to_rad[JOINT_ENCODERS], uint32_t taken_us)
{
    bool goes_on = true;
    for (int i = 0; i < JOINT_ENCODERS; i++) {
        const joint_place_t *from = &joint->place[i];
        const float moved_rad = __builtin_fabsf(to_rad[i] - from->rad);
        const float as_before_rad = REACH_MARGIN_RAD + WARY_SPEEDS * __builtin_fabsf(joint->speed_rad_per_us) *
                                                           (float)(taken_us - from->taken_us);
        goes_on = goes_on && (from->is_old || !(moved_rad > as_before_rad));
    }
    return goes_on;
}

/* How far both encoders are from there; what is not known is left out. */
static float away_rad(const joint_place_t from[JOINT_ENCODERS], const float angles_rad[JOINT_ENCODERS])
{
    float sum_rad = 0.0f;
    for (int i = 0; i < JOINT_ENCODERS; i++) {
        const float moved_rad = __builtin_fabsf(angles_rad[i] - from[i].rad);
        sum_rad += moved_rad == moved_rad ? moved_rad : 0.0f;
    }
    return sum_rad;
}

/* Is the sample where the joint can be? One that is not is kept. If the next one agrees with it, and not with what was
 * believed before, the encoder does stand there and has come there in a way that no joint could: also where it could
 * have by the time of the next sample. */
static bool is_within_reach(joint_t *joint, const float angles_rad[JOINT_ENCODERS], uint32_t taken_us)
{
    const bool agrees = joint->has_wild && both_can_reach(joint->wild, angles_rad, taken_us) &&
                        away_rad(joint->wild, angles_rad) < away_rad(joint->place, angles_rad);
    const bool is_there = both_can_reach(joint->place, angles_rad, taken_us) &&
                          (joint->wildness == 0u || both_go_on(joint, angles_rad, taken_us));
    if (!agrees && is_there) {
        const bool is_trusted = joint->wildness < WILD_DISTRUSTED;
        joint->has_wild = false;
        joint->wildness = (uint8_t)(joint->wildness != 0u ? joint->wildness - 1u : 0u);
        return is_trusted;
    }
    joint->has_jumped = joint->has_jumped || agrees;
    joint->has_wild = !agrees;
    joint->wildness = (uint8_t)(joint->wildness + WILD_COUNTS < WILD_MOST ? joint->wildness + WILD_COUNTS : WILD_MOST);
    for (int i = 0; i < JOINT_ENCODERS; i++) {
        joint->wild[i] = (joint_place_t){.rad = angles_rad[i], .taken_us = taken_us};
    }
    return agrees;
}

static void take_places(joint_t *joint, const float angles_rad[JOINT_ENCODERS], uint32_t taken_us)
{
    for (int i = 0; i < JOINT_ENCODERS; i++) {
        if (angles_rad[i] == angles_rad[i]) {
            joint->place[i] = (joint_place_t){.rad = angles_rad[i], .taken_us = taken_us};
        }
    }
}

/* What has been too old once stays so until there is a sound sample, or the clock's wrap would make it young again. A
 * place from the future is not young either. */
static void age_places(joint_t *joint, uint32_t now_us, int32_t limit_us)
{
    for (int i = 0; i < JOINT_ENCODERS; i++) {
        const int32_t age_us = (int32_t)(now_us - joint->place[i].taken_us);
        joint->place[i].is_old = joint->place[i].is_old || age_us > limit_us || age_us < -limit_us;
    }
}

/* Are both encoders further apart than play, spring and calibration allow? A spring never gives way by more than its
 * torque says, however it hardens. Where one of them is not known: no. */
static bool encoders_contradict(const joint_t *joint, int index, const brace_parameters_t *parameters)
{
    const brace_limb_t *limb = &parameters->limb;
    const brace_joint_t *spring = &limb->joint[index];
    const brace_drive_t *drive = &parameters->drive[index];
    const float motor_rad = joint->place[JOINT_MOTOR].rad, link_rad = joint->place[JOINT_LINK].rad;
    const float torque_n_mm = __builtin_fabsf(joint->torque_n_mm) + drive->torque_bias_n_mm + drive->torque_noise_n_mm +
                              drive->motor_friction_n_mm;
    const float softer_ratio =
        1.0f + SPRING_OFF_RATIO + APART_SIGMAS * limb->uncertainty.compliance_rel + parameters->slow.creep_ratio;
    const float most_rad = 0.5f * spring->gap_rad + softer_ratio * spring->compliance_rad_per_n_mm * torque_n_mm +
                           APART_SIGMAS * limb->uncertainty.angle_rad + APART_STEPS * drive->angle_step_rad +
                           APART_MARGIN_RAD;
    const bool is_of_now = joint->sound && !joint->place[JOINT_MOTOR].is_old && !joint->place[JOINT_LINK].is_old;
    return is_of_now && __builtin_fabsf(link_rad - brace_limb_true_angle(limb, index, motor_rad)) > most_rad;
}

static void compare_encoders(joint_t *joint, int index, const brace_parameters_t *parameters)
{
    const uint32_t tick_us = parameters->controller.tick_us;
    joint->contradicts = encoders_contradict(joint, index, parameters);
    joint->contradicts_us = joint->contradicts ? joint->contradicts_us + tick_us : 0u;
    joint->has_jumped = joint->has_jumped || joint->contradicts_us >= CONTRADICTS_US;
    joint->contradicts_us = joint->has_jumped ? 0u : joint->contradicts_us;
}

/* What two changes agree on: nothing when their signs differ, else the smaller. */
static float agreed(float a, float b)
{
    const float smaller = __builtin_fabsf(a) < __builtin_fabsf(b) ? a : b;
    return a * b > 0.0f ? smaller : 0.0f;
}

/* What accelerates the motor. An encoder behind the gear does not measure how the motor moves. */
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
    /* Where a speed is not known, NaN, the one before fades. */
    const float before_rad_per_us = LATELY_RATIO * joint->lately_rad_per_us;
    const float now_rad_per_us = __builtin_fabsf(speed_rad_per_us);
    joint->lately_rad_per_us = now_rad_per_us > before_rad_per_us ? now_rad_per_us : before_rad_per_us;
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

static bool may_have_moved(const joint_t *joint, const brace_drive_t *drive, float angle_sigma_rad, uint32_t age_us)
{
    const float long_us = (float)age_us;
    const float moved_rad =
        joint->lately_rad_per_us * long_us + 0.5f * FASTER_RAD_PER_US2 * long_us * long_us + drive->angle_step_rad;
    const float sigma_rad = angle_sigma_rad > UNSEEN_SIGMA_RAD ? angle_sigma_rad : UNSEEN_SIGMA_RAD;
    return age_us != 0u && moved_rad > UNSEEN_SIGMAS * sigma_rad + UNSEEN_MARGIN_RAD;
}

static void read_one(joints_t *joints, int index, const brace_hal_t *hal, const brace_parameters_t *parameters,
                     uint32_t now_us, uint32_t *samples_bad)
{
    const uint32_t tick_us = parameters->controller.tick_us;
    joint_t *joint = &joints->joint[index];
    const brace_drive_t *drive = &parameters->drive[index];
    brace_hal_joint_t fresh;
    const int32_t limit_us = (int32_t)parameters->controller.age_limit_us;
    const int32_t answer = hal->joint_read(hal->context, index, &fresh);
    const bool none_yet = joint->sample.motor_rad != joint->sample.motor_rad;
    const bool newer = answer == BRACE_HAL_OK && (none_yet || fresh.taken_us != joint->sample.taken_us);
    const bool is_link_only = newer && fresh.motor_rad != fresh.motor_rad;
    const float angles_rad[JOINT_ENCODERS] = {fresh.motor_rad, link_angle_rad(&fresh)};
    if (is_link_only) {
        fresh.motor_rad = fresh.link_rad;
    }
    age_places(joint, now_us, limit_us);
    if (newer && is_sound(&fresh, drive) && is_within_reach(joint, angles_rad, fresh.taken_us)) {
        joint->is_link_only = is_link_only;
        take_sample(joint, &fresh, drive, tick_us);
        take_places(joint, angles_rad, fresh.taken_us);
    } else if (newer || (answer != BRACE_HAL_OK && answer != BRACE_HAL_AGAIN)) {
        brace_count(samples_bad);
    }
    /* A sample that was once too old stays unseen, or the clock's wrap would make it young again. A sample from the
     * future is not young either. */
    const int32_t age_us = (int32_t)(now_us - joint->sample.taken_us);
    joint->sound = joint->samples_seen != 0u && age_us <= limit_us && age_us >= -limit_us;
    joint->samples_seen = joint->sound ? joint->samples_seen : 0u;
    /* A board takes its sample within the tick, a few us after now_us: its age is less than nothing. */
    const uint32_t apart_us = age_us < 0 ? 0u - (uint32_t)age_us : (uint32_t)age_us;
    joint->may_have_moved = may_have_moved(joint, drive, parameters->limb.uncertainty.angle_rad, apart_us);
    compare_encoders(joint, index, parameters);
    joint->is_new_enough_to_prove_a_flank = joint->sound && age_us <= (int32_t)(PROVING_TICKS * tick_us);
}

void joints_believe(joints_t *joints, int index)
{
    joint_t *joint = &joints->joint[index];
    for (int i = 0; i < JOINT_ENCODERS; i++) {
        joint->place[i] = (joint_place_t){.rad = __builtin_nanf("")};
    }
    joint->has_wild = joint->has_jumped = joint->contradicts = false;
    joint->contradicts_us = 0;
    joint->wildness = 0;
    joint->samples_seen = 0;
}

void joints_start(joints_t *joints, const brace_hal_t *hal)
{
    const float unknown = __builtin_nanf("");
    brace_hal_joint_t ignored;
    *joints = (joints_t){0};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        joints->joint[i] = (joint_t){.fitted = true, .sample = {unknown, unknown, unknown, unknown, 0}};
        joints_believe(joints, i);
    }
    joints->joint[BRACE_COXA].fitted = hal->joint_read(hal->context, BRACE_COXA, &ignored) != BRACE_HAL_E_UNSUPPORTED;
}

void joints_read(joints_t *joints, const brace_hal_t *hal, const brace_parameters_t *parameters, uint32_t now_us,
                 uint32_t *samples_bad)
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

/* NaN: there is no sensor, or it says what no drive survives. */
static float survived_degc(float temp_degc)
{
    return temp_degc >= COLDEST_DEGC && temp_degc <= WARMEST_DEGC ? temp_degc : __builtin_nanf("");
}

void joints_temperatures(const joints_t *joints, float temp_degc[BRACE_LINK_COUNT])
{
    const float femur = survived_degc(joints->joint[BRACE_FEMUR].sample.temp_degc);
    const float tibia = survived_degc(joints->joint[BRACE_TIBIA].sample.temp_degc);
    temp_degc[BRACE_COXA] = survived_degc(joints->joint[BRACE_COXA].sample.temp_degc);
    temp_degc[BRACE_FEMUR] = femur == femur ? femur : tibia;
    temp_degc[BRACE_TIBIA] = tibia == tibia ? tibia : femur;
}

float joints_warmest_degc(const joints_t *joints)
{
    float temp_degc[BRACE_LINK_COUNT];
    joints_temperatures(joints, temp_degc);
    return temp_degc[BRACE_FEMUR] > temp_degc[BRACE_TIBIA] ? temp_degc[BRACE_FEMUR] : temp_degc[BRACE_TIBIA];
}
