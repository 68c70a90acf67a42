/* The parameter store's types: what a slot holds, what the store does, how it failed. */
#ifndef BRACE_STORE_TYPES_H
#define BRACE_STORE_TYPES_H

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
    BRACE_SLOT_DAMAGED = 4,       /* a block whose CRC does not fit, or a kept slot whose block is none any more */
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

/* State. Private but for what brace_store_status reports; here so that it can be placed without a heap. */
typedef struct {
    const brace_hal_t *hal;
    brace_slot_report_t slot[BRACE_NVM_SLOT_COUNT];
    uint8_t next_mark[BRACE_NVM_SLOT_COUNT]; /* where the next mark goes */
    bool is_old;              /* the set in force is not the one that was kept last */
    uint32_t wanted_sequence; /* of that one, while is_old; while a slot gets the mark PAST: of the set that follows */
    bool affirmed[BRACE_NVM_SLOT_COUNT]; /* its last mark is a KEEP that this session has written whole */
    bool clean[BRACE_NVM_SLOT_COUNT]; /* nothing has touched that place since the erase */
    uint8_t in_force; /* brace_parameter_origin_t */
    uint8_t state;
    uint8_t stage;
    uint8_t target; /* slot that an update writes, or that a roll-back puts in force */
    int8_t failure, refusal;
    bool rolling_back, reloading, memory_fault;
    uint32_t position; /* within the stage [bytes] */
    uint32_t sequence; /* of the set on its way */
    uint32_t block_crc; /* CRC of the block that is being read, as far as it has been read */
    uint32_t identity; /* brace_parameters_crc, as far as it has been read */
    bool is_named; /* only a set with this brace_parameters_crc is stored */
    uint32_t named_crc;
    uint32_t erases; /* of a slot, since start; saturates */
    uint32_t wrong_index; /* with E_REFUSED */
    uint8_t block[BRACE_STORE_BLOCK_ROOM]; /* on its way */
} brace_store_t;

typedef struct {
    brace_store_state_t state;
    brace_store_failure_t failure; /* of the last update or roll-back */
    brace_status_t refusal; /* with E_REFUSED: what brace_parameters_check says, and of which member */
    uint32_t wrong_index;
    brace_parameter_origin_t in_force;
    uint32_t sequence; /* of the set in force; 0 for the defaults */
    bool is_old; /* a newer set was kept and is not whole any more: BRACE_FAULT_OLD_PARAMETERS */
    uint32_t wanted_sequence; /* of the set that was kept last, as far as its slots say; the same as sequence while
                                      not is_old */
    brace_slot_report_t slot[BRACE_NVM_SLOT_COUNT];
    bool can_roll_back;
    bool memory_fault; /* the last update failed on the memory, or it does not answer: BRACE_FAULT_STORE */
} brace_store_status_t;

#endif
