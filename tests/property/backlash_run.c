/* Random load and motion histories of one joint, the state machine beside direction-of-motion compensation, and
 * random take-ups. Counts only; backlash_histories.py judges. */
#include <math.h>
#include <string.h>

#include "backlash_plant.h"
#include "brace/backlash.h"

enum { HISTORY_TICKS = 6000, BINS = 12000 };
static const double tick_s = 1e-3;
static const double pi = 3.141592653589793;

typedef struct {
    double ticks, open, excluded, judged;
    double wrong, withheld, best_wrong, valid, valid_wrong;
    double late_valid, late_valid_longest_us; /* valid while the gap has been open for longer than detection */
    double longest_valid_open_us;
    double cnc_command_wrong, cnc_encoder_wrong;
    double detection_us_max;
    double open_longest_us;
    double error[BINS], cnc_error[BINS], judged_error[BINS]; /* |error| / gap to the nearest 0.0001 */
} history_counts_t;

/* gap_off: the belief's error as a ratio. */
static brace_backlash_params_t believed(const plant_t *p, double gap_off, dice_t *dice, double hold_stiffness)
{
    const double torque_max = 0.55 * p->range_n_mm;
    const double gap = p->gap_rad * (1.0 + gap_off);
    const double yield_rad = torque_max / p->stiffness + (hold_stiffness > 0.0 ? torque_max / hold_stiffness : 0.0);
    const double travel = 1.3 * gap + yield_rad + 0.002;
    return (brace_backlash_params_t){
        .tick_us = 1000,
        .gap_rad = (float)gap,
        .friction_n_mm = (float)(p->motor_friction_n_mm * dice_uniform(dice, 0.85, 1.15)),
        .friction_tolerance_ratio = 0.2f,
        .inertia_n_mm_s2_per_rad = (float)(p->motor_inertia * dice_uniform(dice, 0.85, 1.15)),
        .torque_range_n_mm = (float)p->range_n_mm,
        .torque_noise_n_mm = (float)p->noise_n_mm,
        .torque_bias_n_mm = (float)(0.01 * p->range_n_mm),
        .angle_step_rad = (float)p->step_rad,
        .takeup = {.torque_max_n_mm = (float)torque_max,
                   .preload_n_mm = (float)(0.1 * p->range_n_mm),
                   .travel_max_rad = (float)travel,
                   .reach_max_rad = (float)(travel + torque_max / p->servo_p),
                   .rate_rad_per_s = 0.1f,
                   .time_max_us = 4000000,
                   .verify_us = 100000},
    };
}

/* ------------------------------------------------------------------------------------------ histories -- */

typedef enum { REST, MOVE, SWING, PRESS, DRIFT, IMPACTS, KINDS } kind_t;

typedef struct {
    kind_t kind;
    double t, length_s;
    double from_rad, to_rad, swing_rad, swing_hz;
    double torque_from, torque_to, pulse_at_s, pulse_s, pulse_n_mm;
    bool held;
} segment_t;

static segment_t next_segment(dice_t *dice, const plant_t *p, double setpoint_rad, const segment_t *before)
{
    segment_t s = {.kind = (kind_t)(int)dice_uniform(dice, 0.0, KINDS - 1e-9), .from_rad = setpoint_rad};
    s.length_s = dice_uniform(dice, 0.2, 1.0);
    s.to_rad = s.from_rad;
    s.held = s.kind == PRESS || (s.kind != MOVE && s.kind != SWING && before->held);
    s.torque_from = s.torque_to = before->torque_to;
    if (s.kind == MOVE) {
        s.to_rad = dice_uniform(dice, -1.2, 1.2);
        s.torque_from = s.torque_to = 0.0;
        const double fastest = fabs(s.to_rad - s.from_rad) * 15.0 / 8.0 / dice_log_uniform(dice, 0.1, 3.0);
        s.length_s = fmin(2.0, fmax(s.length_s, fastest));
    } else if (s.kind == SWING) {
        s.torque_from = s.torque_to = 0.0;
        s.swing_hz = dice_log_uniform(dice, 0.5, 5.0);
        s.swing_rad = dice_log_uniform(dice, 0.01, 0.3) / s.swing_hz;
    } else if (s.kind == PRESS) {
        s.to_rad = s.from_rad + dice_uniform(dice, -0.5, 0.5) * p->range_n_mm / p->servo_p;
    } else if (s.kind == DRIFT) {
        s.torque_to = dice_uniform(dice, -0.4, 0.4) * p->range_n_mm;
    } else if (s.kind == IMPACTS) {
        s.pulse_s = dice_uniform(dice, 0.005, 0.02);
        s.pulse_at_s = dice_uniform(dice, 0.05, 0.15);
        s.pulse_n_mm = dice_uniform(dice, -0.5, 0.5) * p->range_n_mm;
    }
    return s;
}

static double segment_setpoint(const segment_t *s, double t)
{
    const double u = fmin(1.0, t / s->length_s);
    const double eased = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    const double swing = s->kind == SWING ? 1.0 - cos(2.0 * pi * s->swing_hz * t) : 0.0;
    return s->from_rad + (s->to_rad - s->from_rad) * eased + 0.5 * s->swing_rad * swing;
}

static double segment_torque(const segment_t *s, double t)
{
    double torque = s->torque_from + (s->torque_to - s->torque_from) * fmin(1.0, t / s->length_s);
    for (int i = 0; s->kind == IMPACTS && i < 3; i++) {
        const double into = (t - (i + 1) * s->pulse_at_s) / s->pulse_s;
        torque += into > 0.0 && into < 1.0 ? s->pulse_n_mm * sin(pi * into) : 0.0;
    }
    return torque;
}

static void count_error(double *bins, double error_rad, double gap_rad)
{
    const int bin = (int)(fabs(error_rad) / gap_rad * 10000.0 + 0.5);
    bins[bin < BINS ? bin : BINS - 1] += 1.0;
}

static int sign(double value)
{
    return (value > 0.0) - (value < 0.0);
}

/* mode_gap: 0 the belief is off by anything within 20 %, 1 by exactly 20 % up or down.
 * expecting: gravity (15 % off, and 2 % of range for friction) is told while nothing else touches the link and it is at
 * rest. */
int backlash_history(uint64_t seed, int mode_gap, int expecting, history_counts_t *counts)
{
    dice_t dice = {seed * 0x2545f4914f6cdd1du + 99u};
    plant_t p = plant_random(&dice);
    const double spread = dice_uniform(&dice, -0.2, 0.2);
    const double gap_off = mode_gap == 0 ? spread : spread < 0.0 ? -0.2 : 0.2;
    const brace_backlash_params_t params = believed(&p, gap_off, &dice, 0.0);
    const double hold_stiffness = dice_log_uniform(&dice, 5e4, 6e5);
    const double gravity_off = dice_uniform(&dice, 0.85, 1.15);
    brace_backlash_t joint;
    const int status = brace_backlash_init(&joint, &params);
    if (status != BRACE_OK) {
        return status;
    }
    const double detection_us = brace_backlash_detection_us(&joint);
    counts->detection_us_max = fmax(counts->detection_us_max, detection_us);

    segment_t segment = {.kind = REST, .length_s = 0.3, .from_rad = p.motor_rad, .to_rad = p.motor_rad};
    world_t world = {0};
    double setpoint = p.motor_rad, read_before = plant_angle_read_rad(&p), anchor = read_before;
    double since_open_us = 1e9, open_us = 0.0;
    int command_way = 0, encoder_way = 0;
    for (int tick = 0; tick < HISTORY_TICKS; tick++) {
        if (segment.t >= segment.length_s) {
            const segment_t before = segment;
            segment = next_segment(&dice, &p, setpoint, &before);
            if (segment.held && !before.held) {
                world.hold_rad = p.link_rad;
            }
            world.hold_stiffness = segment.held ? hold_stiffness : 0.0;
            world.hold_damping = segment.held ? 0.3 * sqrt(hold_stiffness * p.link_inertia) : 0.0;
        }
        segment.t += tick_s;
        const double before = setpoint;
        setpoint = segment_setpoint(&segment, segment.t);
        world.torque_n_mm = segment_torque(&segment, segment.t);
        plant_tick(&p, setpoint, (setpoint - before) / tick_s, &world);

        const double read = plant_angle_read_rad(&p);
        const bool known = expecting && world.torque_n_mm == 0.0 && !segment.held && segment.kind == REST;
        const brace_backlash_sample_t sample = {
            .now_us = (uint32_t)tick * 1000u + 4294000000u, /* wraps on the way */
            .motor_rad = (float)read,
            .torque_n_mm = (float)plant_torque_read_n_mm(&p, &dice),
            .load_is_expected = known,
            .expected_n_mm = (float)(-gravity_off * plant_gravity_n_mm(&p, read)),
            .expected_off_n_mm = (float)(0.15 * p.gravity_n_mm + 0.02 * p.range_n_mm),
        };
        brace_backlash_out_t out;
        brace_backlash_tick(&joint, &sample, &out);

        /* as machine tools do it: half the gap against the last motion, commanded or seen */
        command_way = setpoint != before ? sign(setpoint - before) : command_way;
        if (fabs(read - anchor) > 2.0 * p.step_rad) {
            encoder_way = sign(read - anchor);
            anchor = read - encoder_way * 2.0 * p.step_rad;
        }

        const int truth = plant_flank(&p);
        counts->ticks += 1.0;
        counts->open += truth == 0;
        counts->valid += out.valid;
        open_us = truth == 0 ? open_us + 1000.0 : 0.0;
        since_open_us = truth == 0 ? 0.0 : since_open_us + 1000.0;
        counts->open_longest_us = fmax(counts->open_longest_us, open_us);
        if (out.valid) {
            counts->longest_valid_open_us = fmax(counts->longest_valid_open_us, open_us);
            counts->late_valid += open_us > detection_us;
        }
        count_error(counts->error, (double)out.offset_rad - plant_offset_rad(&p), p.gap_rad);
        count_error(counts->cnc_error, -0.5 * command_way * (double)params.gap_rad - plant_offset_rad(&p), p.gap_rad);
        if (since_open_us <= detection_us) {
            counts->excluded += 1.0;
            continue;
        }
        counts->judged += 1.0;
        count_error(counts->judged_error, (double)out.offset_rad - plant_offset_rad(&p), p.gap_rad);
        counts->wrong += out.flank == -truth;
        counts->withheld += out.flank == 0;
        counts->best_wrong += sign(-(double)out.offset_rad) != truth;
        counts->valid_wrong += out.valid && out.flank != truth;
        counts->cnc_command_wrong += command_way != truth;
        counts->cnc_encoder_wrong += encoder_way != truth;
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
    const brace_backlash_params_t params = believed(&p, dice_uniform(&dice, -0.2, 0.2), &dice, hold_stiffness);
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
        plant_tick(&p, setpoint, (setpoint - before) / tick_s, &world);
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
    counts->result[out.takeup < 0 ? -out.takeup : out.takeup == BRACE_TAKEUP_DONE ? 0 : 1] +=
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
