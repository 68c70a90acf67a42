/* The parameter store: two slots of the non-volatile memory, of which the newest whole one is in force.
 *
 *     slot  0  parameter block (brace/parameters.h), up to 3584 bytes whatever firmware wrote it
 *        3584  64 marks of 8 bytes: a word and the block's CRC, little-endian; the rest stays erased. Words: "KEEP",
 *              "VOID", or "PS" (past: kept, and another set has followed) with how many sequences later that set is
 *
 * A slot counts when its block is sound and its last legible mark is KEEP or PAST; of two that count, the one with the
 * newer sequence is in force (modulo 2^32). An update writes the other slot:
 *     KEEP to the slot in force; VOID to the other, zeros over its first bytes, erase; the block, read back;
 *     KEEP to it; PAST to the slot that was in force
 * and a roll-back puts the other slot in force:
 *     KEEP to the other; it is read again, whole; VOID to the one in force, twice, so that no one flaw brings it back
 *
 * The set in force is old when another one was kept after it and is not whole any more (a cell has lost its charge):
 *     the slot in force is PAST, and the other one does not count, whatever is left in it; or
 *     the other slot's last legible mark is KEEP, and its block does not pass. An erase that was interrupted leaves
 *     zeros over the block's first bytes, or nothing: that is no such slot
 * While it is old, an update writes PAST in place of its first KEEP, so that a power cut leaves it old.
 *
 * Every stage is one of those orders, so wherever power fails, a start finds the old set or the new one. The KEEP at
 * the beginning is there because power may have failed within the last one: a unit that was being written may read
 * differently each time, until something whole stands after it. What an interrupted operation left open (the old set or
 * the new one) therefore stays open until the next operation's marks stand. Marks are only ever added. A place that
 * looks erased may have been touched as power failed, so each session writes zeros over two first and its mark behind.
 * Zeros are all that is ever written over a unit that is not erased. tests/judges/memory enumerates all of this.
 *
 * Works off the tick: brace_store_step does one erase, or writes or reads at most 32 bytes. The erase stops the
 * processor (brace_hal.h), so updates are for the configuration mode. One brace_store_t per limb; one thread, the
 * application's. No heap, no recursion, no libm. Stack: at most 600 bytes; brace_store_start 1,500.
 */
#ifndef BRACE_STORE_H
#define BRACE_STORE_H

#include "brace/store_types.h"

/* Start-up: looks at both slots, chooses. Nothing is written.
 *   hal: lives as long as the store
 *   parameters (out): the set in force; the safe defaults when neither slot counts; always written
 * returns where they come from
 * cost: 33,000 instructions; with 3.5 kB of another firmware in both slots 14 more for each byte.
 * Before the first tick */
brace_parameter_origin_t brace_store_start(brace_store_t *store, const brace_hal_t *hal,
                                           brace_parameters_t *parameters);

/* Begins an update, for a tick. The set is copied; the first steps check it and work out its block, before anything is
 * touched: FAILED with E_REFUSED when it is none.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_UNSUPPORTED (BUSY); cost: 700 instructions */
brace_status_t brace_store_offer(brace_store_t *store, const brace_parameters_t *parameters);

/* After an offer, before the next step: stores the set only if this is its brace_parameters_crc. Else it ends in FAILED
 * with E_REFUSED and BRACE_E_CHECKSUM before anything is touched. Null is ignored. */
void brace_store_expect(brace_store_t *store, uint32_t crc);

/* The same off the tick, checked at once. The set is copied; the old one stays in force until DONE. A set that
 * brace_parameters_check refuses is refused with its status and the member at fault; the store stays as it is.
 *   wrong_index (out, may be null): as brace_parameters_check
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_UNSUPPORTED (BUSY), BRACE_E_NOT_FINITE, BRACE_E_PARAMETER
 * cost: 4,000 instructions: not within a tick */
brace_status_t brace_store_begin(brace_store_t *store, const brace_parameters_t *parameters, uint32_t *wrong_index);

/* Begins a roll-back: the other slot's set comes back in force. Ends at once in FAILED, E_NOTHING, when there is none;
 * a roll-back after a roll-back has nothing to go back to: the set that was left is void.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_UNSUPPORTED (BUSY) */
brace_status_t brace_store_rollback(brace_store_t *store);

/* Begins to read the set in force again, because the copy in RAM is not to be believed. Ends in DONE, or in FAILED with
 * E_NOTHING (the defaults are in force), E_DEVICE or E_READ_BACK. Nothing is written.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_UNSUPPORTED (BUSY) */
brace_status_t brace_store_reload(brace_store_t *store);

/* One bounded piece of what is under way; call it each tick. In IDLE, DONE and FAILED it does nothing.
 * returns the state after it
 * cost: at most 2,300 instructions and one call to the memory */
brace_store_state_t brace_store_step(brace_store_t *store);

/* After DONE: the set now in force, as it was read back; the store is IDLE then.
 *   crc (out, may be null): brace_parameters_crc of it
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_UNSUPPORTED (not DONE)
 * cost: 440 instructions */
brace_status_t brace_store_take(brace_store_t *store, brace_parameters_t *parameters, uint32_t *crc);

/* Sequence of the set in force; 0 for the defaults. */
uint32_t brace_store_sequence(const brace_store_t *store);

/* Sequence of the set that was kept last, as far as the slots say; the same while that one is in force. */
uint32_t brace_store_wanted_sequence(const brace_store_t *store);

/* All that the store reports; null pointers are ignored. cost: 62 instructions */
void brace_store_status(const brace_store_t *store, brace_store_status_t *status);

#endif
