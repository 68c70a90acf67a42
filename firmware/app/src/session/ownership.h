/* May a take-up or a loading test go on moving the limb, or does the limb stand? One owner has begun the motion. When
 * the owner falls silent, or when somebody stops the motion, every set-point stays where it is until an owner asks for
 * something else. What an owner asks for waits until its sign of life shows that it has heard the answer; whatever the
 * limb does goes on meanwhile. */
#ifndef BRACE_SESSION_OWNERSHIP_H
#define BRACE_SESSION_OWNERSHIP_H

#include "session/session.h"

typedef struct {
    session_t session;
    bool program_moves;     /* the program around the controller has begun the motion; it needs no signs of life */
    bool is_held;           /* all set-points stand */
    bool waits;             /* what was asked for begins with the owner's sign of life */
    bool fell_silent;       /* the limb stands because its owner is gone */
    uint32_t held_us;       /* how long the limb has stood so */
    bool is_by_wire;        /* what is asked for now comes over a wire */
    bool has_configurer;    /* on a bench: a master has entered CONFIGURATION, */
    brace_who_t configurer; /* and this is the master */
    int32_t last_refusal;
} ownership_t;

/* What the limb does. */
typedef struct {
    bool runs;       /* a take-up or a loading test adds to the set-points: it moves, or is held */
    bool moves;      /* set-points change, or would if they were not held */
    bool configures; /* the mode is CONFIGURATION */
    bool stores;     /* a set is being stored: the processor may have stood still for 2 s */
    uint32_t since_us;
    uint32_t let_go_after_us; /* 0: never */
} ownership_inputs_t;

typedef enum {
    OWNERSHIP_GOES_ON,
    OWNERSHIP_STOPS,   /* from this tick on the limb stands: a loading test is over */
    OWNERSHIP_BEGINS,  /* the sign of life has come: what was asked for begins */
    OWNERSHIP_LETS_GO  /* the owner has been silent for let_go_after_us */
} ownership_step_t;

/* Is there no owner, and nothing that is held? While the controller does not move the limb either, the caller may leave
 * ownership_step out. */
static inline bool ownership_is_idle(const ownership_t *ownership)
{
    const session_t *session = &ownership->session;
    const bool wants_challenge = session->setting == BRACE_SETTING_GUARDED && !session->has_challenge;
    return !(session->is_open || wants_challenge || ownership->is_held || ownership->program_moves ||
             ownership->has_configurer);
}

/* One tick, before anything moves. At most 100 instructions. */
ownership_step_t ownership_step(ownership_t *ownership, const ownership_inputs_t *inputs);

/* What an owner has asked for over a wire waits for its sign of life, with the number that session.begin is from now
 * on. What has waited before is forgotten. */
void ownership_wait(ownership_t *ownership);

/* From now on something else moves the limb: what has waited, or what the program around the controller asks for. */
void ownership_begin(ownership_t *ownership);

/* From now on the limb stands, and nothing waits to begin.
 *   runs: as of ownership_inputs_t */
void ownership_stop(ownership_t *ownership, bool runs);

/* On a bench: may this master write? The master that enters CONFIGURATION first is the only one that may, until
 * CONFIGURATION ends.
 *   has_gone: the connection of that master is closed, so another one may go on
 * returns BRACE_OK, BRACE_REFUSED_OWNED */
int32_t ownership_may_write(ownership_t *ownership, brace_who_t who, bool has_gone);

#endif
