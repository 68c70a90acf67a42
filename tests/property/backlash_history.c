#include "backlash_history.h"

#include <math.h>

static const double pi = 3.141592653589793;
static const double feeling_rad_per_s = 0.7, back_s = 0.5; /* the best of those tried on seeds 1-1000 */

/* gap_off: the belief's error as a ratio. */
brace_backlash_params_t joint_as_believed(const plant_t *p, double gap_off, dice_t *dice, double hold_stiffness)
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

history_t history_begin(uint64_t seed, gap_belief_t belief, bool expecting, breakaway_t breakaway)
{
    history_t h = {.dice = {seed * 0x2545f4914f6cdd1du + 99u}, .expecting = expecting};
    h.plant = plant_random(&h.dice);
    const double spread = dice_uniform(&h.dice, -0.2, 0.2);
    const double gap_off = belief == GAP_WITHIN_20_PERCENT ? spread : spread < 0.0 ? -0.2 : 0.2;
    h.believed = joint_as_believed(&h.plant, gap_off, &h.dice, 0.0);
    h.hold_stiffness = dice_log_uniform(&h.dice, 5e4, 6e5);
    h.gravity_off = dice_uniform(&h.dice, 0.85, 1.15);
    if (breakaway != SLIPS) {
        h.plant.breakaway_ratio = dice_uniform(&h.dice, 1.0, 2.0);
    }
    if (breakaway == STICKS_ALLOWED) {
        h.believed.friction_tolerance_ratio = 1.0f;
        h.believed.friction_n_mm *= 1.15f; /* the upper end of what it may be */
    }
    h.setpoint_rad = h.setpoint_before_rad = h.sent_before_rad = h.plant.motor_rad;
    h.segment = (segment_t){.kind = REST, .length_s = 0.3, .from_rad = h.setpoint_rad, .to_rad = h.setpoint_rad};
    return h;
}

void history_feel_for_flank(history_t *h, int flank, double offset_rad, double reach_gaps)
{
    const double reach_rad = reach_gaps * (double)h->believed.gap_rad, step_rad = feeling_rad_per_s * HISTORY_TICK_S;
    const double feeling_rad = h->astray_rad + (offset_rad < 0.0 ? step_rad : -step_rad);
    h->astray_rad =
        flank != 0 ? h->astray_rad * (1.0 - HISTORY_TICK_S / back_s) : fmax(-reach_rad, fmin(feeling_rad, reach_rad));
}

brace_backlash_sample_t history_tick(history_t *h)
{
    plant_t *p = &h->plant;
    if (h->segment.t >= h->segment.length_s) {
        const segment_t before = h->segment;
        h->segment = next_segment(&h->dice, p, h->setpoint_rad, &before);
        if (h->segment.held && !before.held) {
            h->world.hold_rad = p->link_rad;
        }
        h->world.hold_stiffness = h->segment.held ? h->hold_stiffness : 0.0;
        h->world.hold_damping = h->segment.held ? 0.3 * sqrt(h->hold_stiffness * p->link_inertia) : 0.0;
    }
    h->segment.t += HISTORY_TICK_S;
    h->setpoint_before_rad = h->setpoint_rad;
    h->setpoint_rad = segment_setpoint(&h->segment, h->segment.t);
    const double sent_rad = h->setpoint_rad + h->astray_rad;
    const double sent_rad_per_s = (sent_rad - h->sent_before_rad) / HISTORY_TICK_S;
    h->sent_before_rad = sent_rad;
    h->world.torque_n_mm = segment_torque(&h->segment, h->segment.t);
    plant_tick(p, sent_rad, sent_rad_per_s, &h->world);

    const double read_rad = plant_angle_read_rad(p);
    const bool known = h->expecting && h->world.torque_n_mm == 0.0 && !h->segment.held && h->segment.kind == REST;
    return (brace_backlash_sample_t){
        .now_us = h->tick++ * 1000u + 4294000000u, /* wraps on the way */
        .motor_rad = (float)read_rad,
        .torque_n_mm = (float)plant_torque_read_n_mm(p, &h->dice),
        .load_is_expected = known,
        .expected_n_mm = (float)(-h->gravity_off * plant_gravity_n_mm(p, read_rad)),
        .expected_off_n_mm = (float)(0.15 * p->gravity_n_mm + 0.02 * p->range_n_mm),
    };
}
