/* The state machine beside direction-of-motion compensation on random histories, and random take-ups. Counts only;
 * backlash_histories.py judges. */
#include <math.h>
#include <string.h>

#include "backlash_history.h"

enum { BINS = 12000 };

typedef struct {
    double count[BINS]; /* |error| / gap to the nearest 0.0001 */
} errors_t;

typedef struct {
    double ticks, open, excluded, judged;
    double wrong, withheld, best_wrong, valid, valid_wrong;
    double late_valid; /* valid while the gap has been open for longer than detection */
    double longest_valid_open_us;
    double cnc_command_wrong, cnc_encoder_wrong;
    double detection_us_max;
    double open_longest_us;
    errors_t all, touching, outside_crossing, decided, valid_only;
    errors_t cnc_command, cnc_encoder; /* all ticks */
} history_counts_t;

/* A tick of a history as a picture needs it. */
typedef struct {
    double t_s, offset_rad, corrected_rad, cnc_command_rad, cnc_encoder_rad; /* the truth, and three who say it */
    double load_n_mm, truth, flank, valid, kind;
} trace_tick_t;

/* As machine tools do it: half the gap against the last motion, commanded or seen. */
typedef struct {
    double anchor_rad;
    int command_way, encoder_way;
} cnc_t;

static void count_error(errors_t *errors, double error_rad, double gap_rad)
{
    const int bin = (int)(fabs(error_rad) / gap_rad * 10000.0 + 0.5);
    errors->count[bin < BINS ? bin : BINS - 1] += 1.0;
}

static int sign(double value)
{
    return (value > 0.0) - (value < 0.0);
}

static void cnc_follow(cnc_t *cnc, const history_t *h, double read_rad)
{
    const double slack_rad = 2.0 * h->plant.step_rad;
    const int commanded = sign(h->setpoint_rad - h->setpoint_before_rad);
    cnc->command_way = commanded != 0 ? commanded : cnc->command_way;
    if (fabs(read_rad - cnc->anchor_rad) > slack_rad) {
        cnc->encoder_way = sign(read_rad - cnc->anchor_rad);
        cnc->anchor_rad = read_rad - cnc->encoder_way * slack_rad;
    }
}

/* reach_gaps: how far the motor may leave its setpoint to feel for a flank; 0: not
 * trace: HISTORY_TICKS rows, or null */
int backlash_history(uint64_t seed, int belief, int expecting, int breakaway, double reach_gaps,
                     history_counts_t *counts, trace_tick_t *trace)
{
    history_t h = history_begin(seed, (gap_belief_t)belief, expecting != 0, (breakaway_t)breakaway);
    const plant_t *p = &h.plant;
    brace_backlash_t joint;
    const int status = brace_backlash_init(&joint, &h.believed);
    if (status != BRACE_OK) {
        return status;
    }
    const double detection_us = brace_backlash_detection_us(&joint), half_gap_rad = 0.5 * (double)h.believed.gap_rad;
    counts->detection_us_max = fmax(counts->detection_us_max, detection_us);
    cnc_t cnc = {.anchor_rad = plant_angle_read_rad(p)};
    double since_open_us = 1e9, open_us = 0.0;
    for (int tick = 0; tick < HISTORY_TICKS; tick++) {
        const brace_backlash_sample_t sample = history_tick(&h);
        brace_backlash_out_t out;
        brace_backlash_tick(&joint, &sample, &out);
        history_feel_for_flank(&h, out.flank, (double)out.offset_rad, reach_gaps);
        cnc_follow(&cnc, &h, plant_angle_read_rad(p));

        const int truth = plant_flank(p);
        const double offset_rad = plant_offset_rad(p), error_rad = (double)out.offset_rad - offset_rad;
        const double cnc_command_rad = -cnc.command_way * half_gap_rad;
        const double cnc_encoder_rad = -cnc.encoder_way * half_gap_rad;
        if (trace != NULL) {
            trace[tick] = (trace_tick_t){(tick + 1) * HISTORY_TICK_S,
                                         offset_rad,
                                         (double)out.offset_rad,
                                         cnc_command_rad,
                                         cnc_encoder_rad,
                                         plant_load_n_mm(p),
                                         truth,
                                         out.flank,
                                         out.valid,
                                         h.segment.kind};
        }
        counts->ticks += 1.0;
        counts->open += truth == 0;
        counts->valid += out.valid;
        open_us = truth == 0 ? open_us + 1000.0 : 0.0;
        since_open_us = truth == 0 ? 0.0 : since_open_us + 1000.0;
        counts->open_longest_us = fmax(counts->open_longest_us, open_us);
        if (out.valid) {
            counts->longest_valid_open_us = fmax(counts->longest_valid_open_us, open_us);
            counts->late_valid += open_us > detection_us;
            count_error(&counts->valid_only, error_rad, p->gap_rad);
        }
        count_error(&counts->all, error_rad, p->gap_rad);
        if (out.flank != 0) {
            count_error(&counts->decided, error_rad, p->gap_rad);
        }
        count_error(&counts->cnc_command, cnc_command_rad - offset_rad, p->gap_rad);
        count_error(&counts->cnc_encoder, cnc_encoder_rad - offset_rad, p->gap_rad);
        if (truth != 0) {
            count_error(&counts->touching, error_rad, p->gap_rad);
        }
        if (since_open_us <= detection_us) {
            counts->excluded += 1.0;
            continue;
        }
        counts->judged += 1.0;
        count_error(&counts->outside_crossing, error_rad, p->gap_rad);
        counts->wrong += out.flank == -truth;
        counts->withheld += out.flank == 0;
        counts->best_wrong += sign(-(double)out.offset_rad) != truth;
        counts->valid_wrong += out.valid && out.flank != truth;
        counts->cnc_command_wrong += cnc.command_way != truth;
        counts->cnc_encoder_wrong += cnc.encoder_way != truth;
    }
    return BRACE_OK;
}

/* ------------------------------------------------------------------------------------------- take-ups -- */

typedef struct {
    double done, really_done, result[8]; /* by -result; [0] is success */
    double torque_over, travel_over, time_over, not_idle; /* bounds passed, command not back at the end */
    double preload_error, preload_error_max; /* of range */
} takeup_counts_t;

/* held: something holds the link (a foot on the ground); else it is free, and a take-up has to give up. */
int backlash_takeup(uint64_t seed, int held, takeup_counts_t *counts)
{
    dice_t dice = {seed * 0x2545f4914f6cdd1du + 7u};
    plant_t p = plant_random(&dice);
    const double hold_stiffness = dice_log_uniform(&dice, 5e4, 6e5);
    const brace_backlash_params_t params = joint_as_believed(&p, dice_uniform(&dice, -0.2, 0.2), &dice, hold_stiffness);
    const int flank = dice_uniform(&dice, -1.0, 1.0) > 0.0 ? 1 : -1;
    brace_backlash_t joint;
    const int status = brace_backlash_init(&joint, &params);
    if (status != BRACE_OK) {
        return status;
    }
    const double start = p.motor_rad, settle = dice_uniform(&dice, -0.02, 0.02);
    world_t world = {.hold_stiffness = held ? hold_stiffness : 0.0,
                     .hold_damping = held ? 0.3 * sqrt(hold_stiffness * p.link_inertia) : 0.0,
                     .hold_rad = p.link_rad};
    if (held) { /* the ground bears the link's own weight */
        world.torque_n_mm = -plant_gravity_n_mm(&p, p.link_rad);
    }
    brace_backlash_out_t out = {0};
    double setpoint = start, request_rad = 0.0, travel = 0.0, torque = 0.0;
    double preload = 0.0, true_preload = 0.0, hold_ticks = 0.0;
    bool stays = true;
    int done_at = -1, ended_at = -1, asked_at = 700;
    for (int tick = 0; tick < 9000; tick++) {
        const double before = setpoint;
        const double moved = tick < 500 ? settle * tick / 500.0 : settle;
        setpoint = start + moved + (double)out.command_rad;
        p.torque_limit_n_mm = out.limit_torque ? (double)params.takeup.torque_max_n_mm : p.range_n_mm;
        plant_tick(&p, setpoint, (setpoint - before) / HISTORY_TICK_S, &world);
        const brace_backlash_sample_t sample = {.now_us = (uint32_t)tick * 1000u,
                                                .motor_rad = (float)plant_angle_read_rad(&p),
                                                .torque_n_mm = (float)plant_torque_read_n_mm(&p, &dice)};
        if (tick == asked_at) {
            brace_takeup_request(&joint, flank);
            request_rad = p.motor_rad;
        }
        brace_backlash_tick(&joint, &sample, &out);
        if (out.phase == BRACE_TAKEUP_APPROACH || out.phase == BRACE_TAKEUP_VERIFY) {
            travel = fmax(travel, fabs(p.motor_rad - request_rad));
        }
        if (out.phase != BRACE_TAKEUP_IDLE && tick > asked_at) {
            torque = fmax(torque, fabs(p.torque_n_mm));
        }
        if (out.phase == BRACE_TAKEUP_HOLD) {
            done_at = done_at < 0 ? tick : done_at;
            stays = stays && plant_flank(&p) == flank && out.flank == flank && out.valid;
            preload = (double)out.preload_n_mm;
            true_preload += world.hold_stiffness * (p.link_rad - world.hold_rad);
            hold_ticks += 1.0;
            if (tick - done_at == 500) {
                brace_takeup_let_go(&joint);
            }
        }
        ended_at = ended_at < 0 && tick > asked_at && out.phase == BRACE_TAKEUP_LET_GO ? tick : ended_at;
    }
    counts->done += out.takeup == BRACE_TAKEUP_DONE;
    counts->really_done += out.takeup == BRACE_TAKEUP_DONE && stays && hold_ticks > 0.0;
    counts->result[out.takeup < 0                    ? -out.takeup
                   : out.takeup == BRACE_TAKEUP_DONE ? 0
                                                     : 1] +=
        out.takeup < 0 || out.takeup == BRACE_TAKEUP_DONE ? 1.0 : 0.0;
    counts->torque_over += torque > (double)params.takeup.torque_max_n_mm * 1.000001;
    /* a free link's motor runs on for the tick in which the bound is seen: 0.001 rad are allowed */
    counts->travel_over += travel > (double)params.takeup.travel_max_rad + 0.001;
    const int until = done_at >= 0 ? done_at : ended_at;
    counts->time_over += until < 0 || (until - asked_at) * 1000.0 > params.takeup.time_max_us + 2000.0;
    counts->not_idle += out.phase != BRACE_TAKEUP_IDLE || out.command_rad != 0.0f;
    if (hold_ticks > 0.0) {
        const double off = fabs(preload - true_preload / hold_ticks) / p.range_n_mm;
        counts->preload_error += off;
        counts->preload_error_max = fmax(counts->preload_error_max, off);
    }
    return BRACE_OK;
}
