/* Every bit of parameters, of constants made from them, and of some of the state of a tick flips, one at a time, by
 * itself. Within 100 ms MEMORY has to be set and K invalid; or K stays within 0.1 % of what it was, or says that it is
 * not to be used (invalid, or flagged).
 *
 *   bit_flips [EVERY]    each EVERY-th bit (default 1: all)
 *
 * Prints, for each part of the memory: bits, seen (by MEMORY), the longest time until then, without effect on K,
 * reported otherwise (K invalid or flagged), and wrong. Exit code 1: a flip in parameters or in constants made from
 * them was wrong. What was wrong elsewhere is counted, and not judged: it is the state of the tick, which each tick
 * makes anew.
 *
 * Tables of the firmware are const. They lie in flash, where no bit of RAM can flip them. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app_bench.h"

enum { WITHIN_TICKS = 100, SETTLED_TICKS = 20 };

typedef struct {
    const char *name;
    size_t from, end; /* of controller_t */
    bool is_judged;
} part_t;

#define AT(member) offsetof(controller_t, member)
#define PART(member, judged) \
    { \
        #member, AT(member), AT(member) + sizeof(((controller_t *)0)->member), judged \
    }
static const part_t parts[] = {
    {"parameters.in_force", AT(parameters.in_force), AT(parameters.store), true},
    PART(model.is_spatial, true),
    PART(model.springs_change, true),
    PART(model.is_collapsed, true),
    PART(model.planar, true),
    PART(model.general, true),
    {"model.spatial", AT(model.spatial), AT(model.spatial.yaw_rad_per_n_mm), true},
    PART(model.loaded, true),
    PART(model.loaded_space, true),
    {"tip_force, its constants", AT(tip_force.fitted), AT(tip_force) + sizeof(tip_force_t), true},
    PART(gravity, true),
    {"flank, coxa joint's constants", AT(flank.joint[BRACE_COXA]), AT(flank.joint[BRACE_COXA].machine.started), true},
    {"flank, femur joint's constants", AT(flank.joint[BRACE_FEMUR]), AT(flank.joint[BRACE_FEMUR].machine.started),
     true},
    {"flank, tibia joint's constants", AT(flank.joint[BRACE_TIBIA]), AT(flank.joint[BRACE_TIBIA].machine.started),
     true},
    PART(joints, false),
    PART(posture, false),
};
enum { PARTS = sizeof parts / sizeof *parts };

typedef struct {
    uint32_t bits, seen, slowest_ticks, harmless, reported, wrong;
} outcome_t;

static brace_app_t whole_app;
static brace_fake_t whole_fake;
static float k_n_per_mm[3];

void setUp(void) {}

void tearDown(void) {}

/* A limb with play in one joint and springs that a model in space knows. */
static void start(bool in_space)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_TIBIA].gap_rad = in_space ? 0.0f : 0.004f;
    bench_board();
    bench_store(&p);
    fake.joint[BRACE_COXA].absent = !in_space;
    fake.force_z_n = 3.0f;
    fake.joint[BRACE_FEMUR].sample.torque_n_mm = -900.0f;
    fake.joint[BRACE_TIBIA].sample.torque_n_mm = 800.0f;
    if (brace_app_start(&app, &fake.hal) != BRACE_OK) {
        exit(2);
    }
    ticks(400);
    whole_app = app;
    whole_fake = fake;
    const brace_stiffness_t *k = &now()->stiffness.now;
    k_n_per_mm[0] = k->k_xx_n_per_mm;
    k_n_per_mm[1] = k->k_xz_n_per_mm;
    k_n_per_mm[2] = k->k_zz_n_per_mm;
    if (!now()->k_is_valid) {
        fprintf(stderr, "bit_flips: no valid K to begin with (flags %x)\n", (unsigned)k->flags);
        exit(2);
    }
}

static bool k_is_as_before(void)
{
    const brace_stiffness_t *k = &now()->stiffness.now;
    const float scale = fabsf(k_n_per_mm[0]) > fabsf(k_n_per_mm[2]) ? fabsf(k_n_per_mm[0]) : fabsf(k_n_per_mm[2]);
    const float most = 1e-3f * scale;
    return fabsf(k->k_xx_n_per_mm - k_n_per_mm[0]) <= most && fabsf(k->k_xz_n_per_mm - k_n_per_mm[1]) <= most &&
           fabsf(k->k_zz_n_per_mm - k_n_per_mm[2]) <= most;
}

static void flip(const part_t *part, uint32_t bit, outcome_t *outcome)
{
    app = whole_app;
    fake = whole_fake;
    const uint32_t flags = now()->stiffness.now.flags;
    ((uint8_t *)&app.controller)[part->from + bit / 8u] ^= (uint8_t)(1u << bit % 8u);
    outcome->bits++;
    for (uint32_t i = 1; i <= WITHIN_TICKS; i++) {
        ticks(1);
        if ((now()->faults & (uint32_t)BRACE_FAULT_MEMORY) != 0u && !now()->k_is_valid) {
            outcome->seen++;
            outcome->slowest_ticks = i > outcome->slowest_ticks ? i : outcome->slowest_ticks;
            return;
        }
    }
    ticks(SETTLED_TICKS);
    if (!now()->k_is_valid || (now()->stiffness.now.flags & ~flags) != 0u) {
        outcome->reported++;
    } else if (k_is_as_before()) {
        outcome->harmless++;
    } else {
        outcome->wrong++;
    }
}

static bool flip_all(uint32_t every)
{
    bool good = true;
    printf("%-42s %7s %7s %8s %9s %8s %6s\n", "part", "bits", "seen", "slowest", "harmless", "reported", "wrong");
    for (int i = 0; i < PARTS; i++) {
        const part_t *part = &parts[i];
        outcome_t outcome = {0};
        for (uint32_t bit = (uint32_t)i % every; bit < 8u * (part->end - part->from); bit += every) {
            flip(part, bit, &outcome);
        }
        printf("%-42s %7u %7u %5u ms %9u %6u %6u%s\n", part->name, (unsigned)outcome.bits, (unsigned)outcome.seen,
               (unsigned)outcome.slowest_ticks, (unsigned)outcome.harmless, (unsigned)outcome.reported,
               (unsigned)outcome.wrong, part->is_judged ? "" : "  (not judged)");
        good = good && (outcome.wrong == 0u || !part->is_judged);
    }
    return good;
}

int main(int count, char **arguments)
{
    const int every = count > 1 ? atoi(arguments[1]) : 1;
    if (every < 1) {
        fprintf(stderr, "usage: bit_flips [EVERY]\n");
        return 2;
    }
    printf("a limb in its plane\n");
    start(false);
    bool good = flip_all((uint32_t)every);
    printf("a limb in space\n");
    start(true);
    good = flip_all((uint32_t)every) && good;
    return good ? 0 : 1;
}
