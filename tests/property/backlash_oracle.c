/* How well could anyone do? A particle filter over the link's place in the gap that knows what no controller knows:
 * every parameter of motor, gap, link and gravity as it is, and the motor's motion without quantisation. It sees the
 * motor's current with its noise (or, on request, without). It does not know what the world does to the link. Assumed
 * of that: a torque that wanders and jumps (steps of 25 % of range, kicks of 8 %), and holds that come and go at the
 * link's place, of a stiffness drawn as the histories draw it; on request it is given instead which kind of time it is,
 * and the hold's stiffness. Found for each tick: the offset in whose neighbourhood, a tenth of the gap to either side,
 * most of the probability lies: the best there is for that measure. On request it knows only what a controller may
 * know: gap, friction and inertia as the machine believes them, the link's to 20 %, and of the motor what its encoder
 * and its current read; and it may let the motor leave its setpoint to feel for a flank. Judges the attainable; shares
 * no code with the firmware. */
#include <math.h>
#include <string.h>

#include "backlash_history.h"

enum { PARTICLES_MOST = 8000, SUBSTEPS = 5, BINS = 12000, CELLS = 101, NEIGHBOURS = 9 };

/* What the machine states: so long after the gap has closed is still the crossing. */
enum { DETECTION_TICKS = 52 };

typedef struct {
    double motor_rad, motor_speed, link_rad, link_speed, world_n_mm, base_n_mm, hold_stiffness, hold_rad, friction_n_mm;
} particle_t;

typedef struct {
    particle_t *of, *resampled;
    double *log_weight;
    int count;
    dice_t dice;
} cloud_t;

/* A tick of the motor, from before to after; its torque less what its own motion takes. */
typedef struct {
    double rad0, rad1, speed0, speed1, accel, accel_before, left_n_mm;
    int way; /* +1, -1 it moved all the tick; 0 it stood or turned */
    bool stood;
} motor_t;

typedef struct {
    bool exact_torque, known_world, exact_joint; /* of the joint: its parameters and the motor's motion */
} knows_t;

/* A motor's angle and speed by its encoder: steady Kalman gains, and the variance of what the encoder reads anew. */
typedef struct {
    double angle, speed_per_s, variance_rad2;
} gains_t;

typedef struct {
    double ticks, beyond_a_tenth, open_beyond_a_tenth;
    double judged, flank_wrong; /* outside the crossing */
    double error[BINS];         /* |error| / gap to the nearest 0.0001 */
} oracle_counts_t;

static double clamp(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

static int way_of(double speed0, double speed1)
{
    const double still = 1e-9;
    return (speed0 > still && speed1 > still) - (speed0 < -still && speed1 < -still);
}

static double load_n_mm(const plant_t *p, double apart_rad, double apart_speed)
{
    const double half = 0.5 * p->gap_rad, damped = p->damping * apart_speed;
    return apart_rad > half    ? fmax(0.0, p->stiffness * (apart_rad - half) + damped)
           : apart_rad < -half ? fmin(0.0, p->stiffness * (apart_rad + half) + damped)
                               : 0.0;
}

static void begin(cloud_t *cloud, const plant_t *p, double motor_rad)
{
    const double half = 0.5 * p->gap_rad;
    for (int i = 0; i < cloud->count; i++) {
        const double load = 0.1 * p->range_n_mm * dice_normal(&cloud->dice);
        const double engaged = -copysign(half, load) - load / p->stiffness;
        cloud->of[i] =
            (particle_t){.motor_rad = motor_rad,
                         .link_rad = motor_rad + (i % 2 == 0 ? dice_uniform(&cloud->dice, -half, half) : engaged),
                         .friction_n_mm = dice_uniform(&cloud->dice, -p->motor_friction_n_mm, p->motor_friction_n_mm)};
        cloud->log_weight[i] = 0.0;
    }
}

/* Now and then a particle begins anew elsewhere, so that the cloud never dies out on a wrong flank. */
static void rejuvenate(particle_t *q, const plant_t *p, knows_t knows, dice_t *dice)
{
    if (dice_uniform(dice, 0.0, 1.0) >= 0.0005) {
        return;
    }
    const double half = 0.5 * p->gap_rad, load = 0.12 * p->range_n_mm * dice_normal(dice);
    const bool engaged = dice_uniform(dice, 0.0, 1.0) < 0.7;
    q->link_rad =
        q->motor_rad + (engaged ? -copysign(half, load) - load / p->stiffness : dice_uniform(dice, -half, half));
    q->link_speed = q->motor_speed;
    if (!knows.known_world) {
        q->world_n_mm = engaged ? -load - plant_gravity_n_mm(p, q->link_rad) : 0.0;
    }
}

static void world_as_known(particle_t *q, const history_t *h, bool newly_held, dice_t *dice)
{
    const double range = h->plant.range_n_mm, u = dice_uniform(dice, 0.0, 1.0);
    const kind_t kind = h->segment.kind;
    q->hold_rad = newly_held ? q->link_rad : q->hold_rad;
    q->hold_stiffness = h->segment.held ? h->hold_stiffness : 0.0;
    if (kind == MOVE || kind == SWING) {
        q->base_n_mm = 0.0;
    } else if (kind == DRIFT) {
        q->base_n_mm += 0.0008 * range * dice_normal(dice);
    }
    if (kind != IMPACTS) {
        q->world_n_mm = q->base_n_mm;
    } else if (u < 0.1) {
        q->world_n_mm += 0.08 * range * dice_normal(dice);
    } else if (u < 0.13) {
        q->world_n_mm = q->base_n_mm;
    }
}

static void world_as_assumed(particle_t *q, const plant_t *p, dice_t *dice)
{
    const double u = dice_uniform(dice, 0.0, 1.0);
    if (u < 0.0007) {
        q->hold_stiffness = q->hold_stiffness > 0.0 ? 0.0 : dice_log_uniform(dice, 5e4, 6e5);
        q->hold_rad = q->link_rad;
    } else if (u < 0.0025) {
        q->world_n_mm = 0.0;
    } else if (u < 0.0035) {
        q->world_n_mm = 0.25 * p->range_n_mm * dice_normal(dice);
    } else {
        q->world_n_mm += (u < 0.015 ? 0.08 : 0.0006) * p->range_n_mm * dice_normal(dice);
    }
}

static void push_link(particle_t *q, const plant_t *p, double passed_n_mm, double dt)
{
    const double hold_damping = q->hold_stiffness > 0.0 ? 0.3 * sqrt(q->hold_stiffness * p->link_inertia) : 0.0;
    const double outside = q->world_n_mm + plant_gravity_n_mm(p, q->link_rad) - p->link_damping * q->link_speed -
                           q->hold_stiffness * (q->link_rad - q->hold_rad) - hold_damping * q->link_speed;
    q->link_speed += dt * (passed_n_mm + outside) / p->link_inertia;
    q->link_speed -= clamp(q->link_speed, p->link_friction_n_mm * dt / p->link_inertia);
    q->link_rad += dt * q->link_speed;
}

/* Carries the link on along the motor's known path; gives the load at its end. */
static double carry_link(particle_t *q, const plant_t *p, const motor_t *m)
{
    double passed = 0.0;
    for (int s = 1; s <= SUBSTEPS; s++) {
        const double share = (double)s / SUBSTEPS;
        passed = load_n_mm(p, m->rad0 + (m->rad1 - m->rad0) * share - q->link_rad,
                           m->speed0 + (m->speed1 - m->speed0) * share - q->link_speed);
        push_link(q, p, passed, HISTORY_TICK_S / SUBSTEPS);
    }
    q->motor_rad = m->rad1;
    q->motor_speed = m->speed1;
    return passed;
}

static double no_tick_alone_decides(double log_l)
{
    return log_l < -40.0 ? -40.0 - log1p(-40.0 - log_l) : log_l;
}

/* How likely the motor's torque is with this load: its dry friction is known while it moves, within a bound else. */
static double log_likelihood(particle_t *q, const plant_t *p, const motor_t *m, double passed, knows_t knows,
                             dice_t *dice)
{
    const double most = p->motor_friction_n_mm;
    const double instrument = knows.exact_torque ? 0.004 * p->range_n_mm : p->noise_n_mm;
    const double changing = 0.5 * p->motor_inertia * (m->accel - m->accel_before);
    const double variance = instrument * instrument + changing * changing;
    if (m->way != 0) {
        q->friction_n_mm = m->way * most;
    } else if (dice_uniform(dice, 0.0, 1.0) < 0.02) {
        q->friction_n_mm = dice_uniform(dice, -most, most);
    } else {
        q->friction_n_mm = clamp(q->friction_n_mm + 0.03 * most * dice_normal(dice), most);
    }
    const double off = m->left_n_mm - passed;
    const bool only_bounded = knows.exact_torque && m->way == 0;
    const double beyond = only_bounded ? fmax(0.0, fabs(off) - most) : off - q->friction_n_mm;
    const double trust = only_bounded || m->way != 0 || m->stood ? 1.0 : 0.3; /* a motor that just turns */
    const double log_l = -0.5 * trust * beyond * beyond / variance;
    return no_tick_alone_decides(log_l);
}

/* The current's noise drives the motor, the encoder's step is what it is read by. */
static gains_t steady_gains(const plant_t *p)
{
    const double dt = HISTORY_TICK_S, driven = p->noise_n_mm / p->motor_inertia * dt;
    const double read_rad2 = p->step_rad * p->step_rad / 12.0;
    double angle2 = read_rad2, both = 0.0, speed2 = 1e-3;
    gains_t gains = {0};
    for (int i = 0; i < 400; i++) {
        const double speed2_then = speed2 + driven * driven, both_then = both + speed2_then * dt;
        const double angle2_then = angle2 + 2.0 * dt * both + dt * dt * speed2_then;
        gains.variance_rad2 = angle2_then + read_rad2;
        gains.angle = angle2_then / gains.variance_rad2;
        gains.speed_per_s = both_then / gains.variance_rad2;
        angle2 = (1.0 - gains.angle) * angle2_then;
        both = (1.0 - gains.angle) * both_then;
        speed2 = speed2_then - gains.speed_per_s * both_then;
    }
    return gains;
}

/* Carries motor and link on by the current as read, then sets the motor right by its encoder; gives how likely that
 * reading was. */
static double carry_both(particle_t *q, const plant_t *p, const brace_backlash_sample_t *sample, const gains_t *gains)
{
    const double dt = HISTORY_TICK_S / SUBSTEPS, torque_n_mm = (double)sample->torque_n_mm;
    for (int s = 0; s < SUBSTEPS; s++) {
        const double passed = load_n_mm(p, q->motor_rad - q->link_rad, q->motor_speed - q->link_speed);
        push_link(q, p, passed, dt);
        q->motor_speed += dt * (torque_n_mm - passed - p->motor_damping * q->motor_speed) / p->motor_inertia;
        q->motor_speed -= clamp(q->motor_speed, p->motor_friction_n_mm * dt / p->motor_inertia);
        q->motor_rad += dt * q->motor_speed;
    }
    const double off_rad = (double)sample->motor_rad + 0.5 * p->step_rad - q->motor_rad;
    q->motor_rad += gains->angle * off_rad;
    q->motor_speed += gains->speed_per_s * off_rad;
    return no_tick_alone_decides(-0.5 * off_rad * off_rad / gains->variance_rad2);
}

/* flank_cells: how far from the gap's end the answer may lie and be right on a flank; 0 if the gap itself is unsure. */
static double best_offset_rad(const cloud_t *cloud, const plant_t *p, int flank_cells)
{
    double up_to[CELLS + 1] = {0.0}, on_flank[2] = {0.0}, most = -1.0;
    for (int i = 0; i < cloud->count; i++) {
        const double apart_rad = cloud->of[i].motor_rad - cloud->of[i].link_rad, weight = exp(cloud->log_weight[i]);
        const double offset = 0.5 - apart_rad / p->gap_rad;
        if (offset <= 0.0 || offset >= 1.0) {
            on_flank[offset >= 1.0] += weight;
        } else {
            up_to[1 + (int)(offset * (CELLS - 1) + 0.5)] += weight;
        }
    }
    for (int c = 0; c < CELLS; c++) {
        up_to[c + 1] += up_to[c];
    }
    int first = 0, last = 0; /* the middle of all the cells that are equally good */
    for (int c = 0; c < CELLS; c++) {
        const int low = c - NEIGHBOURS < 0 ? 0 : c - NEIGHBOURS;
        const int high = c + NEIGHBOURS > CELLS - 1 ? CELLS - 1 : c + NEIGHBOURS;
        const double mass = up_to[high + 1] - up_to[low] + (c <= flank_cells ? on_flank[0] : 0.0) +
                            (c >= CELLS - 1 - flank_cells ? on_flank[1] : 0.0);
        if (mass > most * (1.0 + 1e-9)) {
            most = mass;
            first = last = c;
        } else if (c == last + 1 && mass > most * (1.0 - 1e-9)) {
            last = c;
        }
    }
    return (0.5 * (first + last) / (CELLS - 1) - 0.5) * p->gap_rad;
}

/* The joint as a controller may know it: what is on the motor's side as the machine believes it, the link's to 20 %. */
static plant_t as_believed(const history_t *h, dice_t *dice)
{
    plant_t p = h->plant;
    p.gap_rad = (double)h->believed.gap_rad;
    p.motor_friction_n_mm = (double)h->believed.friction_n_mm;
    p.motor_inertia = (double)h->believed.inertia_n_mm_s2_per_rad;
    p.bias_n_mm = 0.0;
    p.motor_damping = 25.0;
    p.link_damping = 50.0;
    double *const of_link[] = {&p.link_inertia, &p.gravity_n_mm, &p.link_friction_n_mm, &p.stiffness};
    for (int i = 0; i < 4; i++) {
        *of_link[i] *= dice_uniform(dice, 0.8, 1.2);
    }
    return p;
}

/* The flank on whose side of the gap most of the probability lies. */
static int best_flank(const cloud_t *cloud)
{
    double lead = 0.0;
    for (int i = 0; i < cloud->count; i++) {
        lead += copysign(exp(cloud->log_weight[i]), cloud->of[i].motor_rad - cloud->of[i].link_rad);
    }
    return (lead > 0.0) - (lead < 0.0);
}

/* The flank that touches, if that is surer than the gap's being open. */
static int flank_felt(const cloud_t *cloud, const plant_t *p)
{
    double on_flank = 0.0, open = 0.0;
    for (int i = 0; i < cloud->count; i++) {
        const double apart_rad = cloud->of[i].motor_rad - cloud->of[i].link_rad, weight = exp(cloud->log_weight[i]);
        *(fabs(apart_rad) < 0.5 * p->gap_rad ? &open : &on_flank) += weight;
    }
    return open > 0.4 * (open + on_flank) ? 0 : best_flank(cloud);
}

static void normalise_and_resample(cloud_t *cloud)
{
    double most = -INFINITY, sum = 0.0, squares = 0.0;
    for (int i = 0; i < cloud->count; i++) {
        most = fmax(most, cloud->log_weight[i]);
    }
    for (int i = 0; i < cloud->count; i++) {
        cloud->log_weight[i] -= most;
        const double weight = exp(cloud->log_weight[i]);
        sum += weight;
        squares += weight * weight;
    }
    if (sum * sum / squares >= 0.5 * cloud->count) {
        return;
    }
    const double start = dice_uniform(&cloud->dice, 0.0, 1.0);
    double passed = exp(cloud->log_weight[0]);
    for (int i = 0, from = 0; i < cloud->count; i++) {
        while (passed < (start + i) / cloud->count * sum && from < cloud->count - 1) {
            passed += exp(cloud->log_weight[++from]);
        }
        cloud->resampled[i] = cloud->of[from];
    }
    memcpy(cloud->of, cloud->resampled, sizeof *cloud->of * (size_t)cloud->count);
    memset(cloud->log_weight, 0, sizeof *cloud->log_weight * (size_t)cloud->count);
}

/* reach_gaps: how far the motor may leave its setpoint to feel for a flank; 0: not */
int backlash_oracle(uint64_t seed, int particles, int exact_torque, int known_world, int exact_joint, double reach_gaps,
                    oracle_counts_t *counts)
{
    static particle_t of[PARTICLES_MOST], resampled[PARTICLES_MOST];
    static double log_weight[PARTICLES_MOST];
    if (particles < 1 || particles > PARTICLES_MOST) {
        return -1;
    }
    const knows_t knows = {exact_torque != 0, known_world != 0, exact_joint != 0};
    history_t h = history_begin(seed, GAP_WITHIN_20_PERCENT, false, SLIPS);
    cloud_t cloud = {of, resampled, log_weight, particles, {seed * 77u + 5u}};
    const plant_t *real = &h.plant, known = knows.exact_joint ? *real : as_believed(&h, &cloud.dice), *p = &known;
    const gains_t gains = steady_gains(p);
    begin(&cloud, p, real->motor_rad);
    motor_t m = {.rad1 = real->motor_rad};
    int since_open = HISTORY_TICKS;
    for (int tick = 0; tick < HISTORY_TICKS; tick++) {
        const bool held_before = h.segment.held;
        const brace_backlash_sample_t sample = history_tick(&h);
        const double torque = knows.exact_torque ? real->torque_n_mm : (double)sample.torque_n_mm - p->bias_n_mm;
        m = (motor_t){.rad0 = m.rad1,
                      .rad1 = real->motor_rad,
                      .speed0 = m.speed1,
                      .speed1 = real->motor_speed,
                      .accel = (real->motor_speed - m.speed1) / HISTORY_TICK_S,
                      .accel_before = m.accel};
        m.way = way_of(m.speed0, m.speed1);
        m.stood = m.speed0 == 0.0 && m.speed1 == 0.0;
        m.left_n_mm = torque - p->motor_inertia * m.accel - 0.5 * p->motor_damping * (m.speed0 + m.speed1);
        for (int i = 0; i < particles; i++) {
            particle_t *q = &of[i];
            rejuvenate(q, p, knows, &cloud.dice);
            if (knows.known_world) {
                world_as_known(q, &h, h.segment.held && !held_before, &cloud.dice);
            } else {
                world_as_assumed(q, p, &cloud.dice);
            }
            if (knows.exact_joint) {
                const double passed = carry_link(q, p, &m);
                log_weight[i] += log_likelihood(q, p, &m, passed, knows, &cloud.dice);
            } else {
                log_weight[i] += carry_both(q, p, &sample, &gains);
            }
        }
        normalise_and_resample(&cloud);
        const double offset_rad = best_offset_rad(&cloud, p, knows.exact_joint ? NEIGHBOURS : 0);
        history_feel_for_flank(&h, flank_felt(&cloud, p), offset_rad, reach_gaps);
        const double error = fabs(offset_rad - plant_offset_rad(real)) / real->gap_rad;
        const int bin = (int)(error * 10000.0 + 0.5);
        counts->error[bin < BINS ? bin : BINS - 1] += 1.0;
        counts->ticks += 1.0;
        counts->beyond_a_tenth += bin > 1000;
        counts->open_beyond_a_tenth += bin > 1000 && plant_flank(real) == 0;
        since_open = plant_flank(real) == 0 ? 0 : since_open + 1;
        if (since_open > DETECTION_TICKS) {
            counts->judged += 1.0;
            counts->flank_wrong += best_flank(&cloud) != plant_flank(real);
        }
    }
    return 0;
}
