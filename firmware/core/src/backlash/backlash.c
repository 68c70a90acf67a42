#include "brace/backlash.h"

#include <math.h>
#include <stddef.h>

#include "backlash/backlash_load.h"
#include "backlash/backlash_table.h"
#include "backlash/backlash_takeup.h"
#include "base/check.h"
#include "brace/ranges.h"

#define FAST_US 10000.0f
#define SLOW_US 80000.0f
#define SPEED_US 4000.0f

/* When the load has not shown the flank for this long, memory no longer names it either: the load may have changed
 * unseen, within the friction of a standing motor. */
#define STALE_US 250000u
#define ANGLE_LIMIT_RAD 1e3f
#define EXPECTED_LIMIT_N_MM 1e7f

/* When the motor has crept off a flank by more than this share of the gap, the gap counts as being crossed. */
#define LEFT_FLANK 0.2f

/* Shares of the slow interval's full width. The full width is a sum of bounds that hardly ever occur together. The
 * larger share suffices to name a flank. The smaller one suffices to move the offset while the motor moves and its
 * friction is known. The torque of a standing motor may lie anywhere within its friction, so there the offset stays. */
#define DECIDED_SHARE 0.7f
#define LEANING_SHARE 0.2f

/* Size of a preload in fast sigmas. Six sigmas prove a flank. The command stops at the first sample that shows the
 * preload, which noise may bring up to five sigmas early, and six more keep the load clear of the six that prove it. */
#define PRELOAD_SIGMAS 18.0f

static bool flank_positive(const brace_backlash_t *joint)
{
    return joint->state == BRACE_BACKLASH_ENGAGED_POSITIVE;
}

static bool flank_negative(const brace_backlash_t *joint)
{
    return joint->state == BRACE_BACKLASH_ENGAGED_NEGATIVE;
}

/* ------------------------------------------------------------------------------------------ preparation -- */

typedef struct {
    float value, low, high;
} range_t;

static brace_status_t check_params(const brace_backlash_params_t *p)
{
    const float range = p->torque_range_n_mm;
    const range_t ranges[] = {
        {p->gap_rad, BRACE_BACKLASH_LEAST_GAP_RAD, BRACE_RANGE_JOINT_GAP_RAD_MAX},
        {p->friction_n_mm, BRACE_RANGE_DRIVE_MOTOR_FRICTION_N_MM_MIN, BRACE_RANGE_DRIVE_MOTOR_FRICTION_N_MM_MAX},
        {p->friction_tolerance_ratio, BRACE_RANGE_DRIVE_MOTOR_FRICTION_TOLERANCE_RATIO_MIN,
         BRACE_RANGE_DRIVE_MOTOR_FRICTION_TOLERANCE_RATIO_MAX},
        {p->inertia_n_mm_s2_per_rad, BRACE_RANGE_DRIVE_MOTOR_INERTIA_N_MM_S2_PER_RAD_MIN,
         BRACE_RANGE_DRIVE_MOTOR_INERTIA_N_MM_S2_PER_RAD_MAX},
        {range, 1e-3f, BRACE_RANGE_DRIVE_TORQUE_RANGE_N_MM_MAX},
        {p->torque_noise_n_mm, 0.0f, range},
        {p->torque_bias_n_mm, 0.0f, range},
        {p->angle_step_rad, BRACE_RANGE_DRIVE_ANGLE_STEP_RAD_MIN, BRACE_RANGE_DRIVE_ANGLE_STEP_RAD_MAX},
        {p->takeup.torque_max_n_mm, 1e-3f, range},
        {p->takeup.preload_n_mm, 0.0f, p->takeup.torque_max_n_mm},
        {p->takeup.travel_max_rad, 1e-6f, 1.0f},
        {p->takeup.reach_max_rad, 1e-6f, 2.0f},
        {p->takeup.rate_rad_per_s, 1e-6f, 10.0f},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        const brace_status_t status = brace_check_magnitude(ranges[i].value, 1e7f);
        if (status != BRACE_OK) {
            return status;
        }
    }
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        if (ranges[i].value < ranges[i].low || ranges[i].value > ranges[i].high) {
            return BRACE_E_RANGE;
        }
    }
    const bool times = p->tick_us >= 100u && p->tick_us <= 5000u && p->takeup.time_max_us >= 1u &&
                       p->takeup.time_max_us <= 60000000u && p->takeup.verify_us >= 20000u &&
                       p->takeup.verify_us <= 10000000u;
    return times ? BRACE_OK : BRACE_E_RANGE;
}

/* Sigma of an exponential mean of white noise with gain a: sqrt(a / (2 - a)) of a sample's. */
static float mean_sigma(float sigma, float gain)
{
    return sigma * sqrtf(gain / (2.0f - gain));
}

/* The time in which the filter falls from the full range to one fast sigma, and the lag of the direction of motion. */
static uint32_t detection(const brace_backlash_t *joint)
{
    const float quiet_n_mm = joint->fast_sigma_n_mm + 0.001f * joint->params.torque_range_n_mm;
    float left_n_mm = joint->params.torque_range_n_mm;
    uint32_t time_us = 5000u;
    for (int i = 0; i < 1000 && left_n_mm > quiet_n_mm; i++) {
        left_n_mm -= joint->fast_gain * left_n_mm;
        time_us += joint->params.tick_us;
    }
    return time_us;
}

brace_status_t brace_backlash_init(brace_backlash_t *joint, const brace_backlash_params_t *params)
{
    if (joint == NULL || params == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_params(params);
    if (status != BRACE_OK) {
        return status;
    }
    brace_backlash_t fresh = {.params = *params};
    const float tick_us = (float)params->tick_us;
    fresh.fast_gain = tick_us / (FAST_US + tick_us);
    fresh.slow_gain = tick_us / (SLOW_US + tick_us);
    fresh.speed_gain = tick_us / (SPEED_US + tick_us);
    fresh.ticks_per_s = 1e6f / tick_us;
    fresh.fast_sigma_n_mm = mean_sigma(params->torque_noise_n_mm, fresh.fast_gain);
    fresh.slow_sigma_n_mm = mean_sigma(params->torque_noise_n_mm, fresh.slow_gain);
    fresh.least_preload_n_mm = params->friction_n_mm * (1.0f + params->friction_tolerance_ratio) +
                               params->torque_bias_n_mm + PRELOAD_SIGMAS * fresh.fast_sigma_n_mm;
    fresh.detection_us = detection(&fresh);
    fresh.play_low_rad = -0.5f * params->gap_rad;
    fresh.play_high_rad = 0.5f * params->gap_rad;
    if (fresh.least_preload_n_mm + params->friction_n_mm >= params->takeup.torque_max_n_mm) {
        return BRACE_E_PARAMETER;
    }
    *joint = fresh;
    return BRACE_OK;
}

uint32_t brace_backlash_detection_us(const brace_backlash_t *joint)
{
    return joint != NULL ? joint->detection_us : 0u;
}

float brace_takeup_preload_min_n_mm(const brace_backlash_t *joint)
{
    return joint != NULL ? joint->least_preload_n_mm : 0.0f;
}

/* ------------------------------------------------------------------------------------------------- tick -- */

static brace_status_t check_sample(const brace_backlash_t *joint, const brace_backlash_sample_t *sample)
{
    brace_status_t status = brace_check_magnitude(sample->motor_rad, ANGLE_LIMIT_RAD);
    if (status == BRACE_OK) {
        status = brace_check_magnitude(sample->torque_n_mm, 10.0f * joint->params.torque_range_n_mm);
    }
    if (status == BRACE_OK && sample->load_is_expected) {
        status = brace_check_two(sample->expected_n_mm, sample->expected_off_n_mm, EXPECTED_LIMIT_N_MM);
        if (status == BRACE_OK && sample->expected_off_n_mm < 0.0f) {
            status = BRACE_E_RANGE;
        }
    }
    return status;
}

/* What the load and the motor's travel show about the flank, as facts. Also moves the play operator. */
static uint32_t flank_facts(brace_backlash_t *joint, int decided, int leaning)
{
    const float half_gap_rad = 0.5f * joint->params.gap_rad;
    const int lies = decided != 0 ? decided : leaning;
    if (lies != 0) {
        joint->play_low_rad = joint->play_high_rad = (float)lies * half_gap_rad;
    }
    if (decided != 0) {
        joint->undecided_us = 0;
        return decided > 0 ? FACT_POSITIVE : FACT_NEGATIVE;
    }
    if (joint->undecided_us < STALE_US) {
        joint->undecided_us += joint->params.tick_us;
    }
    const float left_rad = half_gap_rad - LEFT_FLANK * joint->params.gap_rad;
    const bool left = (flank_positive(joint) && joint->play_low_rad < left_rad) ||
                      (flank_negative(joint) && joint->play_high_rad > -left_rad);
    return (left ? (uint32_t)FACT_LEFT : 0u) | (joint->undecided_us >= STALE_US ? (uint32_t)FACT_STALE : 0u);
}

static void advance_state(brace_backlash_t *joint, uint32_t facts)
{
    const transition_t *row = transition_find(&backlash_states[joint->state], facts, joint->state_us);
    if (row != NULL) {
        joint->state = row->to;
        joint->state_us = 0;
        if (row->to == BRACE_BACKLASH_FAULT) {
            joint->play_low_rad = -0.5f * joint->params.gap_rad;
            joint->play_high_rad = 0.5f * joint->params.gap_rad;
        }
    } else if (joint->state_us < 0x40000000u) {
        joint->state_us += joint->params.tick_us;
    }
}

static void report(const brace_backlash_t *joint, int proven, brace_backlash_out_t *out)
{
    out->state = (brace_backlash_state_t)joint->state;
    out->flank = flank_positive(joint) - flank_negative(joint);
    out->valid = out->flank != 0 && out->flank == proven;
    out->offset_rad = -0.5f * (joint->play_low_rad + joint->play_high_rad);
    out->offset_off_rad = 0.5f * (joint->play_high_rad - joint->play_low_rad);
    out->load_n_mm = joint->fast_n_mm;
    out->load_off_n_mm = backlash_load_off_n_mm(joint);
    backlash_takeup_report(joint, out);
}

brace_status_t brace_backlash_tick(brace_backlash_t *joint, const brace_backlash_sample_t *sample,
                                   brace_backlash_out_t *out)
{
    if (joint == NULL || sample == NULL || out == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_sample(joint, sample);
    const bool late = joint->started && sample->now_us - joint->last_us > 4u * joint->params.tick_us;
    const bool bad = status != BRACE_OK || late;
    if (status == BRACE_OK) {
        if (!joint->started || late) {
            backlash_load_start(joint, sample);
        } else {
            backlash_load_observe(joint, sample);
        }
    }
    /* after a bad sample the filters begin anew with the next good one */
    joint->started = status == BRACE_OK;
    joint->last_us = sample->now_us;

    const int proven = bad ? 0 : backlash_load_proven(joint);
    const int decided = bad ? 0 : proven != 0 ? proven : backlash_load_decided(joint, sample, DECIDED_SHARE);
    const bool leans = !bad && decided == 0 && !backlash_load_standing(joint);
    const int leaning = leans ? backlash_load_decided(joint, sample, LEANING_SHARE) : 0;
    uint32_t facts = bad ? (uint32_t)FACT_BAD_SAMPLE : flank_facts(joint, decided, leaning);
    facts |= sample->stands ? backlash_takeup_stand(joint) : backlash_takeup_advance(joint, facts, proven);
    advance_state(joint, facts);
    report(joint, proven, out);
    return status;
}

brace_status_t brace_backlash_at_rest(const brace_backlash_t *joint, const brace_backlash_sample_t *sample, int *flank,
                                      bool *is_proven)
{
    if (joint == NULL || sample == NULL || flank == NULL || is_proven == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_sample(joint, sample);
    if (status == BRACE_OK) {
        brace_backlash_t settled = *joint;
        backlash_load_settle(&settled, sample->torque_n_mm);
        const int proven = backlash_load_proven(&settled);
        *flank = proven != 0 ? proven : backlash_load_decided(&settled, sample, DECIDED_SHARE);
        *is_proven = proven != 0;
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------- take-up -- */

brace_status_t brace_takeup_request(brace_backlash_t *joint, int flank)
{
    if (joint == NULL) {
        return BRACE_E_NULL;
    }
    if ((flank != 1 && flank != -1) || joint->phase != BRACE_TAKEUP_IDLE || joint->requested ||
        joint->state == BRACE_BACKLASH_FAULT) {
        return BRACE_E_RANGE;
    }
    joint->chosen_flank = flank;
    joint->requested = true;
    return BRACE_OK;
}

brace_status_t brace_takeup_let_go(brace_backlash_t *joint)
{
    if (joint == NULL) {
        return BRACE_E_NULL;
    }
    if (joint->phase == BRACE_TAKEUP_IDLE) {
        joint->requested = false;
    } else {
        joint->let_go = true;
    }
    return BRACE_OK;
}

brace_status_t brace_backlash_tip_shift(const brace_pose_t *pose, float offset1_rad, float offset2_rad,
                                        brace_point_t *shift)
{
    if (pose == NULL || shift == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_two(offset1_rad, offset2_rad, 0.5f);
    if (status == BRACE_OK) {
        shift->x_mm = offset1_rad * pose->lever_femur.x_mm - offset2_rad * pose->lever_tibia.x_mm;
        shift->z_mm = offset1_rad * pose->lever_femur.z_mm - offset2_rad * pose->lever_tibia.z_mm;
    }
    return status;
}
