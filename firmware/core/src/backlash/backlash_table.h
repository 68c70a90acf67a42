/* Transitions of the preload state machine and of a take-up, as data. */
#ifndef BRACE_BACKLASH_TABLE_H
#define BRACE_BACKLASH_TABLE_H

#include <stdint.h>

/* Facts of a tick, one bit each; a transition needs all of its bits. */
enum {
    FACT_BAD_SAMPLE = 1u << 0,
    FACT_POSITIVE = 1u << 1, /* the load says so */
    FACT_NEGATIVE = 1u << 2,
    FACT_LEFT = 1u << 3, /* the motor has left the flank without a load */
    FACT_STALE = 1u << 4, /* the load has told nothing for too long */
    FACT_TAKING_UP = 1u << 5,
    FACT_NOT_TAKING_UP = 1u << 6,

    FACT_REQUESTED = 1u << 7,
    FACT_LET_GO = 1u << 8,
    FACT_PRELOADED = 1u << 9, /* load on the chosen flank as wanted */
    FACT_UNLOADED = 1u << 10, /* no longer proven on the chosen flank */
    FACT_TORQUE = 1u << 11,
    FACT_TRAVEL = 1u << 12,
    FACT_REACH = 1u << 13,
    FACT_TIME = 1u << 14,
    FACT_MOVED = 1u << 15, /* while it should stand */
    FACT_BACK = 1u << 16, /* the command is where it began */
    FACT_VERIFIED = 1u << 17,
    FACT_ALWAYS = 0u
};

typedef struct {
    uint32_t facts;    /* all needed */
    uint32_t after_us; /* and this long in the state */
    uint8_t to;
    int8_t result; /* of a take-up; 0 leaves it */
} transition_t;

typedef struct {
    const transition_t *rows; /* the first that applies is taken */
    uint8_t count;
} transitions_t;

extern const transitions_t backlash_states[];
extern const transitions_t takeup_phases[];

/* The first row that applies, or null. */
const transition_t *transition_find(const transitions_t *from, uint32_t facts, uint32_t in_state_us);

#endif
