/* Why a request over CAN was refused: the status in part 7 of an answer. From -1 to -63 a brace_status_t; these beside
 * it. Values never change. */
#ifndef BRACE_REFUSALS_H
#define BRACE_REFUSALS_H

enum {
    BRACE_REFUSED_UNKNOWN = -64, /* no such request; detail: the highest one there is */
    BRACE_REFUSED_KEY = -65,     /* set_mode without its key */
    BRACE_REFUSED_BUSY = -66,    /* a set is being stored, or the limb goes back from a loading test: ask again */
    BRACE_REFUSED_ORDER = -67,   /* words in order only; detail: the one that is expected */
    BRACE_REFUSED_CHANGED = -68, /* the set in force has changed meanwhile: begin again with word 0 */
    BRACE_REFUSED_READ_ONLY = -69,
    BRACE_REFUSED_STRANGER = -70, /* guarded: no session is open, or the check does not fit */
    BRACE_REFUSED_REPLAY = -71,   /* guarded: the counter is not larger than the last one */
    BRACE_REFUSED_OWNED = -72,    /* somebody else is the owner */
    BRACE_REFUSED_NO_KEY = -73,   /* guarded, and the board has no key */
    BRACE_REFUSED_CEILING = -74,  /* beyond what the board allows; detail: the parameter's number */
    BRACE_REFUSED_EARLY = -75, /* a commit less than 10 s after the one before; detail: milliseconds that are left */
    BRACE_REFUSED_CROWDED = -76, /* so many questions of this asker wait already: ask again; detail: how many may */
    BRACE_REFUSED_LATE = -77, /* a sign of life with a number that is too old; detail: the one of now */
    BRACE_REFUSED_STORE = -80 /* plus brace_store_failure_t (-81 to -87): the set of before stays in force */
};

#endif
