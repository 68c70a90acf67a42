/* Faults of sensors, each on a limb by lot that rests, moves or is pressed. Beside each run goes the same run without
 * the fault: same limb, same noise. A tick counts as wrong where K is valid and carries no flag, and an entry of K is
 * further from that of the other run than three of the sigmas that the controller reports with it. Where it reports
 * none, K may be off by anything; there K is held against what the other run had between the time that the snapshot
 * names and now, with the sigmas of the calibration alone. Where the samples are old, its angle counts the way that a
 * joint may have moved meanwhile before K is flagged as STALE (docs/errors.md).
 *
 *   faults [COUNT [SEED]]    COUNT faults (default 330), the kinds in turn
 *
 * Prints for each kind: faults, how many were reported (a fault of the controller, a flag or an invalid K that the
 * other run does not have), how many had wrong ticks, how many ticks that were at most in a row, and how far off the
 * worst of them was, in what is allowed. Exit code 1: a kind that breaks a bound of physics has a wrong tick. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app_bench.h"
#include "kinds.h"

enum { SETTLED = 400, WATCHED = 600, FAULTS_A_LIMB = 10, LIMBS_TRIED = 50 };
#define SIGMAS 3.0
#define LEAST_OFF 1e-4 /* of K's largest entry: less is no difference */

typedef struct {
    bool is_usable; /* valid, and without a flag */
    bool has_sigma;
    uint32_t flags, faults;
    int32_t taken_tick;
    float k_n_per_mm[3], sigma_n_per_mm[3];
} state_t;

typedef struct {
    unsigned long faults, reported, wrong_faults, wrong_ticks, longest, slowest;
    double worst;
} tally_t;

static plant_t plant;
static sensors_t sensed;
static state_t clean[SETTLED + WATCHED];
static brace_app_t settled_app;
static brace_fake_t settled_fake;
static tally_t tallies[KIND_COUNT];
static bool is_verbose; /* print each fault that was wrong */

void setUp(void) {}

void tearDown(void) {}

static int32_t read_joint(void *context, int32_t index, brace_hal_joint_t *joint)
{
    (void)context;
    if (sensed.joint_answer[index] >= 0) {
        *joint = sensed.joint[index];
    }
    return sensed.joint_answer[index];
}

static int32_t read_force(void *context, float *x_n, float *z_n)
{
    (void)context;
    if (sensed.force_answer >= 0) {
        *x_n = sensed.force_x_n;
        *z_n = sensed.force_z_n;
    }
    return sensed.force_answer;
}

static void start(void)
{
    brace_fake_start(&fake);
    fake.hal.joint_read = read_joint;
    fake.hal.tip_force_read = plant.has_force ? read_force : NULL;
    bench_store(&plant.parameters);
    plant_sense(&plant, 0, fake.now_us, &sensed);
    if (brace_app_start(&app, &fake.hal) != BRACE_OK) {
        exit(2);
    }
}

static state_t tick_once(int32_t tick, fault_t *fault)
{
    const uint32_t tick_us = fake.now_us + TICK_US;
    plant_sense(&plant, tick, tick_us, &sensed);
    if (fault != NULL) {
        fault_spoil(fault, &plant, tick, tick_us, &sensed);
    }
    ticks(1);
    const brace_snapshot_t *s = now();
    const brace_stiffness_t *k = &s->stiffness.now;
    state_t state = {.is_usable = s->k_is_valid && k->flags == 0u,
                     .has_sigma = s->sigma_is_known,
                     .flags = k->flags,
                     .faults = s->faults,
                     .taken_tick = tick - (int32_t)((tick_us - s->taken_us) / (uint32_t)TICK_US),
                     .k_n_per_mm = {k->k_xx_n_per_mm, k->k_xz_n_per_mm, k->k_zz_n_per_mm}};
    if (state.is_usable) {
        brace_stiffness_sigma_t sigma = s->sigma;
        brace_limb_t limb = plant.parameters.limb;
        const float unseen_rad = state.taken_tick < tick ? 1.5f * limb.uncertainty.angle_rad + 0.001f : 0.0f;
        limb.uncertainty.angle_rad = hypotf(limb.uncertainty.angle_rad, unseen_rad);
        if (!state.has_sigma && brace_uncertainty_known(&limb, s->theta_rad[BRACE_FEMUR], s->theta_rad[BRACE_TIBIA], k,
                                                        &sigma) != BRACE_OK) {
            sigma = (brace_stiffness_sigma_t){0};
        }
        state.sigma_n_per_mm[0] = sigma.k_xx_n_per_mm;
        state.sigma_n_per_mm[1] = sigma.k_xz_n_per_mm;
        state.sigma_n_per_mm[2] = sigma.k_zz_n_per_mm;
    }
    return state;
}

/* A limb whose K is usable in every tick once it has settled: the others say by themselves that theirs is not. */
static bool settle(uint32_t seed, phase_t phase)
{
    plant_draw(&plant, seed, phase);
    if (brace_parameters_check(&plant.parameters, NULL) != BRACE_OK) {
        return false;
    }
    start();
    for (int32_t tick = 0; tick < SETTLED + WATCHED; tick++) {
        if (tick == SETTLED) {
            settled_app = app;
            settled_fake = fake;
        }
        clean[tick] = tick_once(tick, NULL);
        if (tick >= SETTLED && !clean[tick].is_usable) {
            return false;
        }
    }
    return true;
}

/* How far K is off, in three sigmas of it: the largest of its entries. */
static double off_by(const state_t *with, int32_t tick)
{
    const int32_t first = with->has_sigma ? tick : with->taken_tick;
    double worst = 0.0, most = 0.0;
    double norm = 0.0;
    for (int i = 0; i < 3; i++) {
        double low = INFINITY, high = -INFINITY;
        for (int32_t at = first < 0 ? 0 : first; at <= tick; at++) {
            if (clean[at].is_usable) {
                low = fmin(low, (double)clean[at].k_n_per_mm[i]);
                high = fmax(high, (double)clean[at].k_n_per_mm[i]);
            }
        }
        const double k = (double)with->k_n_per_mm[i], off = fmax(0.0, fmax(low - k, k - high));
        norm = fmax(norm, fmax(fabs(low), fabs(high)));
        most = fmax(most, off);
        worst = fmax(worst, off > 0.0 ? off / (SIGMAS * (double)with->sigma_n_per_mm[i]) : 0.0);
    }
    return most < LEAST_OFF * norm ? 0.0 : worst;
}

static void judge(fault_t *fault, uint32_t number)
{
    tally_t *tally = &tallies[fault->kind];
    const bool from_start = fault->from == 0;
    unsigned long wrong = 0, row = 0, longest = 0;
    int32_t reported_at = -1;
    double worst = 0.0;
    if (from_start) {
        start();
    } else {
        app = settled_app;
        fake = settled_fake;
    }
    /* From where the limb had settled on: the controller has to see the ticks before the fault, too. */
    for (int32_t tick = from_start ? 0 : SETTLED; tick < SETTLED + WATCHED; tick++) {
        const state_t state = tick_once(tick, fault);
        const bool is_watched = clean[tick].is_usable;
        const double off = is_watched && state.is_usable ? off_by(&state, tick) : 0.0;
        const bool is_off = off > 1.0;
        worst = fmax(worst, is_off ? off : 0.0);
        const bool is_reported = (is_watched && !state.is_usable) || state.faults != clean[tick].faults;
        reported_at = is_reported && reported_at < 0 ? tick : reported_at;
        wrong += is_off;
        row = is_off ? row + 1u : 0u;
        longest = row > longest ? row : longest;
    }
    if (is_verbose && wrong != 0u) {
        printf("  %u: %s, joint %d, encoder %d, phase %d, seed %u, size %g, other %g: %lu ticks wrong, %.2f times\n",
               (unsigned)number, kind_name(fault->kind), fault->joint, (int)fault->encoder, (int)plant.phase,
               (unsigned)plant.seed, fault->size, fault->other, wrong, worst);
    }
    tally->faults++;
    tally->reported += reported_at >= 0;
    const unsigned long after = reported_at >= 0 ? (unsigned long)(reported_at - fault->from) : 0u;
    tally->slowest = after > tally->slowest ? after : tally->slowest;
    tally->wrong_faults += wrong != 0u;
    tally->wrong_ticks += wrong;
    tally->longest = longest > tally->longest ? longest : tally->longest;
    tally->worst = fmax(tally->worst, worst);
}

static void print_kind(kind_t kind)
{
    const tally_t *t = &tallies[kind];
    printf("%-18s | %-66s | %6lu | %8lu | %7lu ms | %6lu | %7lu ms | %6.2f\n", kind_name(kind), kind_says(kind),
           t->faults, t->reported, t->slowest, t->wrong_faults, t->longest, t->worst);
}

int main(int argc, char **argv)
{
    const int count = argc > 1 ? atoi(argv[1]) : 330;
    const uint32_t seed = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 1u;
    is_verbose = argc > 3;
    uint32_t limbs = 0, drawn = 0;
    unsigned long wrong = 0;
    kind_t kind = 0;
    for (int number = 0; number < count;) {
        bool found = false;
        for (int i = 0; i < LIMBS_TRIED && !found; i++) {
            found = settle(1000003u * seed + drawn, (phase_t)(limbs % PHASE_COUNT));
            drawn++;
        }
        if (!found) {
            fprintf(stderr, "faults: no limb with a usable K among %d\n", LIMBS_TRIED);
            return 2;
        }
        limbs++;
        for (int i = 0; i < FAULTS_A_LIMB && number < count; i++, kind = (kind + 1u) % KIND_COUNT) {
            fault_t fault;
            const int32_t from = kind == KIND_APART_FROM_START ? 0 : SETTLED + i;
            if (fault_draw(&fault, kind, &plant, from, seed + 7919u * (uint32_t)number + limbs)) {
                judge(&fault, (uint32_t)number);
                number++;
            }
        }
    }
    printf("%-18s | %-66s | faults | reported | after most | wrong  | unseen most | worst\n", "kind", "");
    for (kind_t k = 0; k < KIND_COUNT; k++) {
        print_kind(k);
        wrong += kind_breaks_a_bound(k) ? tallies[k].wrong_ticks : 0u;
    }
    printf("%d faults on %u limbs of %u drawn; kinds that break a bound: %lu wrong ticks\n", count, (unsigned)limbs,
           (unsigned)drawn, wrong);
    return wrong == 0u ? 0 : 1;
}
