#include "brace/store.h"

#include <string.h>

#include "store_slot.h"

/* What is done, in this order. An update goes through the first eleven, a roll-back through AFFIRM, REREAD, WITHDRAW,
 * WITHDRAW_AGAIN; UNDO is where a failed last mark goes. */
typedef enum {
    STAGE_CHECK,    /* may the set be? Until it is, nothing is touched */
    STAGE_SEAL,     /* the CRC of its block */
    STAGE_AFFIRM,   /* KEEP to the slot that has to count whatever happens next */
    STAGE_RETIRE,   /* VOID to the slot that will be erased */
    STAGE_SPOIL,    /* zeros over its first bytes: whatever an interrupted erase leaves, it is no block */
    STAGE_ERASE,
    STAGE_BLANK,
    STAGE_WRITE,
    STAGE_READ_BACK,
    STAGE_COMMIT,   /* KEEP to what has been written: from here on it counts */
    STAGE_PAST,     /* PAST to the slot that was in force: should the new set rot, that one knows that it is old */
    STAGE_REREAD,   /* roll-back: is the other slot whole, now? The only stage of a reload */
    STAGE_WITHDRAW, /* VOID to the slot in force: from here on the other one counts */
    STAGE_WITHDRAW_AGAIN, /* once more, should the first one rot */
    STAGE_UNDO
} stage_t;

enum { BLANK_CHECKED = BRACE_STORE_BLOCK_ROOM, MARKS_BYTES = BRACE_STORE_MARK_COUNT * BRACE_STORE_MARK_BYTES };

enum { PLACES_FILLED = 2, SEALED_BYTES = 64 /* of the CRC, at once */ };
static const uint8_t zeros[PLACES_FILLED * BRACE_STORE_MARK_BYTES];

static uint32_t other_than(uint32_t slot)
{
    return 1u - slot;
}

static bool is_in_force(const brace_store_t *store, uint32_t slot)
{
    return store->in_force == slot + 1u;
}

/* ----------------------------------------------------------------------------- start and requests -- */

static void choose(brace_store_t *store, uint32_t slot)
{
    if (store->slot[slot].condition == BRACE_SLOT_COUNTS) {
        store->in_force = (uint8_t)(slot + 1u);
    }
}

/* Was a set kept after the one in force, that is not whole any more? A block that passes its CRC and is refused says
 * its sequence rightly; of any other nobody knows whether it is the later one. */
static void judge_age(brace_store_t *store, const store_claim_t claims[BRACE_NVM_SLOT_COUNT])
{
    if (store->in_force == BRACE_PARAMETERS_DEFAULT) {
        return;
    }
    const uint32_t slot = store->in_force - 1u, other = other_than(slot);
    const bool has_gone = claims[slot].is_past && store->slot[other].condition != BRACE_SLOT_COUNTS;
    const bool is_later = store->slot[other].condition != BRACE_SLOT_REFUSED ||
                          (int32_t)(claims[other].sequence - store->slot[slot].sequence) > 0;
    store->is_old = has_gone || (claims[other].is_rotten && is_later);
    store->wanted_sequence = has_gone ? store->slot[slot].sequence + claims[slot].later : claims[other].sequence;
}

brace_parameter_origin_t brace_store_start(brace_store_t *store, const brace_hal_t *hal, brace_parameters_t *parameters)
{
    brace_parameters_t second;
    store_claim_t claims[BRACE_NVM_SLOT_COUNT];
    memset(store, 0, sizeof *store);
    store->hal = hal;
    brace_parameters_default(parameters);
    if (!store_fits(hal)) {
        store->slot[0].condition = store->slot[1].condition = BRACE_SLOT_UNREADABLE;
        store->memory_fault = true;
        return BRACE_PARAMETERS_DEFAULT;
    }
    store_look(store, 0, parameters, &claims[0]);
    choose(store, 0);
    store_look(store, 1, &second, &claims[1]);
    const bool newer =
        store->in_force == BRACE_PARAMETERS_DEFAULT || (int32_t)(store->slot[1].sequence - store->slot[0].sequence) > 0;
    if (newer && store->slot[1].condition == BRACE_SLOT_COUNTS) {
        *parameters = second;
        choose(store, 1);
    }
    judge_age(store, claims);
    store->memory_fault =
        store->slot[0].condition == BRACE_SLOT_UNREADABLE || store->slot[1].condition == BRACE_SLOT_UNREADABLE;
    return (brace_parameter_origin_t)store->in_force;
}

static void go_to(brace_store_t *store, stage_t stage)
{
    store->stage = (uint8_t)stage;
    store->position = 0;
}

static void begin(brace_store_t *store, uint32_t target, stage_t stage)
{
    store->target = (uint8_t)target;
    store->rolling_back = stage == STAGE_AFFIRM;
    store->reloading = false;
    store->failure = BRACE_STORE_FINE;
    store->state = BRACE_STORE_BUSY;
    go_to(store, stage);
}

static brace_store_state_t fail(brace_store_t *store, brace_store_failure_t failure)
{
    store->failure = (int8_t)failure;
    const bool refused = failure <= BRACE_STORE_E_DEVICE && failure >= BRACE_STORE_E_READ_BACK;
    const bool does_not_keep = !store->reloading && (refused || failure == BRACE_STORE_E_SHAPE);
    store->memory_fault = store->memory_fault || does_not_keep;
    return store->state = BRACE_STORE_FAILED;
}

/* How gladly a slot is overwritten while neither is in force: one that a start might still find kept must go
 * first; a block of another firmware stays as long as there is another place. */
static int32_t readiness(const brace_slot_report_t *report)
{
    return store_is_ours(report) ? 2 : report->condition == BRACE_SLOT_OTHER_SCHEMA ? 0 : 1;
}

static uint32_t slot_to_write(const brace_store_t *store)
{
    if (store->in_force != BRACE_PARAMETERS_DEFAULT) {
        return other_than(store->in_force - 1u);
    }
    const int32_t a = readiness(&store->slot[0]), b = readiness(&store->slot[1]);
    if (a == 0 && b == 0) {
        return (int32_t)(store->slot[1].sequence - store->slot[0].sequence) < 0 ? 1u : 0u;
    }
    return b > a ? 1u : 0u;
}

static uint32_t later_of(uint32_t one, uint32_t other)
{
    return (int32_t)(other - one) > 0 ? other : one;
}

/* No set that was kept gets the number of one before, whole or not. */
static uint32_t next_sequence(const brace_store_t *store)
{
    const brace_slot_report_t *a = &store->slot[0], *b = &store->slot[1];
    const bool a_is_ours = store_is_ours(a), b_is_ours = store_is_ours(b);
    const uint32_t newest = a_is_ours && b_is_ours ? later_of(a->sequence, b->sequence)
                            : a_is_ours            ? a->sequence
                            : b_is_ours            ? b->sequence
                                                   : 0u;
    return (store->is_old ? later_of(newest, store->wanted_sequence) : newest) + 1u;
}

brace_status_t brace_store_offer(brace_store_t *store, const brace_parameters_t *parameters)
{
    if (store == NULL || parameters == NULL) {
        return BRACE_E_NULL;
    }
    if (store->state == BRACE_STORE_BUSY) {
        return BRACE_E_UNSUPPORTED;
    }
    if (!store_fits(store->hal)) {
        (void)fail(store, BRACE_STORE_E_SHAPE);
        return BRACE_OK;
    }
    store->is_named = false;
    store->sequence = next_sequence(store);
    memset(store->block + BRACE_BLOCK_BYTES, 0xff, sizeof store->block - BRACE_BLOCK_BYTES);
    brace_block_compose(parameters, store->sequence, store->block);
    begin(store, slot_to_write(store), STAGE_CHECK);
    return BRACE_OK;
}

void brace_store_expect(brace_store_t *store, uint32_t crc)
{
    if (store != NULL) {
        store->is_named = true;
        store->named_crc = crc;
    }
}

brace_status_t brace_store_begin(brace_store_t *store, const brace_parameters_t *parameters, uint32_t *wrong_index)
{
    if (store == NULL || parameters == NULL) {
        return BRACE_E_NULL;
    }
    if (store->state == BRACE_STORE_BUSY) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = brace_parameters_check(parameters, wrong_index);
    return status == BRACE_OK ? brace_store_offer(store, parameters) : status;
}

static bool can_roll_back(const brace_store_t *store)
{
    return store->in_force != BRACE_PARAMETERS_DEFAULT &&
           store->slot[other_than(store->in_force - 1u)].condition == BRACE_SLOT_COUNTS;
}

brace_status_t brace_store_rollback(brace_store_t *store)
{
    if (store == NULL) {
        return BRACE_E_NULL;
    }
    if (store->state == BRACE_STORE_BUSY) {
        return BRACE_E_UNSUPPORTED;
    }
    if (can_roll_back(store)) {
        begin(store, other_than(store->in_force - 1u), STAGE_AFFIRM);
    } else {
        (void)fail(store, BRACE_STORE_E_NOTHING);
    }
    return BRACE_OK;
}

brace_status_t brace_store_reload(brace_store_t *store)
{
    if (store == NULL) {
        return BRACE_E_NULL;
    }
    if (store->state == BRACE_STORE_BUSY) {
        return BRACE_E_UNSUPPORTED;
    }
    if (store->in_force != BRACE_PARAMETERS_DEFAULT) {
        begin(store, store->in_force - 1u, STAGE_REREAD);
        store->reloading = true;
    } else {
        (void)fail(store, BRACE_STORE_E_NOTHING);
    }
    return BRACE_OK;
}

/* ---------------------------------------------------------------------------------- check and seal -- */

static brace_store_state_t check(brace_store_t *store)
{
    brace_parameters_t set;
    brace_block_members(store->block, &set);
    const brace_status_t status = brace_parameters_check_piece(&set, store->position, &store->wrong_index);
    if (status != BRACE_OK) {
        store->refusal = (int8_t)status;
        return fail(store, BRACE_STORE_E_REFUSED);
    }
    store->position++;
    if (store->position == BRACE_CHECK_PIECES) {
        go_to(store, STAGE_SEAL);
        store->block_crc = 0;
    }
    return BRACE_STORE_BUSY;
}

/* Carries brace_parameters_crc on over bytes [from, from + count) of a block. */
static void identify(brace_store_t *store, uint32_t from, uint32_t count)
{
    const uint32_t members_end = BRACE_BLOCK_BYTES - 4;
    if (from == 0u) {
        store->identity = brace_crc32(0, store->block + 8, 4); /* the schema hash */
    }
    const uint32_t first = from < BRACE_BLOCK_HEADER_BYTES ? (uint32_t)BRACE_BLOCK_HEADER_BYTES : from;
    const uint32_t end = from + count < members_end ? from + count : members_end;
    if (first < end) {
        store->identity = brace_crc32(store->identity, store->block + first, end - first);
    }
}

static brace_store_state_t seal(brace_store_t *store)
{
    const uint32_t covered = BRACE_BLOCK_BYTES - 4, left = covered - store->position;
    const uint32_t count = left < SEALED_BYTES ? left : (uint32_t)SEALED_BYTES;
    store->block_crc = brace_crc32(store->block_crc, store->block + store->position, count);
    if (store->is_named) {
        identify(store, store->position, count);
    }
    store->position += count;
    if (store->position == covered) {
        if (store->is_named && store->identity != store->named_crc) {
            store->refusal = BRACE_E_CHECKSUM;
            store->wrong_index = BRACE_PARAMETER_COUNT;
            return fail(store, BRACE_STORE_E_REFUSED);
        }
        for (uint32_t i = 0; i < 4u; i++) {
            store->block[covered + i] = (uint8_t)(store->block_crc >> (8u * i));
        }
        go_to(store, STAGE_AFFIRM);
    }
    return BRACE_STORE_BUSY;
}

/* ------------------------------------------------------------------------------------------ marks -- */

typedef enum { MARK_BUSY, MARK_DONE, MARK_NO_ROOM, MARK_E_DEVICE, MARK_E_READ_BACK } mark_result_t;

/* The next places may look erased and have been touched as power failed: zeros go over them, which nothing can
 * shake. Two places: the one before may itself read differently each time, and look erased at the next start. */
static mark_result_t fill_places(brace_store_t *store, uint32_t slot)
{
    const uint32_t offset = BRACE_STORE_MARKS_AT + store->next_mark[slot] * (uint32_t)BRACE_STORE_MARK_BYTES;
    store->next_mark[slot] = (uint8_t)(store->next_mark[slot] + PLACES_FILLED);
    store->clean[slot] = true;
    const int32_t answer = store->hal->nvm_write(store->hal->context, slot, offset, zeros, sizeof zeros);
    return answer == BRACE_HAL_OK ? MARK_BUSY : MARK_E_DEVICE;
}

/* Adds a mark to a slot: written in one step, read back in the next. */
static mark_result_t put_mark(brace_store_t *store, uint32_t slot, store_word_t word, uint32_t block_crc,
                              uint32_t places_kept_free)
{
    const brace_hal_t *hal = store->hal;
    const uint32_t place = store->next_mark[slot];
    const uint32_t offset = BRACE_STORE_MARKS_AT + place * BRACE_STORE_MARK_BYTES;
    uint8_t mark[BRACE_STORE_MARK_BYTES], found[BRACE_STORE_MARK_BYTES];
    const uint32_t wanted = places_kept_free + (store->clean[slot] ? 1u : 1u + PLACES_FILLED);
    if (place + wanted > BRACE_STORE_MARK_COUNT) {
        return MARK_NO_ROOM;
    }
    if (!store->clean[slot]) {
        return fill_places(store, slot);
    }
    store_mark(mark, word, store->wanted_sequence - store->slot[slot].sequence, block_crc);
    store->affirmed[slot] = false;
    if (store->position == 0u) {
        store->position = sizeof mark;
        if (hal->nvm_write(hal->context, slot, offset, mark, sizeof mark) != BRACE_HAL_OK) {
            store->next_mark[slot]++;
            return MARK_E_DEVICE;
        }
        return MARK_BUSY;
    }
    store->next_mark[slot]++;
    if (hal->nvm_read(hal->context, slot, offset, found, sizeof found) != BRACE_HAL_OK) {
        return MARK_E_DEVICE;
    }
    if (memcmp(mark, found, sizeof mark) != 0) {
        return MARK_E_READ_BACK;
    }
    store->affirmed[slot] = word == STORE_KEEP;
    return MARK_DONE;
}

static brace_store_failure_t mark_failure(mark_result_t result)
{
    return result == MARK_NO_ROOM    ? BRACE_STORE_E_FULL
           : result == MARK_E_DEVICE ? BRACE_STORE_E_DEVICE
                                     : BRACE_STORE_E_READ_BACK;
}

/* A mark before anything is changed. Where there is no room for it, some twenty stand there already. */
static brace_store_state_t settle(brace_store_t *store, uint32_t slot, store_word_t word, stage_t next)
{
    const bool stands = word == STORE_KEEP && store->affirmed[slot];
    const mark_result_t result =
        stands ? MARK_DONE : put_mark(store, slot, word, store->slot[slot].block_crc, BRACE_STORE_MARKS_KEPT_FREE);
    if (result == MARK_BUSY) {
        return BRACE_STORE_BUSY;
    }
    /* A slot whose erase was interrupted may not take a VOID; what it holds is no block any more. */
    const bool given_up = result == MARK_E_READ_BACK && word == STORE_VOID;
    if (result != MARK_DONE && result != MARK_NO_ROOM && !given_up) {
        return fail(store, mark_failure(result));
    }
    if (word == STORE_VOID) {
        store->slot[slot].condition = BRACE_SLOT_VOID;
    }
    go_to(store, next);
    return BRACE_STORE_BUSY;
}

static brace_store_state_t affirm(brace_store_t *store)
{
    if (store->rolling_back) {
        return settle(store, store->target, STORE_KEEP, STAGE_REREAD);
    }
    const uint32_t other = other_than(store->target);
    if (is_in_force(store, other)) {
        return settle(store, other, store->is_old ? STORE_PAST : STORE_KEEP, STAGE_RETIRE);
    }
    if (store_is_ours(&store->slot[other])) { /* the defaults are in force: it must not come back */
        return settle(store, other, STORE_VOID, STAGE_RETIRE);
    }
    go_to(store, STAGE_RETIRE);
    return BRACE_STORE_BUSY;
}

static brace_store_state_t retire(brace_store_t *store)
{
    if (store_is_ours(&store->slot[store->target])) {
        return settle(store, store->target, STORE_VOID, STAGE_SPOIL);
    }
    /* Where marks stand, a set stood: an update may have been interrupted while it spoilt it. */
    go_to(store, store->next_mark[store->target] != 0u ? STAGE_SPOIL : STAGE_ERASE);
    return BRACE_STORE_BUSY;
}

static brace_store_state_t done(brace_store_t *store)
{
    store->in_force = (uint8_t)(store->target + 1u);
    store->is_old = false;
    return store->state = BRACE_STORE_DONE;
}

static uint32_t crc_on_its_way(const brace_store_t *store)
{
    const uint8_t *crc = store->block + BRACE_BLOCK_BYTES - 4;
    return (uint32_t)crc[0] | (uint32_t)crc[1] << 8 | (uint32_t)crc[2] << 16 | (uint32_t)crc[3] << 24;
}

static brace_store_state_t commit(brace_store_t *store)
{
    const uint32_t crc = crc_on_its_way(store);
    const mark_result_t result = put_mark(store, store->target, STORE_KEEP, crc, 0);
    if (result == MARK_BUSY) {
        return BRACE_STORE_BUSY;
    }
    store->slot[store->target] =
        (brace_slot_report_t){.condition = result == MARK_DONE ? BRACE_SLOT_COUNTS : BRACE_SLOT_NOT_COMMITTED,
                              .sequence = store->sequence,
                              .schema_hash = BRACE_SCHEMA_HASH,
                              .block_crc = crc};
    if (result == MARK_DONE) {
        store->memory_fault = false;
        store->wanted_sequence = store->sequence;
        go_to(store, STAGE_PAST);
        return BRACE_STORE_BUSY;
    }
    store->failure = (int8_t)mark_failure(result);
    go_to(store, STAGE_UNDO);
    return BRACE_STORE_BUSY;
}

/* A mark more than is needed, after the one that decides: without it the set is kept all the same. Where there is no
 * room for it, it is left out; a memory that does not keep it is at fault. */
static brace_store_state_t put_spare(brace_store_t *store, uint32_t slot, store_word_t word)
{
    const mark_result_t result = put_mark(store, slot, word, store->slot[slot].block_crc, BRACE_STORE_MARKS_KEPT_FREE);
    if (result == MARK_BUSY) {
        return BRACE_STORE_BUSY;
    }
    store->memory_fault = result != MARK_DONE && result != MARK_NO_ROOM;
    return done(store);
}

static brace_store_state_t leave_behind(brace_store_t *store)
{
    const uint32_t other = other_than(store->target);
    return is_in_force(store, other) ? put_spare(store, other, STORE_PAST) : done(store);
}

static brace_store_state_t withdraw(brace_store_t *store)
{
    const uint32_t left = other_than(store->target);
    const mark_result_t result = put_mark(store, left, STORE_VOID, store->slot[left].block_crc, 0);
    if (result == MARK_BUSY) {
        return BRACE_STORE_BUSY;
    }
    if (result == MARK_DONE) {
        store->slot[left].condition = BRACE_SLOT_VOID;
        store->memory_fault = false;
        store->clean[left] = false; /* zeros come between the two: no burst hits both */
        go_to(store, STAGE_WITHDRAW_AGAIN);
        return BRACE_STORE_BUSY;
    }
    store->failure = (int8_t)mark_failure(result);
    go_to(store, STAGE_UNDO);
    return BRACE_STORE_BUSY;
}

/* The mark that decides was not verified: the opposite one goes after it, as far as the memory takes it. */
static brace_store_state_t undo(brace_store_t *store)
{
    const uint32_t slot = store->rolling_back ? other_than(store->target) : store->target;
    const store_word_t word = store->rolling_back ? STORE_KEEP : STORE_VOID;
    const mark_result_t result = put_mark(store, slot, word, store->slot[slot].block_crc, 0);
    return result == MARK_BUSY ? BRACE_STORE_BUSY : fail(store, (brace_store_failure_t)store->failure);
}

/* ----------------------------------------------------------------------------------- erase, bytes -- */

static brace_store_state_t spoil(brace_store_t *store)
{
    if (store->hal->nvm_write(store->hal->context, store->target, 0, zeros, sizeof zeros) != BRACE_HAL_OK) {
        return fail(store, BRACE_STORE_E_DEVICE);
    }
    go_to(store, STAGE_ERASE);
    return BRACE_STORE_BUSY;
}

static brace_store_state_t erase(brace_store_t *store)
{
    store->erases += store->erases < UINT32_MAX;
    const uint32_t slot = store->target;
    if (store->hal->nvm_erase(store->hal->context, slot) != BRACE_HAL_OK) {
        return fail(store, BRACE_STORE_E_DEVICE);
    }
    memset(&store->slot[slot], 0, sizeof store->slot[slot]);
    store->next_mark[slot] = 0;
    store->clean[slot] = true;
    store->affirmed[slot] = false;
    go_to(store, STAGE_BLANK);
    return BRACE_STORE_BUSY;
}

static uint32_t piece_of(uint32_t position, uint32_t end)
{
    return end - position < BRACE_STORE_PIECE_BYTES ? end - position : (uint32_t)BRACE_STORE_PIECE_BYTES;
}

/* Where the block will stand, then where the marks will. */
static brace_store_state_t check_blank(brace_store_t *store)
{
    uint8_t piece[BRACE_STORE_PIECE_BYTES];
    const bool in_block = store->position < BLANK_CHECKED;
    const uint32_t end = in_block ? BLANK_CHECKED : BLANK_CHECKED + MARKS_BYTES;
    const uint32_t offset = in_block ? store->position : BRACE_STORE_MARKS_AT + store->position - BLANK_CHECKED;
    const uint32_t count = piece_of(store->position, end);
    if (store->hal->nvm_read(store->hal->context, store->target, offset, piece, count) != BRACE_HAL_OK) {
        return fail(store, BRACE_STORE_E_DEVICE);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (piece[i] != 0xffu) {
            return fail(store, BRACE_STORE_E_ERASE);
        }
    }
    store->position += count;
    if (store->position == BLANK_CHECKED + MARKS_BYTES) {
        go_to(store, STAGE_WRITE);
    }
    return BRACE_STORE_BUSY;
}

static brace_store_state_t write_block(brace_store_t *store)
{
    const uint32_t count = piece_of(store->position, BRACE_STORE_BLOCK_ROOM);
    if (store->hal->nvm_write(store->hal->context, store->target, store->position, store->block + store->position,
                              count) != BRACE_HAL_OK) {
        return fail(store, BRACE_STORE_E_DEVICE);
    }
    store->position += count;
    if (store->position == BRACE_STORE_BLOCK_ROOM) {
        go_to(store, STAGE_READ_BACK);
    }
    return BRACE_STORE_BUSY;
}

static brace_store_state_t read_back(brace_store_t *store)
{
    uint8_t piece[BRACE_STORE_PIECE_BYTES];
    const uint32_t from = store->position, count = piece_of(from, BRACE_STORE_BLOCK_ROOM);
    if (store->hal->nvm_read(store->hal->context, store->target, from, piece, count) != BRACE_HAL_OK) {
        return fail(store, BRACE_STORE_E_DEVICE);
    }
    if (memcmp(piece, store->block + from, count) != 0) {
        return fail(store, BRACE_STORE_E_READ_BACK);
    }
    identify(store, from, count);
    store->position += count;
    if (store->position == BRACE_STORE_BLOCK_ROOM) {
        go_to(store, STAGE_COMMIT);
    }
    return BRACE_STORE_BUSY;
}

static brace_store_state_t reread(brace_store_t *store)
{
    const uint32_t from = store->position, count = piece_of(from, BRACE_BLOCK_BYTES);
    const uint32_t covered = BRACE_BLOCK_BYTES - 4;
    if (store->hal->nvm_read(store->hal->context, store->target, from, store->block + from, count) != BRACE_HAL_OK) {
        return fail(store, BRACE_STORE_E_DEVICE);
    }
    identify(store, from, count);
    const uint32_t end = from + count < covered ? from + count : covered;
    const uint32_t so_far = from == 0u ? 0u : store->block_crc;
    store->block_crc = brace_crc32(so_far, store->block + from, from < end ? end - from : 0u);
    store->position += count;
    if (store->position < BRACE_BLOCK_BYTES) {
        return BRACE_STORE_BUSY;
    }
    /* Equal to what the start judged, by its CRC: nothing else needs judging again. */
    const uint32_t known = store->slot[store->target].block_crc;
    if (store->block_crc != known || crc_on_its_way(store) != known) {
        return fail(store, BRACE_STORE_E_READ_BACK);
    }
    store->sequence = store->slot[store->target].sequence;
    if (store->reloading) {
        return store->state = BRACE_STORE_DONE;
    }
    go_to(store, STAGE_WITHDRAW);
    return BRACE_STORE_BUSY;
}

brace_store_state_t brace_store_step(brace_store_t *store)
{
    if (store == NULL) {
        return BRACE_STORE_IDLE;
    }
    if (store->state != BRACE_STORE_BUSY) {
        return (brace_store_state_t)store->state;
    }
    switch ((stage_t)store->stage) {
    case STAGE_CHECK: return check(store);
    case STAGE_SEAL: return seal(store);
    case STAGE_AFFIRM: return affirm(store);
    case STAGE_RETIRE: return retire(store);
    case STAGE_SPOIL: return spoil(store);
    case STAGE_ERASE: return erase(store);
    case STAGE_BLANK: return check_blank(store);
    case STAGE_WRITE: return write_block(store);
    case STAGE_READ_BACK: return read_back(store);
    case STAGE_COMMIT: return commit(store);
    case STAGE_PAST: return leave_behind(store);
    case STAGE_REREAD: return reread(store);
    case STAGE_WITHDRAW: return withdraw(store);
    case STAGE_WITHDRAW_AGAIN: return put_spare(store, other_than(store->target), STORE_VOID);
    case STAGE_UNDO:
    default: return undo(store);
    }
}

/* ---------------------------------------------------------------------------------------- results -- */

brace_status_t brace_store_take(brace_store_t *store, brace_parameters_t *parameters, uint32_t *crc)
{
    if (store == NULL || parameters == NULL) {
        return BRACE_E_NULL;
    }
    if (store->state != BRACE_STORE_DONE) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_block_members(store->block, parameters);
    if (crc != NULL) {
        *crc = store->identity;
    }
    store->state = BRACE_STORE_IDLE;
    return BRACE_OK;
}

uint32_t brace_store_sequence(const brace_store_t *store)
{
    return store->in_force == BRACE_PARAMETERS_DEFAULT ? 0u : store->slot[store->in_force - 1u].sequence;
}

uint32_t brace_store_wanted_sequence(const brace_store_t *store)
{
    return store->is_old ? store->wanted_sequence : brace_store_sequence(store);
}

void brace_store_status(const brace_store_t *store, brace_store_status_t *status)
{
    if (store == NULL || status == NULL) {
        return;
    }
    status->state = (brace_store_state_t)store->state;
    status->failure = (brace_store_failure_t)store->failure;
    status->in_force = (brace_parameter_origin_t)store->in_force;
    status->sequence = brace_store_sequence(store);
    status->is_old = store->is_old;
    status->wanted_sequence = brace_store_wanted_sequence(store);
    memcpy(status->slot, store->slot, sizeof status->slot);
    status->refusal = store->failure == BRACE_STORE_E_REFUSED ? (brace_status_t)store->refusal : BRACE_OK;
    status->wrong_index = store->failure == BRACE_STORE_E_REFUSED ? store->wrong_index : 0u;
    status->can_roll_back = can_roll_back(store);
    status->memory_fault = store->memory_fault;
}
