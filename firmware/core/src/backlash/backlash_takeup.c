#include "backlash/backlash_takeup.h"

#include <math.h>
#include <stddef.h>

#include "backlash/backlash_table.h"

/* Share of the gap that a motor may move while its take-up is verified, once it has had half of that time to come to
 * rest: a servo lags behind its command, and by more than a small gap. */
#define MOVED_SHARE 0.25f
#define SETTLES_PART 2u

static bool running(const brace_backlash_t *joint)
{
    return joint->phase == BRACE_TAKEUP_APPROACH || joint->phase == BRACE_TAKEUP_VERIFY;
}

static uint32_t fact(bool is_so, uint32_t bit)
{
    return is_so ? bit : 0u;
}

static uint32_t gathered(const brace_backlash_t *joint, int proven)
{
    const brace_takeup_bounds_t *bounds = &joint->params.takeup;
    const float flank = (float)joint->chosen_flank;
    const float wanted_n_mm =
        bounds->preload_n_mm > joint->least_preload_n_mm ? bounds->preload_n_mm : joint->least_preload_n_mm;
    return fact(joint->requested, FACT_REQUESTED) | fact(joint->let_go, FACT_LET_GO) |
           fact(proven == joint->chosen_flank && flank * joint->fast_n_mm >= wanted_n_mm, FACT_PRELOADED) |
           fact(proven != joint->chosen_flank, FACT_UNLOADED) |
           fact(fabsf(joint->torque_n_mm) > bounds->torque_max_n_mm, FACT_TORQUE) |
           fact(fabsf(joint->motor_rad - joint->start_rad) > bounds->travel_max_rad, FACT_TRAVEL) |
           fact(fabsf(joint->command_rad) >= bounds->reach_max_rad, FACT_REACH) |
           fact(joint->takeup_us >= bounds->time_max_us, FACT_TIME) |
           fact(fabsf(joint->motor_rad - joint->verify_rad) > MOVED_SHARE * joint->params.gap_rad, FACT_MOVED) |
           fact(joint->command_rad == 0.0f, FACT_BACK) | fact(joint->phase_us >= bounds->verify_us, FACT_VERIFIED);
}

static void enter(brace_backlash_t *joint, const transition_t *row)
{
    joint->phase = row->to;
    joint->phase_us = 0;
    joint->requested = false;
    if (row->result != 0 || row->to == BRACE_TAKEUP_LET_GO) {
        const bool abandoned = row->to == BRACE_TAKEUP_LET_GO && joint->result == BRACE_TAKEUP_RUNNING;
        joint->result = row->result != 0 || abandoned ? row->result : joint->result;
    }
    if (row->to == BRACE_TAKEUP_APPROACH) {
        joint->start_rad = joint->motor_rad;
        joint->takeup_us = 0;
        joint->let_go = false;
    }
    /* the slow mean has seen nothing but the verified load, or was started anew on it */
    joint->preload_n_mm = row->to == BRACE_TAKEUP_HOLD ? joint->slow_n_mm : 0.0f;
}

static void move_command(brace_backlash_t *joint)
{
    const float step_rad = joint->params.takeup.rate_rad_per_s / joint->ticks_per_s;
    if (joint->phase == BRACE_TAKEUP_APPROACH) {
        const float reach_rad = joint->params.takeup.reach_max_rad;
        const float next_rad = joint->command_rad + (float)joint->chosen_flank * step_rad;
        joint->command_rad = next_rad > reach_rad ? reach_rad : next_rad < -reach_rad ? -reach_rad : next_rad;
    } else if (joint->phase == BRACE_TAKEUP_LET_GO) {
        joint->command_rad = joint->command_rad > step_rad    ? joint->command_rad - step_rad
                             : joint->command_rad < -step_rad ? joint->command_rad + step_rad
                                                              : 0.0f;
    }
}

uint32_t backlash_takeup_advance(brace_backlash_t *joint, uint32_t facts, int proven)
{
    const transition_t *row = NULL;
    if (joint->phase_us < joint->params.takeup.verify_us / SETTLES_PART) {
        joint->verify_rad = joint->motor_rad; /* VERIFY alone asks how far the motor has moved since */
    }
    if (joint->phase != BRACE_TAKEUP_IDLE || joint->requested) {
        row = transition_find(&takeup_phases[joint->phase], facts | gathered(joint, proven), joint->phase_us);
        joint->phase_us += joint->phase_us < 0x40000000u ? joint->params.tick_us : 0u;
        joint->takeup_us += joint->takeup_us < 0x40000000u ? joint->params.tick_us : 0u;
    }
    if (row != NULL) {
        enter(joint, row);
    }
    move_command(joint);
    return running(joint) ? FACT_TAKING_UP : FACT_NOT_TAKING_UP;
}

uint32_t backlash_takeup_stand(const brace_backlash_t *joint)
{
    return running(joint) ? FACT_TAKING_UP : FACT_NOT_TAKING_UP;
}

void backlash_takeup_report(const brace_backlash_t *joint, brace_backlash_out_t *out)
{
    out->phase = (brace_takeup_phase_t)joint->phase;
    out->takeup = (brace_takeup_result_t)joint->result;
    out->command_rad = joint->command_rad;
    out->limit_torque = joint->phase != BRACE_TAKEUP_IDLE;
    out->preload_n_mm = joint->preload_n_mm;
}
