/* A step of an update or a roll-back, from any state that one can be in, over a memory of any content that refuses what
 * it likes. */
#include "brace/store.h"

#include "memory.h"
#include "src/store.c"

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

/* How far a stage has come. */
static bool position_is_sound(uint32_t stage, uint32_t at)
{
    switch (stage) {
    case STAGE_CHECK: return at < BRACE_CHECK_PIECES;
    case STAGE_SEAL: return at < BRACE_BLOCK_BYTES - 4;
    case STAGE_SPOIL:
    case STAGE_ERASE: return at == 0u;
    case STAGE_BLANK: return at < BLANK_CHECKED + MARKS_BYTES;
    case STAGE_WRITE:
    case STAGE_READ_BACK:
    case STAGE_REREAD: return at < BRACE_STORE_BLOCK_ROOM && at % 8u == 0u;
    default: return at == 0u || at == BRACE_STORE_MARK_BYTES; /* of a mark: to be written, to be read back */
    }
}

static bool is_bool(const bool *value)
{
    return *(const uint8_t *)value <= 1u;
}

/* What is under way. */
static bool sound(const brace_store_t *s)
{
    const uint32_t stage = s->stage;
    const bool only_rollback = stage == STAGE_REREAD || stage == STAGE_WITHDRAW;
    const bool either = stage == STAGE_AFFIRM || stage == STAGE_UNDO;
    return s->state == BRACE_STORE_BUSY && stage <= STAGE_UNDO && position_is_sound(stage, s->position) &&
           s->target < 2u && s->in_force <= 2u && s->in_force != s->target + 1u &&
           s->next_mark[0] <= BRACE_STORE_MARK_COUNT && s->next_mark[1] <= BRACE_STORE_MARK_COUNT &&
           is_bool(&s->rolling_back) && is_bool(&s->clean[0]) && is_bool(&s->clean[1]) &&
           (s->rolling_back ? (only_rollback || either) && s->in_force != 0u : !only_rollback) &&
           (stage != STAGE_UNDO || s->failure < BRACE_STORE_FINE);
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
    memory_end = 4096;
    ASSUME(sound(&store));
    const uint32_t before = progress(&store), stage = store.stage;
    const uint8_t in_force = store.in_force, target = store.target;
    const bool rolls_back = store.rolling_back;

    const brace_store_state_t state = brace_store_step(&store);

    PROVE(state == store.state, "the state is told");
    PROVE(memory_erases + memory_writes <= 1u, "one call that changes the memory in a step");
    PROVE(memory_erases == 0u || (erased_slot == target && !rolls_back && in_force != erased_slot + 1u),
          "what is erased is not in force");
    PROVE(memory_writes == 0u || written_at >= BRACE_STORE_MARKS_AT || (written_slot == target && !rolls_back),
          "the slot in force gets marks only");
    if (state == BRACE_STORE_BUSY) {
        PROVE(sound(&store), "a step from a sound state ends in one");
        PROVE(progress(&store) > before, "each step comes nearer to the end");
        PROVE(store.in_force == in_force && store.target == target && store.rolling_back == rolls_back,
              "nothing changes on the way");
    } else if (state == BRACE_STORE_DONE) {
        PROVE(store.in_force == target + 1u && (stage == STAGE_COMMIT || stage == STAGE_WITHDRAW),
              "done: the new set is in force, by its last mark");
        PROVE(store.slot[target].condition == BRACE_SLOT_COUNTS || rolls_back, "and counts");
    } else {
        PROVE(state == BRACE_STORE_FAILED && store.in_force == in_force, "failed: the set of before is in force");
        PROVE(store.failure < BRACE_STORE_FINE, "and why");
    }
    PROVE(store.next_mark[0] <= BRACE_STORE_MARK_COUNT && store.next_mark[1] <= BRACE_STORE_MARK_COUNT,
          "marks within their places");
    return 0;
}
