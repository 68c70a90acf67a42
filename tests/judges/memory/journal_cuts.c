/* Power fails at every single write step of the drift check's journal, in every manner of nvm_model.h, and again in
 * what follows. After each failure a start has to find the record before or the new one, whole, the store's part of the
 * slot has to be as it was, and the next record has to be kept as if nothing had been.
 *
 *   journal_cuts            single failures with units of 1, 2, 4, 8 bytes; pairs of failures with units of 8
 *   journal_cuts --in-turn  the same; each step fails in one manner, the next step in the next manner
 *   journal_cuts --broken   for a journal broken on purpose: 0 when the enumeration finds it out
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brace/drift.h"
#include "brace/journal.h"
#include "nvm_model.h"

enum { SLOT = 1, IDENTITY = 77, STARTS_UNSTABLE = 4, NONE = 0, RECORDS = 2, LAST = 100, BETWEEN = 50 };

static bool expect_broken;
static bool in_turn; /* a step fails in one manner only */
static nvm_t before; /* as the store left it: a block and marks below the journal, a whole other slot */
static unsigned long cases, starts;

static struct {
    uint32_t unit;
    int record;
    int32_t first_step, second_step;
    cut_manner_t first_manner, second_manner;
} now;

static void require(bool holds, const char *what, int found)
{
    if (holds) {
        return;
    }
    if (expect_broken) {
        printf("found out after %lu cases: %s (%d)\n", cases, what, found);
        exit(0);
    }
    printf("journal_cuts: %s (%d)\n  unit %u, record %d, failure at step %d manner %d, then at step %d manner %d\n",
           what, found, (unsigned)now.unit, now.record, (int)now.first_step, (int)now.first_manner,
           (int)now.second_step, (int)now.second_manner);
    exit(1);
}

typedef struct {
    brace_hal_t hal;
    brace_journal_t journal;
    int newest; /* which state it has found; NONE */
} limb_t;

/* State number n: no two alike in any unit, and zeros and 0xff among them. */
static void compose(brace_drift_t *state, int n)
{
    uint8_t *byte = (uint8_t *)state;
    for (uint32_t i = 0; i < sizeof *state; i++) {
        byte[i] = (uint8_t)(i % 16u < 4u ? 0u : i % 16u < 8u ? 0xffu : i * 31u + (uint32_t)n * 7u);
    }
    state->steps = (uint32_t)n;
}

static void start(limb_t *limb, nvm_t *nvm)
{
    brace_drift_t found, expected;
    memset(&found, 0, sizeof found);
    limb->hal = nvm_hal(nvm);
    brace_journal_open(&limb->journal, &limb->hal, SLOT, IDENTITY);
    for (int i = 0; i < BRACE_JOURNAL_SCANS && brace_journal_scan(&limb->journal, &found); i++) {
    }
    limb->newest = limb->journal.found ? (int)found.steps : NONE;
    starts++;
    compose(&expected, limb->newest);
    require(limb->newest == NONE || memcmp(&found, &expected, sizeof found) == 0, "a state that nobody kept",
            limb->newest);
    require(memcmp(nvm->bytes[SLOT], before.bytes[SLOT], BRACE_JOURNAL_AT) == 0 &&
                memcmp(nvm->unstable[SLOT], before.unstable[SLOT], BRACE_JOURNAL_AT) == 0,
            "the store's part is touched", 0);
    require(memcmp(nvm->bytes[1 - SLOT], before.bytes[1 - SLOT], NVM_SLOT_BYTES) == 0, "the other slot is touched", 0);
}

static brace_journal_state_t keep(limb_t *limb, const nvm_t *nvm, int n)
{
    brace_drift_t state;
    compose(&state, n);
    require(brace_journal_begin(&limb->journal, &state), "no room", n);
    brace_journal_state_t step = BRACE_JOURNAL_BUSY;
    for (int i = 0; i < 2 * BRACE_JOURNAL_PIECES && step == BRACE_JOURNAL_BUSY && !nvm->dead; i++) {
        step = brace_journal_step(&limb->journal);
    }
    return step;
}

static int starts_after(cut_manner_t manner)
{
    return manner >= CUT_UNSTABLE ? STARTS_UNSTABLE : 1;
}

/* Is this manner to be tried at this step? In turn: every `manners`-th step. */
static bool has_turn(int32_t step, int manner, int manners)
{
    return !in_turn || step % manners == manner;
}

/* From here on everything works: two records in this session, one in the next; or but the first. */
static void go_on(const nvm_t *left, uint32_t lot, int records)
{
    static nvm_t nvm;
    limb_t limb;
    nvm = *left;
    nvm.random += lot;
    nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
    for (int i = 0; i < records; i++) {
        if (i != 1) {
            start(&limb, &nvm);
        }
        require(keep(&limb, &nvm, LAST + i) == BRACE_JOURNAL_READY, "an undisturbed record is not kept", i);
        limb_t after;
        start(&after, &nvm);
        require(after.newest == LAST + i, "another record than the last one", after.newest);
    }
    require(nvm.misuse == 0, "a unit is written twice", (int)nvm.misuse);
}

/* A second failure, in the record that follows the first. */
static void fail_again(const nvm_t *left, int old, int new, const cut_manner_t *manners, int manner_count)
{
    static nvm_t nvm;
    limb_t limb;
    for (int m = 0; m < manner_count; m++) {
        now.second_manner = manners[m];
        for (now.second_step = 1;; now.second_step++) {
            /* Every first manner meets every second one. */
            if (!has_turn(now.first_step / manner_count + now.second_step, m, manner_count)) {
                continue;
            }
            nvm = *left;
            nvm.random += (uint32_t)now.second_step;
            nvm_power(&nvm, now.second_step, manners[m]);
            start(&limb, &nvm);
            keep(&limb, &nvm, BETWEEN);
            if (!nvm.dead) {
                break;
            }
            nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
            for (int i = 0; i < starts_after(now.first_manner > manners[m] ? now.first_manner : manners[m]); i++) {
                start(&limb, &nvm);
                require(limb.newest == old || limb.newest == new || limb.newest == BETWEEN,
                        "after two failures: none of the records that may be", limb.newest);
            }
            go_on(&nvm, (uint32_t)now.second_step, 1);
            cases++;
        }
    }
    now.second_step = 0;
}

/* Record n of the journal in `left`, failing at each of its steps in each manner;
 * in_session: not the session's first. */
static int32_t fail_everywhere(const nvm_t *left, int n, bool in_session, bool pairs)
{
    static const cut_manner_t pair_manners[] = {CUT_BEFORE, CUT_AFTER, CUT_RANDOM_BITS, CUT_UNSTABLE_WHOLE};
    static nvm_t nvm;
    limb_t limb;
    int32_t steps = 0;
    const int manner_count = pairs ? (int)(sizeof pair_manners / sizeof *pair_manners) : CUT_MANNER_COUNT;
    for (int m = 0; m < manner_count; m++) {
        now.first_manner = pairs ? pair_manners[m] : (cut_manner_t)m;
        for (now.first_step = 1;; now.first_step++) {
            if (!has_turn(now.first_step, m, manner_count)) {
                continue;
            }
            nvm = *left;
            nvm.random += (uint32_t)now.first_step;
            nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
            start(&limb, &nvm);
            int old = limb.newest;
            if (in_session) {
                require(keep(&limb, &nvm, n - 1) == BRACE_JOURNAL_READY, "an undisturbed record is not kept", n - 1);
                old = n - 1;
            }
            nvm_power(&nvm, now.first_step, now.first_manner);
            keep(&limb, &nvm, n);
            if (!nvm.dead) {
                break;
            }
            steps = now.first_step > steps ? now.first_step : steps;
            nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
            for (int i = 0; i < (pairs ? (starts_after(now.first_manner) + 1) / 2 : starts_after(now.first_manner));
                 i++) {
                start(&limb, &nvm);
                require(limb.newest == old || limb.newest == n, "neither the old record nor the new one", limb.newest);
                if (pairs) {
                    fail_again(&nvm, old, n, pair_manners, manner_count);
                } else {
                    go_on(&nvm, (uint32_t)i, 3);
                }
            }
            cases++;
        }
    }
    return steps;
}

static int32_t enumerate(uint32_t unit, bool pairs)
{
    static nvm_t nvm;
    limb_t limb;
    int32_t steps = 0;
    nvm_init(&before, unit);
    memset(before.bytes[1 - SLOT], 0x5a, NVM_SLOT_BYTES);
    memset(before.bytes[SLOT], 0x5a, BRACE_JOURNAL_AT);
    nvm = before;
    now.unit = unit;
    for (now.record = 1; now.record <= (pairs ? 1 : RECORDS); now.record++) {
        steps += fail_everywhere(&nvm, now.record, false, pairs);
        if (now.record > 1) { /* the same as the second record of its session */
            steps += fail_everywhere(&before, now.record, true, pairs);
        }
        nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
        start(&limb, &nvm);
        require(keep(&limb, &nvm, now.record) == BRACE_JOURNAL_READY, "an undisturbed record is not kept", now.record);
    }
    require(nvm.misuse == 0, "a unit is written twice", (int)nvm.misuse);
    return steps;
}

int main(int argc, char **argv)
{
    expect_broken = argc == 2 && strcmp(argv[1], "--broken") == 0;
    in_turn = argc == 2 && strcmp(argv[1], "--in-turn") == 0;
    if (argc > 2 || (argc == 2 && !expect_broken && !in_turn)) {
        fprintf(stderr, "usage: journal_cuts [--in-turn | --broken]\n");
        return 2;
    }
    for (uint32_t unit = 1; unit <= 8; unit *= 2) {
        const int32_t steps = enumerate(unit, false);
        printf("units of %u bytes: power fails at %d steps of three records in %d manners%s\n", (unsigned)unit,
               (int)steps, CUT_MANNER_COUNT, in_turn ? " in turn" : "");
    }
    printf("single failures: %lu cases, %lu starts: the old record or the new one, whole, each time\n", cases, starts);
    const unsigned long single = cases;
    (void)enumerate(8, true);
    printf("pairs of failures: %lu cases: one of the records that may be, whole, each time\n", cases - single);
    if (expect_broken) {
        printf("journal_cuts: a journal broken on purpose was not found out\n");
        return 1;
    }
    return 0;
}
