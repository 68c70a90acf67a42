/* One slot of the store: its layout, its marks, what is found in it. Private to the store. */
#ifndef BRACE_STORE_SLOT_H
#define BRACE_STORE_SLOT_H

#include "brace/store_types.h"

typedef enum { STORE_KEEP = 0, STORE_VOID = 1, STORE_PAST = 2 } store_word_t;

/* Can the store live on this memory at all? */
bool store_fits(const brace_hal_t *hal);

/* What a slot says beside its report. */
typedef struct {
    bool is_past;      /* it counts, and another set has followed it: */
    uint32_t later;    /* by so many sequences */
    bool is_rotten;    /* it was kept, no set has followed it, and its block does not pass: */
    uint32_t sequence; /* as its block says now */
} store_claim_t;

/* Reads and judges a slot: report, next_mark and claim are written; parameters when the slot counts. */
void store_look(brace_store_t *store, uint32_t slot, brace_parameters_t *parameters, store_claim_t *claim);

/* Is there a sound block of our dictionary, so that a mark in this slot says something? */
bool store_is_ours(const brace_slot_report_t *report);

/* The bytes of a mark. later: of PAST, how many sequences later the set is that followed (modulo 2^16) */
void store_mark(uint8_t mark[BRACE_STORE_MARK_BYTES], store_word_t word, uint32_t later, uint32_t block_crc);

#endif
