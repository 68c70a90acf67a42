/* The states that a store can be in: at rest, or with something under way. store.c proves that a step from a sound
 * state ends in one or at rest; store_entry.c, that nothing else than these is ever entered. Include it behind
 * src/store.c. */
#ifndef BRACE_PROOF_STORE_STATE_H
#define BRACE_PROOF_STORE_STATE_H

#include "proof.h"

static bool is_bool(const bool *value)
{
    return *(const uint8_t *)value <= 1u;
}

/* What holds at any time. */
static bool members_are_sound(const brace_store_t *s)
{
    return s->in_force <= 2u && s->next_mark[0] <= BRACE_STORE_MARK_COUNT &&
           s->next_mark[1] <= BRACE_STORE_MARK_COUNT && is_bool(&s->rolling_back) && is_bool(&s->reloading) &&
           is_bool(&s->memory_fault) && is_bool(&s->is_old) && is_bool(&s->clean[0]) && is_bool(&s->clean[1]) &&
           is_bool(&s->affirmed[0]) && is_bool(&s->affirmed[1]);
}

/* Nothing is under way. */
static bool at_rest(const brace_store_t *s)
{
    return members_are_sound(s) &&
           (s->state == BRACE_STORE_IDLE || s->state == BRACE_STORE_DONE || s->state == BRACE_STORE_FAILED);
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

/* An update, a roll-back or a reload is under way. */
static bool sound(const brace_store_t *s)
{
    const uint32_t stage = s->stage;
    const bool only_rollback = stage == STAGE_REREAD || stage == STAGE_WITHDRAW || stage == STAGE_WITHDRAW_AGAIN;
    const bool either = stage == STAGE_AFFIRM || stage == STAGE_UNDO;
    const bool manner = s->reloading      ? !s->rolling_back && stage == STAGE_REREAD && s->in_force == s->target + 1u
                        : s->rolling_back ? (only_rollback || either) && s->in_force == 2u - s->target
                                          : !only_rollback && s->in_force != s->target + 1u;
    return members_are_sound(s) && s->state == BRACE_STORE_BUSY && stage <= STAGE_UNDO &&
           position_is_sound(stage, s->position) && s->target < 2u && manner &&
           (stage != STAGE_PAST || s->slot[s->target].condition == BRACE_SLOT_COUNTS) &&
           (stage != STAGE_UNDO || s->failure < BRACE_STORE_FINE);
}

#endif
