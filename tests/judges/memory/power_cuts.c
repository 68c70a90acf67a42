/* Power fails at every single write and erase step of updates and roll-backs of the parameter store, in every manner of
 * nvm_model.h; and again in what follows. Nothing is sampled. After each failure the limb has to start with the old
 * set or the new one, whole, say which, and go on as if nothing had been.
 *
 * No failure may look like a set that has rotted. Where one has, no failure of the next update may hide that the set in
 * force is an older one.
 *
 *   power_cuts              single failures with units of 1, 2, 4, 8 bytes; pairs of failures with units of 8
 *   power_cuts --in-turn    the single ones only; each step fails in one manner, the next step in the next manner
 *   power_cuts --broken     for a store broken on purpose; exit code 0 when the enumeration finds the mistake. It tries
 *                           each step in one manner first, because most mistakes show there, and then in every manner.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brace/store.h"
#include "nvm_model.h"

enum {
    SETS = 12, /* set 0: the safe defaults; the others differ in their femur, and in every drive */
    NO_SET = -1,
    STARTS_UNSTABLE = 4, /* starts after a failure that leaves unstable units; else one */
    STEPS_MAX = 2000, /* of an operation, a store step each */
    ROTTEN_BEFORE = 1, /* the set in force while the newer one has rotted */
    PAIR_MANNERS = 4,
    TURNS = PAIR_MANNERS * PAIR_MANNERS /* rounds of pairs in turn: then every pair has been tried */
};

typedef enum { UPDATE = 'U', ROLL_BACK = 'R' } operation_t;

static brace_parameters_t set[SETS];
static bool expect_broken;
static bool in_turn; /* a step fails in one manner only */
static bool has_rotted; /* the newest set has, by itself, and none was stored since */
static int32_t turn; /* how many manners the first step is ahead */
static unsigned long cases, starts;

static struct {
    const char *program;
    int operation;
    uint32_t unit;
    int32_t first_step, second_step;
    cut_manner_t first_manner, second_manner;
    operation_t second;
} now;

static void make_sets(void)
{
    for (int i = 0; i < SETS; i++) {
        brace_parameters_default(&set[i]);
        for (int joint = 0; i > 0 && joint < BRACE_LINK_COUNT; joint++) {
            set[i].limb.femur_mm = 150.0f + (float)i;
            set[i].drive[joint].motor_friction_n_mm = 100.0f * (float)i;
            set[i].controller.modbus_address = 200u - (uint32_t)i;
        }
    }
}

static void report(const char *what, int found)
{
    if (expect_broken) {
        printf("found out after %lu cases: %s (%d)\n", cases, what, found);
        exit(0);
    }
    printf("power_cuts: %s (%d)\n  program %s, operation %d, unit %u, failure at step %d manner %d", what, found,
           now.program, now.operation, (unsigned)now.unit, (int)now.first_step, (int)now.first_manner);
    if (now.second_step != 0) {
        printf(", then %c with failure at step %d manner %d", (char)now.second, (int)now.second_step,
               (int)now.second_manner);
    }
    printf("\n");
    exit(1);
}

static void require(bool holds, const char *what, int found)
{
    if (!holds) {
        report(what, found);
    }
}

/* ------------------------------------------------------------------------------------------------ a limb -- */

typedef struct {
    nvm_t *nvm;
    brace_hal_t hal;
    brace_store_t store;
    int in_force; /* index of the set */
} limb_t;

static int which_set(const brace_parameters_t *parameters)
{
    for (int i = 0; i < SETS; i++) {
        if (memcmp(parameters, &set[i], sizeof set[i]) == 0) {
            return i;
        }
    }
    return NO_SET;
}

/* A start: a set that was once given, whole, and said to be where it comes from. */
static void start(limb_t *limb, nvm_t *nvm)
{
    brace_parameters_t parameters;
    brace_store_status_t status;
    limb->nvm = nvm;
    limb->hal = nvm_hal(nvm);
    const brace_parameter_origin_t origin = brace_store_start(&limb->store, &limb->hal, &parameters);
    limb->in_force = which_set(&parameters);
    brace_store_status(&limb->store, &status);
    starts++;
    require(limb->in_force != NO_SET, "a set that nobody gave", limb->in_force);
    require((origin == BRACE_PARAMETERS_DEFAULT) == (limb->in_force == 0), "origin and set contradict each other",
            origin);
    require(status.in_force == origin, "status and start contradict each other", origin);
    require(has_rotted || (!status.is_old && status.wanted_sequence == status.sequence),
            "a power cut is taken for a rotten set", (int)status.wanted_sequence);
    require(!has_rotted || limb->in_force != ROTTEN_BEFORE || (status.is_old && status.wanted_sequence == 2u),
            "an older set that nobody calls one", (int)status.wanted_sequence);
    require(!status.is_old || limb->in_force == ROTTEN_BEFORE, "a set that was stored anew is called an older one",
            limb->in_force);
}

/* The set that a roll-back would bring; NO_SET: none. */
static int set_to_go_back_to(const limb_t *limb)
{
    brace_store_status_t status;
    brace_parameters_t parameters;
    uint8_t block[BRACE_BLOCK_BYTES];
    brace_store_status(&limb->store, &status);
    if (!status.can_roll_back) {
        return NO_SET;
    }
    limb->hal.nvm_read(limb->hal.context, status.in_force == BRACE_PARAMETERS_SLOT_A ? 1 : 0, 0, block, sizeof block);
    return brace_parameters_unpack(block, sizeof block, &parameters, NULL, NULL) == BRACE_OK ? which_set(&parameters)
                                                                                             : NO_SET;
}

/* Runs an operation to its end, or to the power failure. */
static brace_store_state_t operate(limb_t *limb, operation_t operation, int new_set)
{
    const brace_status_t status =
        operation == UPDATE ? brace_store_begin(&limb->store, &set[new_set], NULL) : brace_store_rollback(&limb->store);
    require(status == BRACE_OK, "an operation is refused", status);
    brace_store_state_t state = BRACE_STORE_BUSY;
    for (int i = 0; i < STEPS_MAX && state == BRACE_STORE_BUSY && !limb->nvm->dead; i++) {
        state = brace_store_step(&limb->store);
    }
    return state;
}

static void complete(limb_t *limb, operation_t operation, int new_set)
{
    brace_parameters_t parameters;
    uint32_t crc = 0;
    const int expected = operation == UPDATE ? new_set : set_to_go_back_to(limb);
    const brace_store_state_t state = operate(limb, operation, new_set);
    require(state == BRACE_STORE_DONE, "an undisturbed operation is not done", state);
    require(brace_store_take(&limb->store, &parameters, &crc) == BRACE_OK, "nothing to take", 0);
    require(which_set(&parameters) == expected, "another set than the one asked for", which_set(&parameters));
    require(crc == brace_parameters_crc(&parameters), "another identity than the set's", (int)crc);
    limb->in_force = expected;
    start(limb, limb->nvm);
    require(limb->in_force == expected, "another set after the next start", limb->in_force);
}

/* ------------------------------------------------------------------------------------------- enumerations -- */

static int starts_after(cut_manner_t manner)
{
    return manner >= CUT_UNSTABLE ? STARTS_UNSTABLE : 1;
}

/* Is this manner to be tried at this step? In turn: every `manners`-th step. */
static bool has_turn(int32_t step, int manner, int manners)
{
    return !in_turn || (step + turn) % manners == manner;
}

/* From here on everything works: an update, a roll-back to what was in force, two more updates. */
static void go_on(const nvm_t *left, uint32_t lot)
{
    static nvm_t nvm;
    limb_t limb;
    nvm = *left;
    nvm.random += lot;
    nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
    start(&limb, &nvm);
    const int before = limb.in_force;
    const bool had_rotted = has_rotted;
    complete(&limb, UPDATE, SETS - 1);
    has_rotted = false; /* that has mended it */
    if (before != 0) {
        complete(&limb, ROLL_BACK, 0);
        require(limb.in_force == before, "the roll-back brings another set", limb.in_force);
    }
    complete(&limb, UPDATE, SETS - 2);
    complete(&limb, UPDATE, SETS - 3);
    require(nvm.misuse == 0, "a unit is written twice", (int)nvm.misuse);
    has_rotted = had_rotted;
}

typedef struct {
    int set[8];
    int count;
} allowed_t;

static bool is_allowed(const allowed_t *allowed, int in_force)
{
    for (int i = 0; i < allowed->count; i++) {
        if (allowed->set[i] == in_force) {
            return true;
        }
    }
    return false;
}

static void allow(allowed_t *allowed, int in_force)
{
    if (!is_allowed(allowed, in_force)) {
        allowed->set[allowed->count++] = in_force;
    }
}

/* Where a start finds now this, now that: a lot, from `first` on, with which there is something to go back to. */
static uint32_t lot_to_roll_back(const nvm_t *left, uint32_t first)
{
    static nvm_t nvm;
    limb_t limb;
    for (uint32_t lot = first; lot < first + 16u; lot++) {
        nvm = *left;
        nvm.random += lot;
        nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
        start(&limb, &nvm);
        if (set_to_go_back_to(&limb) != NO_SET) {
            return lot;
        }
    }
    return first;
}

/* A second failure, in an update or roll-back after the first. The start before it has chosen one of `open`; until the
 * second operation's erase begins, what the first failure left open stays open. */
static void fail_again(const nvm_t *left, uint32_t first_lot, const allowed_t *open, const cut_manner_t *manners,
                       int manner_count)
{
    static nvm_t nvm;
    limb_t limb;
    for (int kind = 0; kind < 2; kind++) {
        now.second = kind == 0 ? UPDATE : ROLL_BACK;
        const uint32_t lot = kind == 0 ? first_lot : lot_to_roll_back(left, first_lot);
        for (int m = 0; m < manner_count; m++) {
            now.second_manner = manners[m];
            for (now.second_step = 1;; now.second_step++) {
                /* Every first manner meets every second one. */
                if (!has_turn(now.first_step / manner_count + now.second_step + turn / PAIR_MANNERS, m, manner_count)) {
                    continue;
                }
                nvm = *left;
                nvm.random += lot; /* so that the start finds the same at each second step */
                nvm_power(&nvm, now.second_step, manners[m]);
                start(&limb, &nvm);
                nvm.random += (uint32_t)now.second_step;
                require(is_allowed(open, limb.in_force), "neither the old set nor the new one", limb.in_force);
                allowed_t allowed = {.count = 0};
                allow(&allowed, limb.in_force);
                const int back = set_to_go_back_to(&limb);
                if (now.second == ROLL_BACK && back == NO_SET) {
                    break;
                }
                const int wanted = now.second == UPDATE ? SETS - 4 : back;
                allow(&allowed, wanted);
                const brace_store_state_t state = operate(&limb, now.second, SETS - 4);
                const bool undisturbed = !nvm.dead;
                if (undisturbed) {
                    require(state == BRACE_STORE_DONE, "after a failure: an operation is not done", state);
                    allowed = (allowed_t){.set = {wanted}, .count = 1};
                }
                for (int i = 0; !undisturbed && nvm.erases_begun == 0 && i < open->count; i++) {
                    allow(&allowed, open->set[i]);
                }
                nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
                for (int i = 0; i < starts_after(now.first_manner > manners[m] ? now.first_manner : manners[m]); i++) {
                    start(&limb, &nvm);
                    require(is_allowed(&allowed, limb.in_force),
                            "after two failures: neither the old set nor the new one", limb.in_force);
                }
                if (undisturbed) {
                    break;
                }
                go_on(&nvm, (uint32_t)now.second_step);
                cases++;
            }
        }
    }
    now.second_step = 0;
}

/* One operation, failing at each of its steps in each manner. returns its steps */
static int32_t fail_everywhere(const nvm_t *left, operation_t operation, int new_set, bool pairs)
{
    static const cut_manner_t pair_manners[PAIR_MANNERS] = {CUT_BEFORE, CUT_AFTER, CUT_RANDOM_BITS, CUT_UNSTABLE_WHOLE};
    static nvm_t nvm;
    limb_t limb;
    const int manner_count = pairs ? PAIR_MANNERS : CUT_MANNER_COUNT;
    int32_t steps = 0;
    for (int m = 0; m < manner_count; m++) {
        now.first_manner = pairs ? pair_manners[m] : (cut_manner_t)m;
        for (now.first_step = 1;; now.first_step++) {
            if (!has_turn(now.first_step, m, manner_count)) {
                continue;
            }
            nvm = *left;
            nvm.random += (uint32_t)now.first_step;
            nvm_power(&nvm, now.first_step, now.first_manner);
            start(&limb, &nvm);
            allowed_t allowed = {.count = 0};
            allow(&allowed, limb.in_force);
            allow(&allowed, operation == UPDATE ? new_set : set_to_go_back_to(&limb));
            operate(&limb, operation, new_set);
            if (!nvm.dead) {
                break;
            }
            steps = now.first_step > steps ? now.first_step : steps;
            nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
            if (pairs) {
                for (int i = 0; i < starts_after(now.first_manner); i++) {
                    fail_again(&nvm, 1000u * (uint32_t)i, &allowed, pair_manners, manner_count);
                }
                continue;
            }
            for (int i = 0; i < starts_after(now.first_manner); i++) {
                start(&limb, &nvm);
                require(is_allowed(&allowed, limb.in_force), "neither the old set nor the new one", limb.in_force);
                go_on(&nvm, (uint32_t)i);
            }
            cases++;
        }
    }
    return steps;
}

/* Power fails between any two steps of the store, while it checks and packs the set as well as later: no write is
 * interrupted, and none is needed to be. */
static void stop_everywhere(const nvm_t *left, operation_t operation, int new_set)
{
    static nvm_t nvm;
    limb_t limb;
    brace_store_state_t state = BRACE_STORE_BUSY;
    for (now.first_step = 0; state == BRACE_STORE_BUSY; now.first_step++) {
        nvm = *left;
        nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
        start(&limb, &nvm);
        allowed_t allowed = {.count = 0};
        allow(&allowed, limb.in_force);
        allow(&allowed, operation == UPDATE ? new_set : set_to_go_back_to(&limb));
        const brace_status_t status =
            operation == UPDATE ? brace_store_offer(&limb.store, &set[new_set]) : brace_store_rollback(&limb.store);
        require(status == BRACE_OK, "an operation is refused", status);
        for (int i = 0; i < now.first_step; i++) {
            state = brace_store_step(&limb.store);
        }
        start(&limb, &nvm);
        require(is_allowed(&allowed, limb.in_force), "neither the old set nor the new one", limb.in_force);
        require(state != BRACE_STORE_DONE || limb.in_force == allowed.set[allowed.count - 1], "done, and the old set",
                limb.in_force);
        go_on(&nvm, 0);
        cases++;
    }
    require(state == BRACE_STORE_DONE, "an undisturbed operation is not done", state);
}

/* A program is a row of operations; each in its turn is the one that fails, those before it are undisturbed. */
static int32_t run_program(const char *program, uint32_t unit, bool pairs, int first_operation)
{
    static nvm_t nvm;
    limb_t limb;
    int32_t steps = 0;
    nvm_init(&nvm, unit);
    start(&limb, &nvm);
    now.program = program;
    now.unit = unit;
    for (int i = 0; program[i] != '\0'; i++) {
        now.operation = i;
        if (i >= first_operation) {
            steps += fail_everywhere(&nvm, (operation_t)program[i], i + 1, pairs);
            stop_everywhere(&nvm, (operation_t)program[i], i + 1);
        }
        nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
        start(&limb, &nvm);
        complete(&limb, (operation_t)program[i], i + 1);
    }
    require(nvm.misuse == 0, "a unit is written twice", (int)nvm.misuse);
    return steps;
}

/* Set 2 has followed set 1 and rots, in its block, in its mark, or as a whole. Power fails at each step of the update
 * that mends it, in each manner. */
static int32_t enumerate_while_rotten(uint32_t unit, int kind)
{
    static nvm_t nvm;
    limb_t limb;
    int32_t steps = 0;
    nvm_init(&nvm, unit);
    start(&limb, &nvm);
    complete(&limb, UPDATE, ROTTEN_BEFORE);
    complete(&limb, UPDATE, ROTTEN_BEFORE + 1);
    uint8_t *newest = nvm.bytes[limb.store.in_force - 1u];
    if (kind == 0) {
        newest[100] ^= 4u;
    } else if (kind == 1) {
        newest[BRACE_STORE_MARKS_AT] ^= 4u;
    } else {
        memset(newest, 0xff, NVM_SLOT_BYTES);
        memset(nvm.written[limb.store.in_force - 1u], 0, NVM_SLOT_BYTES);
    }
    has_rotted = true;
    now.program = kind == 0 ? "a rotten block" : kind == 1 ? "a rotten mark" : "an erased slot";
    now.operation = 0;
    now.unit = unit;
    steps = fail_everywhere(&nvm, UPDATE, ROTTEN_BEFORE + 2, false);
    nvm_power(&nvm, NVM_FOREVER, CUT_AFTER);
    start(&limb, &nvm);
    require(limb.in_force == ROTTEN_BEFORE, "a rotten set is in force", limb.in_force);
    complete(&limb, UPDATE, ROTTEN_BEFORE + 2);
    has_rotted = false;
    complete(&limb, ROLL_BACK, 0);
    require(limb.in_force == ROTTEN_BEFORE, "the roll-back brings another set", limb.in_force);
    return steps;
}

static void enumerate_rotten(void)
{
    const unsigned long before = cases;
    int32_t steps = 0;
    for (int kind = 0; kind < 3; kind++) {
        for (uint32_t unit = 1; unit <= 8; unit *= 2) {
            steps += enumerate_while_rotten(unit, kind);
        }
    }
    printf("a rotten set: %lu cases on %d steps: the new set, or the older one, which says so\n", cases - before,
           (int)steps);
}

static void enumerate_single(void)
{
    /* Three updates in a row, all failing in turn; a fourth, into the other slot; roll-backs from and to either. */
    static const char *const programs[] = {"UUU", "UUUU", "UUR", "UUUR", "UURU", "UURUR"};
    for (uint32_t unit = 1; unit <= 8; unit *= 2) {
        int32_t steps = 0;
        for (size_t i = 0; i < sizeof programs / sizeof *programs; i++) {
            steps += run_program(programs[i], unit, false, i == 0 ? 0 : (int)strlen(programs[i]) - 1);
        }
        printf("units of %u bytes: power fails at %d steps of 8 operations in %d manners%s\n", (unsigned)unit,
               (int)steps, CUT_MANNER_COUNT, in_turn ? " in turn" : "");
    }
    printf("single failures: %lu cases, %lu starts: the old set or the new one, whole, each time\n", cases, starts);
}

static void enumerate_pairs(void)
{
    const unsigned long before = cases, starts_before = starts;
    const int32_t steps =
        run_program("U", 8, true, 0) + run_program("UUU", 8, true, 2) + run_program("UUR", 8, true, 2);
    printf("pairs of failures: %lu cases on %d first steps, %lu starts: the old set or the new one each time\n",
           cases - before, (int)steps, starts - starts_before);
}

int main(int argc, char **argv)
{
    const bool single_in_turn = argc == 2 && strcmp(argv[1], "--in-turn") == 0;
    expect_broken = argc == 2 && strcmp(argv[1], "--broken") == 0;
    if (argc > 2 || (argc == 2 && !single_in_turn && !expect_broken)) {
        fprintf(stderr, "usage: power_cuts [--in-turn | --broken]\n");
        return 2;
    }
    make_sets();
    if (single_in_turn || expect_broken) {
        in_turn = true;
        enumerate_single();
        enumerate_rotten();
        if (single_in_turn) {
            return 0;
        }
        for (turn = 0; turn < TURNS; turn++) {
            enumerate_pairs();
        }
        in_turn = false;
    }
    enumerate_single();
    enumerate_rotten();
    enumerate_pairs();
    if (expect_broken) {
        printf("power_cuts: a store broken on purpose was not found out\n");
        return 1;
    }
    return 0;
}
