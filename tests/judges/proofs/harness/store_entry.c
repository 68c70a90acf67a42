/* How a store comes to what store.c proves of its steps: a start over a memory of any content leaves it at rest; from
 * rest an update, a roll-back or a reload enters a sound state, or fails and leaves it at rest; while one is under way,
 * nobody begins another. None of these changes the memory. */
#include "brace/store.h"

#include "memory.h"
#include "src/store.c"
#include "store_state.h"

/* A slot's look, as store_look.c proves it. */
void store_look(brace_store_t *store, uint32_t slot, brace_parameters_t *parameters, store_claim_t *claim)
{
    PROVE(slot < (uint32_t)BRACE_NVM_SLOT_COUNT, "a slot that there is");
    PROVE(__CPROVER_w_ok(parameters, sizeof *parameters), "there is room for its set");
    store->slot[slot].condition = (brace_slot_condition_t)(any_u8() & 7u);
    store->slot[slot].sequence = any_u32();
    store->slot[slot].block_crc = any_u32();
    store->next_mark[slot] = any_u8();
    ASSUME(store->next_mark[slot] <= BRACE_STORE_MARK_COUNT);
    store->clean[slot] = store->affirmed[slot] = false;
    *claim = (store_claim_t){.is_past = any_bool(), .later = any_u32(), .is_rotten = any_bool(), .sequence = any_u32()};
}

bool store_fits(const brace_hal_t *hal)
{
    (void)hal;
    return any_bool();
}

bool store_is_ours(const brace_slot_report_t *report)
{
    (void)report;
    return any_bool();
}

void store_mark(uint8_t mark[BRACE_STORE_MARK_BYTES], store_word_t word, uint32_t later, uint32_t block_crc)
{
    (void)word;
    (void)later;
    (void)block_crc;
    PROVE(__CPROVER_w_ok(mark, BRACE_STORE_MARK_BYTES), "room for a mark");
}

uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    (void)bytes;
    (void)count;
    return any_u32();
}

void brace_block_members(const uint8_t *block, brace_parameters_t *parameters)
{
    PROVE(__CPROVER_r_ok(block, BRACE_BLOCK_BYTES), "a whole block");
    brace_parameters_t any;
    *parameters = any;
}

void brace_block_compose(const brace_parameters_t *parameters, uint32_t sequence, uint8_t *block)
{
    (void)parameters;
    (void)sequence;
    PROVE(__CPROVER_w_ok(block, BRACE_BLOCK_BYTES), "room for a block");
    __CPROVER_havoc_slice(block, BRACE_BLOCK_BYTES);
}

void brace_parameters_default(brace_parameters_t *parameters)
{
    brace_parameters_t any;
    *parameters = any;
}

brace_status_t brace_parameters_check(const brace_parameters_t *parameters, uint32_t *wrong_index)
{
    (void)parameters;
    (void)wrong_index;
    return any_bool() ? BRACE_OK : any_bool() ? BRACE_E_PARAMETER : BRACE_E_NOT_FINITE;
}

brace_status_t brace_parameters_check_piece(const brace_parameters_t *parameters, uint32_t piece, uint32_t *wrong_index)
{
    (void)piece;
    return brace_parameters_check(parameters, wrong_index);
}

static brace_store_t store; /* of any content, as all of these */
static brace_parameters_t set;

static void starts(void)
{
    const brace_parameter_origin_t origin = brace_store_start(&store, &any_memory, &set);
    PROVE(at_rest(&store) && store.state == BRACE_STORE_IDLE, "after a start the store is at rest");
    PROVE((uint32_t)origin == store.in_force && store.hal == &any_memory, "and reports what is in force");
    PROVE(store.in_force == 0u || store.slot[store.in_force - 1u].condition == BRACE_SLOT_COUNTS,
          "which is a slot that counts, or the defaults");
}

static void begins(void)
{
    store.hal = &any_memory;
    const bool is_busy = store.state == BRACE_STORE_BUSY;
    ASSUME(is_busy ? sound(&store) : at_rest(&store));
    const uint8_t stage = store.stage, target = store.target, in_force = store.in_force, state = store.state;
    const uint32_t position = store.position;
    uint32_t wrong_index = 0, crc = 0;
    const uint8_t which = any_u8();
    brace_status_t answer;
    switch (which) {
    case 0: answer = brace_store_begin(&store, any_bool() ? &set : NULL, &wrong_index); break;
    case 1: answer = brace_store_offer(&store, any_bool() ? &set : NULL); break;
    case 2: answer = brace_store_rollback(&store); break;
    case 3: answer = brace_store_reload(&store); break;
    default: answer = brace_store_take(&store, &set, any_bool() ? &crc : NULL); break;
    }
    PROVE(store.in_force == in_force, "what is in force stays so");
    if (is_busy || answer != BRACE_OK) {
        PROVE(!is_busy || answer != BRACE_OK, "what is under way is not interrupted");
        PROVE(store.state == state && store.stage == stage && store.target == target && store.position == position,
              "refused: the store is as it was");
    } else if (store.state == BRACE_STORE_BUSY) {
        PROVE(sound(&store) && store.position == 0u, "begun: a sound state");
        PROVE(which < 2u   ? store.stage == STAGE_CHECK && !store.rolling_back && !store.reloading
              : which == 2 ? store.stage == STAGE_AFFIRM && store.rolling_back && !store.reloading
                           : which == 3u && store.reloading,
              "of the kind that was asked for");
    } else {
        PROVE(at_rest(&store), "failed at once, or taken: at rest");
        PROVE(store.state == BRACE_STORE_FAILED ? store.failure < BRACE_STORE_FINE : which > 3u, "and why");
    }
}

int main(void)
{
    memory_from = 0;
    memory_end = 4096;
    memory_writes = memory_erases = 0;
    if (any_bool()) {
        starts();
    } else {
        begins();
    }
    PROVE(memory_writes == 0u && memory_erases == 0u, "the memory is only read");
    return 0;
}
