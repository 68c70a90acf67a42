#include "backlash/backlash_load.h"

#include <math.h>

#define INERTIA_TOLERANCE 0.25f

/* Friction has the sign of the motion only after the motion has lasted this long: in a reversal the sign is unsure. */
#define SAME_WAY_US 6000u

/* The motor has to move by this many steps of the angle before its direction counts. */
#define DIRECTION_STEPS 2.0f

/* The slow filter starts anew from the fast one when they are this many fast sigmas apart. */
#define RESTART_SIGMAS 4.0f

static float larger(float a, float b)
{
    return a > b ? a : b;
}

static float clamped(float value, float low, float high)
{
    return value < low ? low : value > high ? high : value;
}

static uint32_t added(uint32_t time_us, uint32_t tick_us)
{
    const uint32_t sum_us = time_us + tick_us;
    return sum_us < 0x40000000u ? sum_us : 0x40000000u;
}

void backlash_load_start(brace_backlash_t *joint, const brace_backlash_sample_t *sample)
{
    const float unknown_n_mm = joint->params.torque_range_n_mm;
    joint->motor_rad = sample->motor_rad;
    joint->anchor_rad = sample->motor_rad;
    joint->speed_rad_per_s = 0.0f;
    joint->direction = 0;
    joint->same_way_us = 0;
    joint->standing_us = STANDING_US;
    joint->fast_n_mm = joint->slow_n_mm = joint->torque_n_mm = sample->torque_n_mm;
    joint->fast_width_n_mm = joint->slow_width_n_mm = joint->slow_spread_n_mm = unknown_n_mm;
    joint->positive_us = joint->negative_us = 0;
}

/* Direction of the motor, from its travel against an anchor that it drags along; 0 when the direction is not sure. */
static int sure_direction(brace_backlash_t *joint)
{
    const float slack_rad = DIRECTION_STEPS * joint->params.angle_step_rad;
    const float ahead_rad = joint->motor_rad - joint->anchor_rad;
    /* half a step more, so that the rounding of the anchor does not count as motion */
    const float passed_rad = slack_rad + 0.5f * joint->params.angle_step_rad;
    const int way = ahead_rad > passed_rad ? 1 : ahead_rad < -passed_rad ? -1 : 0;
    joint->same_way_us = added(joint->same_way_us, joint->params.tick_us);
    joint->standing_us = added(joint->standing_us, joint->params.tick_us);
    if (way != 0) {
        joint->anchor_rad = joint->motor_rad - (float)way * slack_rad;
        if (way != joint->direction || joint->standing_us > STANDING_US) {
            joint->same_way_us = 0;
        }
        joint->direction = way;
        joint->standing_us = 0;
    }
    return !backlash_load_standing(joint) && joint->same_way_us >= SAME_WAY_US ? joint->direction : 0;
}

static void follow_load(brace_backlash_t *joint, float torque_n_mm, float accel_rad_per_s2, int direction)
{
    const brace_backlash_params_t *p = &joint->params;
    const float inertial_n_mm = p->inertia_n_mm_s2_per_rad * accel_rad_per_s2;
    const float friction_off_n_mm =
        p->friction_n_mm * (direction != 0 ? p->friction_tolerance_ratio : 1.0f + p->friction_tolerance_ratio);
    const float load_n_mm = torque_n_mm - inertial_n_mm - (float)direction * p->friction_n_mm;
    const float width_n_mm = friction_off_n_mm + INERTIA_TOLERANCE * fabsf(inertial_n_mm);

    joint->torque_n_mm += joint->fast_gain * (torque_n_mm - joint->torque_n_mm);
    joint->fast_n_mm += joint->fast_gain * (load_n_mm - joint->fast_n_mm);
    joint->fast_width_n_mm += joint->fast_gain * (width_n_mm - joint->fast_width_n_mm);
    joint->slow_n_mm += joint->slow_gain * (load_n_mm - joint->slow_n_mm);
    joint->slow_width_n_mm += joint->slow_gain * (width_n_mm - joint->slow_width_n_mm);
    joint->slow_spread_n_mm += joint->slow_gain * (joint->slow_sigma_n_mm - joint->slow_spread_n_mm);
    const float apart_n_mm = fabsf(joint->slow_n_mm - joint->fast_n_mm);
    if (apart_n_mm > RESTART_SIGMAS * joint->fast_sigma_n_mm || joint->slow_spread_n_mm > joint->fast_sigma_n_mm) {
        joint->slow_n_mm = joint->fast_n_mm;
        joint->slow_width_n_mm = joint->fast_width_n_mm;
        joint->slow_spread_n_mm = joint->fast_sigma_n_mm;
    }
}

void backlash_load_observe(brace_backlash_t *joint, const brace_backlash_sample_t *sample)
{
    const uint32_t tick_us = joint->params.tick_us;
    const float half_gap_rad = 0.5f * joint->params.gap_rad;
    const float moved_rad = sample->motor_rad - joint->motor_rad;
    const float before_rad_per_s = joint->speed_rad_per_s;
    joint->motor_rad = sample->motor_rad;
    joint->speed_rad_per_s += joint->speed_gain * (moved_rad * joint->ticks_per_s - before_rad_per_s);
    follow_load(joint, sample->torque_n_mm, (joint->speed_rad_per_s - before_rad_per_s) * joint->ticks_per_s,
                sure_direction(joint));

    const float off_n_mm = backlash_load_off_n_mm(joint);
    joint->positive_us = joint->fast_n_mm > off_n_mm ? added(joint->positive_us, tick_us) : 0u;
    joint->negative_us = joint->fast_n_mm < -off_n_mm ? added(joint->negative_us, tick_us) : 0u;

    joint->play_low_rad = clamped(joint->play_low_rad + moved_rad, -half_gap_rad, half_gap_rad);
    joint->play_high_rad = clamped(joint->play_high_rad + moved_rad, -half_gap_rad, half_gap_rad);
}

void backlash_load_settle(brace_backlash_t *joint, float torque_n_mm)
{
    const brace_backlash_params_t *p = &joint->params;
    joint->fast_n_mm = joint->slow_n_mm = joint->torque_n_mm = torque_n_mm;
    joint->fast_width_n_mm = joint->slow_width_n_mm = p->friction_n_mm * (1.0f + p->friction_tolerance_ratio);
    joint->slow_spread_n_mm = joint->slow_sigma_n_mm;
    const float off_n_mm = backlash_load_off_n_mm(joint);
    joint->positive_us = torque_n_mm > off_n_mm ? CONFIRM_US : 0u;
    joint->negative_us = torque_n_mm < -off_n_mm ? CONFIRM_US : 0u;
}

float backlash_load_off_n_mm(const brace_backlash_t *joint)
{
    return joint->fast_width_n_mm + PROOF_SIGMAS * joint->fast_sigma_n_mm + joint->params.torque_bias_n_mm;
}

int backlash_load_proven(const brace_backlash_t *joint)
{
    return (joint->positive_us >= CONFIRM_US) - (joint->negative_us >= CONFIRM_US);
}

int backlash_load_decided(const brace_backlash_t *joint, const brace_backlash_sample_t *sample, float share)
{
    const float off_n_mm =
        share * (joint->slow_width_n_mm + HINT_SIGMAS * joint->slow_spread_n_mm + joint->params.torque_bias_n_mm);
    float low_n_mm = joint->slow_n_mm - off_n_mm;
    float high_n_mm = joint->slow_n_mm + off_n_mm;
    if (sample->load_is_expected) {
        const float least_n_mm = larger(low_n_mm, sample->expected_n_mm - sample->expected_off_n_mm);
        const float most_n_mm = -larger(-high_n_mm, -(sample->expected_n_mm + sample->expected_off_n_mm));
        if (least_n_mm <= most_n_mm) { /* else the expectation is wrong, and the motor's torque decides */
            low_n_mm = least_n_mm;
            high_n_mm = most_n_mm;
        }
    }
    return (low_n_mm > 0.0f) - (high_n_mm < 0.0f);
}
