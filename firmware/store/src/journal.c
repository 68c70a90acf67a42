#include "brace/journal.h"

#include <string.h>

#include "brace/parameters.h"

enum { PIECE = BRACE_JOURNAL_PIECE_BYTES, ZEROED = 2 * PIECE };

static const uint8_t zeros[ZEROED];

_Static_assert(BRACE_JOURNAL_COVERED_BYTES / PIECE == (BRACE_JOURNAL_COVERED_BYTES + 3) / PIECE,
               "the CRC is in one piece");

static void compose_header(const brace_journal_t *journal, uint8_t header[BRACE_JOURNAL_HEADER_BYTES])
{
    const uint32_t words[2] = {(uint32_t)BRACE_JOURNAL_STATE_BYTES | (uint32_t)BRACE_JOURNAL_FORMAT << 16,
                               journal->identity};
    memcpy(header, "DRFT", 4);
    for (uint32_t i = 0; i < 8u; i++) {
        header[4u + i] = (uint8_t)(words[i / 4u] >> (8u * (i % 4u)));
    }
}

static bool is_blank(const uint8_t *bytes)
{
    uint32_t all = UINT32_MAX, word;
    for (uint32_t i = 0; i < PIECE; i += sizeof word) {
        memcpy(&word, bytes + i, sizeof word);
        all &= word;
    }
    return all == UINT32_MAX;
}

void brace_journal_open(brace_journal_t *journal, const brace_hal_t *hal, uint32_t slot, uint32_t identity)
{
    memset(journal, 0, sizeof *journal);
    journal->hal = hal;
    journal->slot = (uint8_t)slot;
    journal->identity = identity;
    const uint32_t slot_bytes = slot < BRACE_NVM_SLOT_COUNT ? hal->nvm_shape.slot_bytes : 0u;
    const uint32_t beyond = slot_bytes > BRACE_JOURNAL_AT ? slot_bytes - BRACE_JOURNAL_AT : 0u;
    journal->end = (beyond < BRACE_JOURNAL_MOST_BYTES ? beyond : (uint32_t)BRACE_JOURNAL_MOST_BYTES) / PIECE * PIECE;
}

void brace_journal_open_erased(brace_journal_t *journal, const brace_hal_t *hal, uint32_t slot, uint32_t identity)
{
    brace_journal_open(journal, hal, slot, identity);
    journal->position = journal->end; /* nothing to scan */
    journal->clean = true;
}

/* The CRC over another piece of the record, as far as it covers it. */
static void cover(brace_journal_t *journal, uint32_t at)
{
    const uint32_t end = at + PIECE < BRACE_JOURNAL_COVERED_BYTES ? at + PIECE : (uint32_t)BRACE_JOURNAL_COVERED_BYTES;
    journal->crc = brace_crc32(at == 0u ? 0u : journal->crc, journal->record + at, at < end ? end - at : 0u);
}

static uint32_t crc_of_record(const brace_journal_t *journal)
{
    const uint8_t *crc = journal->record + BRACE_JOURNAL_COVERED_BYTES;
    return (uint32_t)crc[0] | (uint32_t)crc[1] << 8 | (uint32_t)crc[2] << 16 | (uint32_t)crc[3] << 24;
}

/* Another piece of a record has been read. One that is not whole may hide a later one:
 * the scan goes on behind its header. */
static void take_piece(brace_journal_t *journal, void *state)
{
    cover(journal, (uint32_t)journal->pieces * PIECE);
    journal->pieces++;
    if (journal->pieces < BRACE_JOURNAL_PIECES) {
        return;
    }
    journal->pieces = 0;
    if (journal->crc == crc_of_record(journal)) {
        memcpy(state, journal->record + BRACE_JOURNAL_HEADER_BYTES, BRACE_JOURNAL_STATE_BYTES);
        journal->found = true;
    } else {
        journal->position = journal->begun + PIECE;
    }
}

bool brace_journal_scan(brace_journal_t *journal, void *state)
{
    uint8_t header[BRACE_JOURNAL_HEADER_BYTES];
    if (journal->position >= journal->end) {
        return false;
    }
    uint8_t *piece = journal->record + (uint32_t)journal->pieces * PIECE;
    if (journal->hal->nvm_read(journal->hal->context, journal->slot, BRACE_JOURNAL_AT + journal->position, piece,
                               PIECE) != BRACE_HAL_OK) {
        journal->next = journal->position = journal->end; /* no journal: what was found so far counts */
        return false;
    }
    const uint32_t at = journal->position;
    journal->position += PIECE;
    journal->next = is_blank(piece) || journal->next > at ? journal->next : at + PIECE;
    if (journal->pieces == 0u) {
        compose_header(journal, header);
        journal->begun = at;
        if (memcmp(piece, header, sizeof header) != 0 || at + BRACE_JOURNAL_RECORD_BYTES > journal->end) {
            return journal->position < journal->end;
        }
    }
    take_piece(journal, state);
    return journal->position < journal->end;
}

uint32_t brace_journal_room(const brace_journal_t *journal)
{
    const uint32_t from = journal->next + (journal->clean ? 0u : (uint32_t)ZEROED);
    return from < journal->end ? (journal->end - from) / BRACE_JOURNAL_RECORD_BYTES : 0u;
}

bool brace_journal_begin(brace_journal_t *journal, const void *state)
{
    if (journal->state == BRACE_JOURNAL_BUSY || brace_journal_room(journal) == 0u) {
        return false;
    }
    memset(journal->record + BRACE_JOURNAL_COVERED_BYTES, 0xff, sizeof journal->record - BRACE_JOURNAL_COVERED_BYTES);
    compose_header(journal, journal->record);
    memcpy(journal->record + BRACE_JOURNAL_HEADER_BYTES, state, BRACE_JOURNAL_STATE_BYTES);
    journal->position = 0;
    journal->state = BRACE_JOURNAL_BUSY;
    return true;
}

static bool write(const brace_journal_t *journal, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    return journal->hal->nvm_write(journal->hal->context, journal->slot, BRACE_JOURNAL_AT + offset, bytes, count) ==
           BRACE_HAL_OK;
}

/* What was written of the record stays where it is, as no record; the next try goes behind it. */
static brace_journal_state_t fail(brace_journal_t *journal)
{
    journal->next += BRACE_JOURNAL_RECORD_BYTES;
    journal->clean = false;
    return journal->state = BRACE_JOURNAL_FAILED;
}

brace_journal_state_t brace_journal_step(brace_journal_t *journal)
{
    uint8_t found[PIECE];
    if (journal->state != BRACE_JOURNAL_BUSY) {
        return (brace_journal_state_t)journal->state;
    }
    if (!journal->clean) {
        const bool written = write(journal, journal->next, zeros, ZEROED);
        journal->next += ZEROED;
        journal->clean = true;
        return written ? BRACE_JOURNAL_BUSY : fail(journal);
    }
    const uint32_t at = journal->position, offset = journal->next + at;
    const uint8_t *piece = journal->record + at;
    cover(journal, at);
    if (at + PIECE == BRACE_JOURNAL_RECORD_BYTES) {
        for (uint32_t i = 0; i < 4u; i++) {
            journal->record[BRACE_JOURNAL_COVERED_BYTES + i] = (uint8_t)(journal->crc >> (8u * i));
        }
    }
    if (!write(journal, offset, piece, PIECE) ||
        journal->hal->nvm_read(journal->hal->context, journal->slot, BRACE_JOURNAL_AT + offset, found, PIECE) !=
            BRACE_HAL_OK ||
        memcmp(piece, found, PIECE) != 0) {
        return fail(journal);
    }
    journal->position += PIECE;
    if (journal->position == BRACE_JOURNAL_RECORD_BYTES) {
        journal->next += BRACE_JOURNAL_RECORD_BYTES;
        journal->state = BRACE_JOURNAL_READY;
    }
    return (brace_journal_state_t)journal->state;
}
