#include "watch/frozen.h"

/* So long a proof has to last: a drive answers its command, and a motor its load, well within a quarter of a second. */
#define FROZEN_US 250000u
/* One look counts for this time at most, so that several looks must agree. Where all ports ask for K in every tick,
 * each joint gets a look every 54 ms. */
#define LOOK_LASTS_US 60000u
#define SAMPLES_SETTLED 3u /* the torque's mean begins with as many */

#define COMMANDED_LEAST_RAD 0.005f
#define COMMANDED_STEPS 10.0f
#define TORQUE_LEFT_RATIO 0.8f /* of the limit: a drive near it may stand for lack of torque */

#define SWINGS_OF_RANGE 0.25f
#define SWINGS_OF_FRICTION 4.0f
#define LINK_LEAST_RAD 0.005f

#define FRICTION_BANDS 4.0f /* there and back, of a friction known to a factor of two */
#define NOISE_SIGMAS 12.0f /* six there, six back */
#define LOAD_OFF_RATIO 0.2f /* weights, levers and the sensor's gain, together */

static frozen_span_t just(float value)
{
    return (frozen_span_t){value, value};
}

/* NaN once, and the span's width stays NaN. */
static frozen_span_t with(frozen_span_t span, float value)
{
    return (frozen_span_t){.low = value != value || value < span.low ? value : span.low,
                           .high = value > span.high ? value : span.high};
}

/* What an encoder behind the gearbox has reported; one absurd sample does not count. */
static frozen_span_t with_link(frozen_span_t span, float link_rad)
{
    return link_rad != link_rad ? span : with(span, link_rad);
}

static float width(frozen_span_t span)
{
    return span.high - span.low;
}

static float largest(frozen_span_t span)
{
    const float low = __builtin_fabsf(span.low), high = __builtin_fabsf(span.high);
    return low > high ? low : high;
}

/* What the joint carries, by the tip's sensor and the weight; NaN: not known. The force across the plane is not
 * sensed. */
static float load_n_mm(const frozen_inputs_t *inputs, int index)
{
    if (index == BRACE_COXA || !inputs->force->known || !inputs->posture->has_levers) {
        return __builtin_nanf("");
    }
    return posture_gravity_n_mm(inputs->posture, &inputs->parameters->gravity, inputs->down, index) +
           posture_tip_load_n_mm(inputs->posture, inputs->force->x_n, inputs->force->z_n, index);
}

/* How far a torque may be from what its joint carries. The joint's own friction hides a part, and so does the
 * motor's. */
static float hidden_n_mm(const frozen_joint_t *joint, const frozen_inputs_t *inputs, int index)
{
    const brace_drive_t *drive = &inputs->parameters->drive[index];
    const float most_n_mm = largest(joint->load_n_mm);
    const float friction_n_mm =
        drive->motor_friction_n_mm + drive->coulomb_n_mm + drive->coulomb_per_load_ratio * most_n_mm;
    const brace_point_t lever =
        index == BRACE_FEMUR ? inputs->posture->pose.lever_femur : inputs->posture->pose.lever_tibia;
    const float sensed_n_mm =
        inputs->parameters->sensor.noise_n * (__builtin_fabsf(lever.x_mm) + __builtin_fabsf(lever.z_mm));
    return FRICTION_BANDS * friction_n_mm + NOISE_SIGMAS * (drive->torque_noise_n_mm + sensed_n_mm) +
           LOAD_OFF_RATIO * most_n_mm;
}

static bool swings(const frozen_joint_t *joint, const brace_drive_t *drive)
{
    return width(joint->pulls_n_mm) > SWINGS_OF_RANGE * drive->torque_range_n_mm &&
           width(joint->pulls_n_mm) > SWINGS_OF_FRICTION * drive->motor_friction_n_mm;
}

static bool link_has_left(const frozen_joint_t *joint, const brace_joint_t *spring)
{
    const float follows_rad = spring->gap_rad + width(joint->pulls_n_mm) * spring->compliance_rad_per_n_mm;
    return width(joint->link_rad) > LINK_LEAST_RAD + follows_rad;
}

/* The duration of something that held at the look before and holds now. */
static uint32_t lasted_us(uint32_t before_us, uint32_t since_us)
{
    const uint32_t counted_us = since_us < LOOK_LASTS_US ? since_us : LOOK_LASTS_US;
    return before_us + counted_us < FROZEN_US ? before_us + counted_us : FROZEN_US;
}

static void watch_one(frozen_joint_t *joint, const frozen_inputs_t *inputs, int index)
{
    const joint_t *seen = &inputs->joints->joint[index];
    const brace_drive_t *drive = &inputs->parameters->drive[index];
    const uint32_t since_us = seen->sample.taken_us - joint->taken_us;
    const float carries_n_mm = load_n_mm(inputs, index), commanded_offset_rad = inputs->commanded_offset_rad[index];
    float link_rad[BRACE_LINK_COUNT];
    joints_link_angles(inputs->joints, link_rad);
    const float moved_rad = __builtin_fabsf(seen->sample.motor_rad - joint->stood_at_rad);
    const bool stands = joint->is_settled && moved_rad <= 0.5f * drive->angle_step_rad;
    const bool same = seen->sample.motor_rad == joint->motor_rad && seen->sample.torque_n_mm == joint->torque_n_mm;
    const bool has_torque = __builtin_fabsf(seen->torque_n_mm) < TORQUE_LEFT_RATIO * inputs->limit_n_mm[index];

    joint->motor_rad = seen->sample.motor_rad;
    joint->torque_n_mm = seen->sample.torque_n_mm;
    joint->taken_us = seen->sample.taken_us;
    joint->commanded_offset_rad =
        same && has_torque ? with(joint->commanded_offset_rad, commanded_offset_rad) : just(commanded_offset_rad);
    joint->same_load_n_mm = same ? with(joint->same_load_n_mm, carries_n_mm) : just(carries_n_mm);
    joint->load_n_mm = stands ? with(joint->load_n_mm, carries_n_mm) : just(carries_n_mm);
    joint->pulls_n_mm = stands ? with(joint->pulls_n_mm, seen->torque_n_mm) : just(seen->torque_n_mm);
    joint->link_rad = stands ? with_link(joint->link_rad, link_rad[index]) : just(link_rad[index]);
    joint->stood_at_rad = stands ? joint->stood_at_rad : seen->sample.motor_rad;
    joint->stood_us = stands ? lasted_us(joint->stood_us, since_us) : 0u;
    joint->is_settled = seen->samples_seen >= SAMPLES_SETTLED;

    const float hidden = hidden_n_mm(joint, inputs, index); /* NaN, and no more than it, where the load is not known */
    const bool was_told = width(joint->commanded_offset_rad) > COMMANDED_LEAST_RAD &&
                          width(joint->commanded_offset_rad) > COMMANDED_STEPS * drive->angle_step_rad;
    const bool was_loaded = width(joint->same_load_n_mm) > hidden;
    const bool is_unheld = width(joint->pulls_n_mm) > width(joint->load_n_mm) + hidden;
    const bool is_proven = (same && (was_told || was_loaded)) || (stands && is_unheld);
    joint->proven_us = is_proven ? lasted_us(joint->proven_us, since_us) : 0u;
    joint->is_frozen = joint->proven_us >= FROZEN_US ||
                       (joint->stood_us >= FROZEN_US &&
                        (swings(joint, drive) || link_has_left(joint, &inputs->parameters->limb.joint[index])));
}

static void forget(frozen_joint_t *joint)
{
    *joint = (frozen_joint_t){.motor_rad = __builtin_nanf("")};
}

void frozen_start(frozen_t *frozen)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        forget(&frozen->joint[i]);
    }
}

void frozen_watch(frozen_t *frozen, const frozen_inputs_t *inputs)
{
    const int turn = frozen->turn;
    frozen->turn = (uint8_t)(turn + 1 < (int)BRACE_LINK_COUNT ? turn + 1 : 0);
    if (inputs->joints->joint[turn].sound) {
        watch_one(&frozen->joint[turn], inputs, turn);
    } else {
        forget(&frozen->joint[turn]);
    }
}

bool frozen_any(const frozen_t *frozen)
{
    return frozen->joint[BRACE_COXA].is_frozen || frozen->joint[BRACE_FEMUR].is_frozen ||
           frozen->joint[BRACE_TIBIA].is_frozen;
}
