/* The parameter store: two slots of the non-volatile memory, of which the newest whole one is in force.
 *
 *     slot  0  parameter block (brace/parameters.h), up to 3584 bytes whatever firmware wrote it
 *        3584  64 marks of 8 bytes: a word "KEEP" or "VOID" and the block's CRC, little-endian; the rest stays erased
 *
 * A slot counts when its block is sound and its last legible mark is KEEP; of two that count, the one with the newer
 * sequence is in force (modulo 2^32). An update writes the other slot:
 *     KEEP to the slot in force; VOID to the other, zeros over its first bytes, erase; the block, read back;
 *     KEEP to it
 * and a roll-back puts the other slot in force:
 *     KEEP to the other; it is read again, whole; VOID to the one in force
 * Every stage is one of those orders, so wherever power fails, a start finds the old set or the new one. The KEEP at
 * the beginning is there because power may have failed within the last one: a unit that was being written may read
 * differently each time, until something whole stands after it. What an interrupted operation left open (the old set or
 * the new one) therefore stays open until the next operation's marks stand. Marks are only ever added. A place that
 * looks erased may have been touched as power failed, so each session writes zeros over two first and its mark behind.
 * Zeros are all that is ever written over a unit that is not erased. tests/faults enumerates all of this.
 *
 * Works off the tick: brace_store_step does one erase, or writes or reads at most 32 bytes. The erase stops the
 * processor (brace_hal.h), so updates are for the configuration mode. One brace_store_t per limb; one thread, the
 * application's. No heap, no recursion, no libm. Stack: at most 600 bytes; brace_store_start 1,500.
 */
#ifndef BRACE_STORE_H
#define BRACE_STORE_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace_hal.h"

enum {
    BRACE_STORE_MARKS_AT = 3584, /* of a slot [bytes]; never changes, so that any firmware finds them */
    BRACE_STORE_MARK_BYTES = 8,
    BRACE_STORE_MARK_COUNT = 64,
    BRACE_STORE_MARKS_KEPT_FREE = 8, /* of these, for what must be said */
    BRACE_STORE_PIECE_BYTES = 32,    /* of one step */
    BRACE_STORE_BLOCK_ROOM = (BRACE_BLOCK_BYTES + 7) / 8 * 8
};

/* What a start found in a slot. */
typedef enum {
    BRACE_SLOT_EMPTY = 0,         /* erased, or nothing that was ever a block */
    BRACE_SLOT_COUNTS = 1,        /* whole and kept: in force, or the one to go back to */
    BRACE_SLOT_NOT_COMMITTED = 2, /* sound, but its writing was not finished */
    BRACE_SLOT_VOID = 3,          /* sound, and taken out of force by an update or a roll-back */
    BRACE_SLOT_DAMAGED = 4,       /* a block whose CRC does not fit */
    BRACE_SLOT_OTHER_SCHEMA = 5,  /* sound, of another firmware's dictionary (schema_hash): refused, left as it is */
    BRACE_SLOT_REFUSED = 6,       /* sound, of our dictionary, and a value is out of range (wrong_index) */
    BRACE_SLOT_UNREADABLE = 7     /* the memory does not answer */
} brace_slot_condition_t;

typedef struct {
    brace_slot_condition_t condition;
    uint32_t sequence;    /* these four: 0 where the condition leaves them unknown */
    uint32_t schema_hash;
    uint32_t block_crc;
    uint32_t wrong_index; /* of brace_parameter_key */
} brace_slot_report_t;

typedef enum {
    BRACE_STORE_IDLE = 0,
    BRACE_STORE_BUSY = 1,
    BRACE_STORE_DONE = 2,  /* the new set is kept and in force: brace_store_take */
    BRACE_STORE_FAILED = 3 /* the old set stays in force; failure says why */
} brace_store_state_t;

typedef enum {
    BRACE_STORE_FINE = 0,
    BRACE_STORE_E_DEVICE = -1,   /* the memory refused a read, a write or an erase */
    BRACE_STORE_E_ERASE = -2,    /* not blank after an erase */
    BRACE_STORE_E_READ_BACK = -3, /* what was written is not what reads back */
    BRACE_STORE_E_NOTHING = -4,  /* roll-back: the other slot does not count */
    BRACE_STORE_E_FULL = -5,     /* no room for a mark: some twenty updates in a row were interrupted; update once */
    BRACE_STORE_E_SHAPE = -6,    /* slots too small, or a unit other than 1, 2, 4, 8 */
    BRACE_STORE_E_REFUSED = -7   /* brace_parameters_check refuses the set; nothing was touched */
} brace_store_failure_t;

/* State. Private but for what brace_store_status tells; here so that it can be placed without a heap. */
typedef struct {
    const brace_hal_t *hal;
    brace_slot_report_t slot[BRACE_NVM_SLOT_COUNT];
    uint8_t next_mark[BRACE_NVM_SLOT_COUNT]; /* where the next mark goes */
    bool affirmed[BRACE_NVM_SLOT_COUNT];     /* its last mark is a KEEP that this session has written whole */
    bool clean[BRACE_NVM_SLOT_COUNT];        /* nothing has touched that place since the erase */
    uint8_t in_force;                        /* brace_parameter_origin_t */
    uint8_t state;
    uint8_t stage;
    uint8_t target;         /* slot that an update writes, or that a roll-back puts in force */
    int8_t failure, refusal;
    bool rolling_back, memory_fault;
    uint32_t position;      /* within the stage [bytes] */
    uint32_t sequence;      /* of the set on its way */
    uint32_t block_crc;     /* of what is being read */
    uint32_t identity;      /* brace_parameters_crc, as far as it has been read */
    uint32_t wrong_index;   /* with E_REFUSED */
    uint8_t block[BRACE_STORE_BLOCK_ROOM]; /* on its way */
} brace_store_t;

typedef struct {
    brace_store_state_t state;
    brace_store_failure_t failure; /* of the last update or roll-back */
    brace_status_t refusal;        /* with E_REFUSED: what brace_parameters_check says, and of which member */
    uint32_t wrong_index;
    brace_parameter_origin_t in_force;
    uint32_t sequence;             /* of the set in force; 0 for the defaults */
    brace_slot_report_t slot[BRACE_NVM_SLOT_COUNT];
    bool can_roll_back;
    bool memory_fault;             /* the last update failed on the memory, or it does not answer: BRACE_FAULT_STORE */
} brace_store_status_t;

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

/* One bounded piece of what is under way; call it each tick. In IDLE, DONE and FAILED it does nothing.
 * returns the state after it
 * cost: at most 2,300 instructions and one call to the memory */
brace_store_state_t brace_store_step(brace_store_t *store);

/* After DONE: the set now in force, as it was read back; the store is IDLE then.
 *   crc (out, may be null): brace_parameters_crc of it
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_UNSUPPORTED (not DONE)
 * cost: 440 instructions */
brace_status_t brace_store_take(brace_store_t *store, brace_parameters_t *parameters, uint32_t *crc);

/* All that can be told; null pointers are ignored. cost: 62 instructions */
void brace_store_status(const brace_store_t *store, brace_store_status_t *status);

/* One line of English, constant storage. */
const char *brace_slot_condition_text(brace_slot_condition_t condition);
const char *brace_store_failure_text(brace_store_failure_t failure);

#endif
