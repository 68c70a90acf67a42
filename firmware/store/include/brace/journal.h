/* A journal of one small state in the part of a parameter slot that the store leaves free: what the drift check knows
 * of a limb outlives restarts with it.
 *
 *     slot  0..4095  the store's (brace/store.h)
 *           4096     records in rising order, each of 32-byte pieces: "DRFT", the state's bytes and format, identity,
 *                    state, CRC-32 of all that; the rest of the last piece is 0xff
 *
 * The newest whole record counts. It stands in the slot of the parameter set it belongs to, and goes with it: an update
 * writes the other slot, whose erase has emptied it; a roll-back comes back to the records of the set before. Nothing
 * here is ever erased, and nothing is written below 4096. When it is full, the newest record stays.
 *
 * Power may fail at any write: a start finds the record before or the new one, whole. As with the store's marks, a
 * piece that looks erased may have been touched then, so each session writes zeros over two before its first record.
 * tests/judges/memory enumerates it.
 *
 * Off and on the tick: each call is one bounded piece. One thread. No heap, no recursion. Stack: at most 100 bytes.
 */
#ifndef BRACE_JOURNAL_H
#define BRACE_JOURNAL_H

#include <stdbool.h>
#include <stdint.h>

#include "brace_hal.h"

enum {
    BRACE_JOURNAL_AT = 4096,          /* of a slot [bytes]; never changes */
    BRACE_JOURNAL_MOST_BYTES = 28672, /* of it; what a slot has beyond is not used */
    BRACE_JOURNAL_PIECE_BYTES = 32,
    BRACE_JOURNAL_HEADER_BYTES = 12,
    BRACE_JOURNAL_STATE_BYTES = 344, /* of what the drift check knows: a brace_drift_t */
    BRACE_JOURNAL_COVERED_BYTES = BRACE_JOURNAL_HEADER_BYTES + BRACE_JOURNAL_STATE_BYTES, /* by the CRC */
    BRACE_JOURNAL_PIECES =
        (BRACE_JOURNAL_COVERED_BYTES + 4 + BRACE_JOURNAL_PIECE_BYTES - 1) / BRACE_JOURNAL_PIECE_BYTES,
    BRACE_JOURNAL_RECORD_BYTES = BRACE_JOURNAL_PIECES * BRACE_JOURNAL_PIECE_BYTES,
    BRACE_JOURNAL_SCANS = BRACE_JOURNAL_MOST_BYTES / BRACE_JOURNAL_PIECE_BYTES * (BRACE_JOURNAL_PIECES + 1),
    BRACE_JOURNAL_FORMAT = 1 /* raised whenever the state's layout changes and its size does not */
};

typedef enum {
    BRACE_JOURNAL_READY = 0,
    BRACE_JOURNAL_BUSY = 1,
    BRACE_JOURNAL_FAILED = 2 /* the memory refused, or does not keep what is written; ready for another try */
} brace_journal_state_t;

/* State. Private but for `found`; here so that it can be placed without a heap. */
typedef struct {
    const brace_hal_t *hal;
    uint8_t slot;
    bool found;         /* the scan has come by a whole record of this identity: the newest is in its place */
    bool clean;         /* nothing has touched what lies ahead since it was erased, or overwritten with zeros */
    uint32_t identity;
    uint32_t end, next; /* bytes from BRACE_JOURNAL_AT: the journal's end, where the next record goes */
    uint32_t position;  /* of the scan, or within the record that is written */
    uint32_t begun;     /* of the scan: where the record began that is being read */
    uint32_t crc;       /* of the record so far */
    uint8_t pieces;     /* of it that have been read; 0: none is being read */
    uint8_t state;      /* brace_journal_state_t */
    uint8_t record[BRACE_JOURNAL_RECORD_BYTES];
} brace_journal_t;

/* Opens the journal of a slot, to be scanned next; without room for one (slots of 4,096 bytes) it is always full.
 *   slot: BRACE_NVM_SLOT_COUNT: none
 *   identity: of what the state belongs to; records of another one are passed over */
void brace_journal_open(brace_journal_t *journal, const brace_hal_t *hal, uint32_t slot, uint32_t identity);

/* The same of a slot that has just been erased: there is nothing to scan. */
void brace_journal_open_erased(brace_journal_t *journal, const brace_hal_t *hal, uint32_t slot, uint32_t identity);

/* One piece of the scan: 32 bytes. A whole record of this identity is copied to state, a later one over it.
 *   state (out): BRACE_JOURNAL_STATE_BYTES
 * returns whether there is more: at most BRACE_JOURNAL_SCANS calls. At most 900 instructions */
bool brace_journal_scan(brace_journal_t *journal, void *state);

/* How many records there is still room for. */
uint32_t brace_journal_room(const brace_journal_t *journal);

/* Begins to write a record. false: no room, or one is being written. At most 300 instructions */
bool brace_journal_begin(brace_journal_t *journal, const void *state);

/* One piece of it: 32 bytes are written and read back. At most 700 instructions and two calls to the memory. */
brace_journal_state_t brace_journal_step(brace_journal_t *journal);

#endif
