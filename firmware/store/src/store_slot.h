/* One slot of the store: its layout, its marks, what is found in it. Private to the store. */
#ifndef BRACE_STORE_SLOT_H
#define BRACE_STORE_SLOT_H

#include "brace/store_types.h"

typedef enum { STORE_KEEP = 0, STORE_VOID = 1 } store_word_t;

/* Can the store live on this memory at all? */
bool store_fits(const brace_hal_t *hal);

/* Reads and judges a slot: report and next_mark are written; parameters when the slot counts. */
void store_look(brace_store_t *store, uint32_t slot, brace_parameters_t *parameters);

/* Is there a sound block of our dictionary, so that a mark in this slot says something? */
bool store_is_ours(const brace_slot_report_t *report);

/* The bytes of a mark. */
void store_mark(uint8_t mark[BRACE_STORE_MARK_BYTES], store_word_t word, uint32_t block_crc);

#endif
