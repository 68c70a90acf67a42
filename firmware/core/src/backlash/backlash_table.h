/* Transitions of the preload state machine and of a take-up, as data. */
#ifndef BRACE_BACKLASH_TABLE_H
#define BRACE_BACKLASH_TABLE_H

#include <stdint.h>

/* Facts of a tick, one bit each; a transition needs all of its bits. */
enum {
    FACT_BAD_SAMPLE = 1u << 0,
    FACT_POSITIVE = 1u << 1, /* the load proves the positive flank */
    FACT_NEGATIVE = 1u << 2,
    FACT_LEFT = 1u << 3, /* the motor has left the flank without a load */
    FACT_STALE = 1u << 4, /* the load has shown no flank for too long */
    FACT_TAKING_UP = 1u << 5,
    FACT_NOT_TAKING_UP = 1u << 6,

    FACT_REQUESTED = 1u << 7,
    FACT_LET_GO = 1u << 8,
    FACT_PRELOADED = 1u << 9, /* the load on the chosen flank is as large as wanted */
    FACT_UNLOADED = 1u << 10, /* the load no longer proves the chosen flank */
    FACT_TORQUE = 1u << 11,
    FACT_TRAVEL = 1u << 12,
    FACT_REACH = 1u << 13,
    FACT_TIME = 1u << 14,
    FACT_MOVED = 1u << 15, /* the motor moved while it should stand */
    FACT_BACK = 1u << 16, /* the command is where it began */
    FACT_VERIFIED = 1u << 17,
    FACT_ALWAYS = 0u
};

typedef struct {
    uint32_t facts;    /* all of these are needed */
    uint32_t after_us; /* and this time in the state */
    uint8_t to;
    int8_t result; /* new result of the take-up; 0 keeps the old one */
} transition_t;

typedef struct {
    const transition_t *rows; /* the first row that applies is taken */
    uint8_t count;
} transitions_t;

extern const transitions_t backlash_states[];
extern const transitions_t takeup_phases[];

/* The first row that applies, or null. */
const transition_t *transition_find(const transitions_t *from, uint32_t facts, uint32_t in_state_us);

#endif
