/* Bits of the newest parameter set flip in the non-volatile memory, block and marks: each bit alone, and bursts of 2 to
 * 64 bits that begin at each bit (both ends flip, what is between them by lot). After each a controller starts. Until
 * its first K that is valid and carries no UNCALIBRATED, either the newest set has to be in force, or OLD_PARAMETERS
 * (or PARAMETERS, where there is no other set) has to have been reported; and the sequence that was wanted has to be
 * named. Slots as this firmware writes them; and slots as an earlier one did, without the mark PAST, where a rotten
 * mark looks like one that was never written to its end, so that only the block's bits are judged.
 *
 *   rotten_sets [EVERY]    each EVERY-th bit (default 1: all)
 *
 * Also: after a roll-back, no flip in the marks of the set that was left brings it back, and none is called rot.
 * Exit code 1: a set of before was in force and nothing reported it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app_bench.h"

enum { OLD = 0, NEW = 1, TICKS = 8, MARKS_USED = 16, BURST_MOST = 64 };
enum { BLOCK_BITS = 8 * BRACE_BLOCK_BYTES, MARK_BITS = 8 * BRACE_STORE_MARK_BYTES * MARKS_USED };

static brace_fake_t whole; /* both sets stored, nothing rotten */
static float k_new_n_per_mm;
static uint32_t lots = 2463534242u;

static struct {
    unsigned long flips, in_force, reported, misnamed, silent;
} count;

void setUp(void) {}

void tearDown(void) {}

static uint32_t lot(void)
{
    lots ^= lots << 13;
    lots ^= lots >> 17;
    lots ^= lots << 5;
    return lots;
}

static void store_two(bool has_past)
{
    brace_parameters_t set = bench_parameters();
    bench_board();
    bench_store(&set);
    const brace_fake_t before = fake;
    set.limb.link[BRACE_TIBIA].bending_mm_per_n *= 2.0f;
    bench_store(&set);
    if (!has_past) {
        memcpy(fake.nvm[OLD], before.nvm[OLD], sizeof fake.nvm[OLD]);
    }
    whole = fake;
    if (brace_app_start(&app, &fake.hal) != BRACE_OK) {
        exit(2);
    }
    ticks(TICKS);
    k_new_n_per_mm = now()->stiffness.now.k_xx_n_per_mm;
    if (!now()->k_is_valid || now()->faults != 0u || now()->parameter_origin != BRACE_PARAMETERS_SLOT_B) {
        fprintf(stderr, "rotten_sets: no valid K of the newest set to begin with\n");
        exit(2);
    }
}

static uint8_t *byte_of(uint32_t bit)
{
    const uint32_t at = bit < BLOCK_BITS ? bit / 8u : BRACE_STORE_MARKS_AT + (bit - BLOCK_BITS) / 8u;
    return &fake.nvm[NEW][at];
}

/* A burst: its ends flip, and what is between them by lot. It ends with the block, or with the marks. */
static void flip(uint32_t bit, uint32_t bits)
{
    const uint32_t end = bit < BLOCK_BITS ? BLOCK_BITS : BLOCK_BITS + MARK_BITS;
    for (uint32_t i = 0; i < bits && bit + i < end; i++) {
        if (i == 0u || i + 1u == bits || (lot() & 1u) != 0u) {
            *byte_of(bit + i) ^= (uint8_t)(1u << (bit + i) % 8u);
        }
    }
}

/* A controller starts on what is there now. */
static void judge(uint32_t bit, uint32_t bits)
{
    count.flips++;
    if (brace_app_start(&app, &fake.hal) != BRACE_OK) {
        exit(2);
    }
    bool is_reported = false;
    for (int i = 0; i < TICKS; i++) {
        ticks(1);
        const brace_snapshot_t *s = now();
        is_reported = is_reported || (s->faults & (BRACE_FAULT_OLD_PARAMETERS | BRACE_FAULT_PARAMETERS)) != 0u;
        const bool is_bare = s->k_is_valid && (s->stiffness.now.flags & BRACE_FLAG_UNCALIBRATED) == 0u;
        if (is_bare && s->stiffness.now.k_xx_n_per_mm != k_new_n_per_mm) {
            count.silent++;
            fprintf(stderr, "rotten_sets: bit %u, %u bits: the older set, and no flag\n", (unsigned)bit,
                    (unsigned)bits);
            return;
        }
    }
    count.reported += is_reported;
    count.in_force += !is_reported;
    const bool is_named = now()->parameter_sequence_wanted == 2u || !is_reported;
    count.misnamed += !is_named;
}

static void try_all(const char *what, uint32_t every, bool has_past)
{
    static const uint32_t lengths[] = {1, 2, 3, 5, 8, 13, 21, 32, 64};
    memset(&count, 0, sizeof count);
    store_two(has_past);
    for (uint32_t l = 0; l < sizeof lengths / sizeof *lengths; l++) {
        const uint32_t end = has_past ? BLOCK_BITS + MARK_BITS : BLOCK_BITS;
        for (uint32_t bit = l % every; bit < end; bit += every) {
            fake = whole;
            flip(bit, lengths[l]);
            judge(bit, lengths[l]);
        }
    }
    printf("%-44s %8lu %10lu %10lu %9lu %7lu\n", what, count.flips, count.reported, count.in_force, count.misnamed,
           count.silent);
}

/* After a roll-back the older set is the one that is wanted, whatever happens to the marks of the other. */
static bool roll_back_stands(uint32_t every)
{
    brace_store_t store;
    brace_parameters_t set;
    unsigned long flips = 0, wrong = 0;
    store_two(true);
    fake = whole;
    (void)brace_store_start(&store, &fake.hal, &set);
    (void)brace_store_rollback(&store);
    for (int i = 0; i < 1000 && store.state == BRACE_STORE_BUSY; i++) {
        (void)brace_store_step(&store);
    }
    whole = fake;
    for (uint32_t bits = 1; bits <= BURST_MOST; bits *= 2u) {
        for (uint32_t bit = BLOCK_BITS; bit < BLOCK_BITS + MARK_BITS; bit += every) {
            fake = whole;
            flip(bit, bits);
            flips++;
            const brace_parameter_origin_t origin = brace_store_start(&store, &fake.hal, &set);
            wrong += origin != BRACE_PARAMETERS_SLOT_A || store.is_old;
        }
    }
    printf("%-44s %8lu %42lu\n", "rolled back, the other's marks: not so", flips, wrong);
    return wrong == 0u;
}

int main(int argc, char **argv)
{
    const int every = argc > 1 ? atoi(argv[1]) : 1;
    if (every < 1) {
        fprintf(stderr, "usage: rotten_sets [EVERY]\n");
        return 2;
    }
    printf("%-44s %8s %10s %10s %9s %7s\n", "", "flips", "reported", "in force", "misnamed", "silent");
    try_all("marks as they are written", (uint32_t)every, true);
    bool good = count.silent == 0u && count.misnamed == 0u;
    try_all("without PAST, as an earlier firmware left it", (uint32_t)every, false);
    good = good && count.silent == 0u;
    /* Without the mark the number that is wanted stands in the damaged block alone, so a flip of it is misnamed. */
    good = roll_back_stands((uint32_t)every) && good;
    return good ? 0 : 1;
}
