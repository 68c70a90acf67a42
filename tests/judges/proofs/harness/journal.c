/* A piece of a journal's scan, the beginning of a record or a piece of its writing, from any state that a journal can
 * be in, over a memory of any content that refuses what it likes. */
#include "brace/drift.h"
#include "brace/journal.h"

#include "memory.h"
#include "src/journal.c"

uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    (void)crc;
    PROVE(count == 0u || __CPROVER_r_ok(bytes, count), "the CRC is of bytes that are there");
    return any_u32();
}

static bool whole_pieces(uint32_t bytes)
{
    return bytes % PIECE == 0u;
}

/* The scan is somewhere: at a piece, or within a record that began at one. */
static bool scan_is_sound(const brace_journal_t *j)
{
    const uint32_t within = (uint32_t)j->pieces * PIECE;
    return j->state != BRACE_JOURNAL_BUSY && whole_pieces(j->end) && j->end <= BRACE_JOURNAL_MOST_BYTES &&
           j->slot <= 2u && (j->slot < 2u || j->end == 0u) && whole_pieces(j->position) && j->position <= j->end &&
           whole_pieces(j->next) && j->next <= j->end && j->pieces < BRACE_JOURNAL_PIECES &&
           (j->pieces == 0u ||
            (j->begun < j->end && j->begun + within == j->position && j->begun + BRACE_JOURNAL_RECORD_BYTES <= j->end));
}

/* Rises with every piece; a scan has as many as that at most. */
static uint32_t progress(const brace_journal_t *j)
{
    const uint32_t at = j->pieces > 0u ? j->begun : j->position;
    return at / PIECE * (BRACE_JOURNAL_PIECES + 1u) + j->pieces;
}

/* A record is being written where there is room for it. */
static bool writing_is_sound(const brace_journal_t *j)
{
    return j->state == BRACE_JOURNAL_BUSY && j->slot < 2u && whole_pieces(j->end) &&
           j->end <= BRACE_JOURNAL_MOST_BYTES && whole_pieces(j->next) && whole_pieces(j->position) &&
           j->position < BRACE_JOURNAL_RECORD_BYTES && (j->clean || j->position == 0u) && j->next <= j->end &&
           (j->clean ? 0u : (uint32_t)ZEROED) + BRACE_JOURNAL_RECORD_BYTES <= j->end - j->next;
}

static void scans(brace_journal_t *journal)
{
    uint8_t state[BRACE_JOURNAL_STATE_BYTES];
    const uint32_t at = any_u32(), before = progress(journal);
    ASSUME(at < sizeof state);
    const uint8_t byte = state[at]; /* any one of it, so all */
    const bool found = journal->found, more = brace_journal_scan(journal, state);

    PROVE(more ? scan_is_sound(journal) : journal->position >= journal->end,
          "a piece of a sound scan ends in one, or the scan ends");
    PROVE(journal->next <= journal->end && whole_pieces(journal->next), "the next record goes within the journal");
    PROVE(!more || progress(journal) > before, "each piece comes nearer to the end");
    PROVE(!more || progress(journal) < BRACE_JOURNAL_SCANS, "and that is no further than promised");
    PROVE(memory_writes == 0u && memory_erases == 0u, "a scan writes nothing");
    PROVE(found || journal->found || state[at] == byte, "a state is given only with a whole record");
}

static void writes(brace_journal_t *journal)
{
    const uint32_t next = journal->next;
    const bool clean = journal->clean;
    const uint32_t before = journal->position + (clean ? 1u : 0u);

    const brace_journal_state_t state = brace_journal_step(journal);

    PROVE(memory_writes == 1u && memory_erases == 0u, "one write a step");
    PROVE(written_slot == journal->slot && written_at == BRACE_JOURNAL_AT + next + (clean ? before - 1u : 0u),
          "right behind the last");
    if (state == BRACE_JOURNAL_BUSY) {
        PROVE(writing_is_sound(journal), "a step from a sound state ends in one");
        PROVE(journal->position + (journal->clean ? 1u : 0u) > before, "each step comes nearer to the end");
    } else {
        PROVE(state == BRACE_JOURNAL_FAILED || journal->next <= journal->end, "a record ends within the journal");
        PROVE(journal->next > next && whole_pieces(journal->next), "the next one goes behind it, whatever came of it");
    }
}

int main(void)
{
    brace_journal_t journal; /* of any content */
    journal.hal = &any_memory;
    ASSUME(*(const uint8_t *)&journal.clean <= 1u && *(const uint8_t *)&journal.found <= 1u);
    memory_writes = memory_erases = 0;
    memory_from = BRACE_JOURNAL_AT;
    memory_end = BRACE_JOURNAL_AT + journal.end;
    if (any_bool()) {
        ASSUME(scan_is_sound(&journal));
        scans(&journal);
    } else if (any_bool()) {
        ASSUME(writing_is_sound(&journal));
        writes(&journal);
    } else { /* after a scan, or a record that stands or has failed: behind the end there is no room */
        brace_drift_t learned;
        ASSUME(journal.state != BRACE_JOURNAL_BUSY && journal.slot < 2u && whole_pieces(journal.end) &&
               whole_pieces(journal.next) && journal.end <= BRACE_JOURNAL_MOST_BYTES &&
               journal.next <= 2u * BRACE_JOURNAL_MOST_BYTES);
        if (brace_journal_begin(&journal, &learned)) {
            PROVE(writing_is_sound(&journal), "a record is begun where there is room for it");
        }
        PROVE(memory_writes == 0u && memory_erases == 0u, "and that writes nothing yet");
    }
    return 0;
}
