/* A step of an update or a roll-back, from any state that one can be in, over a memory of any content that refuses what
 * it likes. */
#include "brace/store.h"

#include "memory.h"
#include "src/store.c"
#include "store_state.h"

uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(count == 0u || __CPROVER_r_ok(bytes, count), "the CRC is of bytes that are there");
    return any_u32();
}

void brace_block_members(const uint8_t *block, brace_parameters_t *parameters)
{
    PROVE(__CPROVER_r_ok(block, BRACE_BLOCK_BYTES), "a whole block");
    brace_parameters_t any;
    *parameters = any;
}

brace_status_t brace_parameters_check_piece(const brace_parameters_t *parameters, uint32_t piece, uint32_t *wrong_index)
{
    (void)parameters;
    PROVE(piece < (uint32_t)BRACE_CHECK_PIECES, "a piece that there is");
    *wrong_index = any_u32();
    return any_bool() ? BRACE_OK : any_bool() ? BRACE_E_PARAMETER : BRACE_E_NOT_FINITE;
}

/* Rises with every step, and has an end: stages only go on. */
static uint32_t progress(const brace_store_t *s)
{
    return 8192u * s->stage + 4u * s->position + s->clean[0] + s->clean[1];
}

int main(void)
{
    brace_store_t store; /* of any content */
    store.hal = &any_memory;
    memory_from = 0;
    memory_end = 4096;
    memory_writes = memory_erases = 0;
    ASSUME(sound(&store));
    const uint32_t before = progress(&store), stage = store.stage;
    const uint8_t in_force = store.in_force, target = store.target;
    const bool rolls_back = store.rolling_back, reloads = store.reloading;

    const brace_store_state_t state = brace_store_step(&store);

    PROVE(state == store.state, "the state is reported");
    PROVE(memory_erases + memory_writes <= 1u, "one call that changes the memory in a step");
    PROVE(!reloads || memory_erases + memory_writes == 0u, "a reload changes nothing");
    PROVE(memory_erases == 0u || (erased_slot == target && !rolls_back && in_force != erased_slot + 1u),
          "what is erased is not in force");
    PROVE(memory_writes == 0u || written_at >= BRACE_STORE_MARKS_AT || (written_slot == target && !rolls_back),
          "the slot in force gets marks only");
    if (state == BRACE_STORE_BUSY) {
        PROVE(sound(&store), "a step from a sound state ends in one");
        PROVE(progress(&store) > before, "each step comes nearer to the end");
        PROVE(store.in_force == in_force && store.target == target && store.rolling_back == rolls_back &&
                  store.reloading == reloads,
              "nothing changes on the way");
        return 0;
    }
    PROVE(at_rest(&store), "and so does the last one");
    if (state == BRACE_STORE_DONE && reloads) {
        PROVE(store.in_force == in_force && stage == STAGE_REREAD, "reloaded: the set in force stays in force");
    } else if (state == BRACE_STORE_DONE) {
        PROVE(store.in_force == target + 1u && (stage == STAGE_PAST || stage == STAGE_WITHDRAW_AGAIN),
              "done: the new set is in force, behind the mark that decides");
        PROVE(!store.is_old, "and nothing has followed it");
        PROVE(store.slot[target].condition == BRACE_SLOT_COUNTS || rolls_back, "and counts");
    } else {
        PROVE(state == BRACE_STORE_FAILED && store.in_force == in_force, "failed: the set of before is in force");
        PROVE(store.failure < BRACE_STORE_FINE, "and why");
    }
    PROVE(store.next_mark[0] <= BRACE_STORE_MARK_COUNT && store.next_mark[1] <= BRACE_STORE_MARK_COUNT,
          "marks within their places");
    return 0;
}
