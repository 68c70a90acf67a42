/* Whether what moves the limb may go on, and whether it stands. One owner has begun it; when the owner falls silent, or
 * somebody stops it, every set-point stays where it is until an owner asks for something else. */
#ifndef BRACE_SESSION_OWNERSHIP_H
#define BRACE_SESSION_OWNERSHIP_H

#include "session/session.h"

typedef struct {
    session_t session;
    bool program_moves;     /* the program around the controller has begun what moves the limb; it lives as we do */
    bool is_held;           /* all set-points stand */
    bool waits_for_life;    /* on a bench: what was asked for begins with the owner's first sign of life */
    bool was_held;          /* before it was asked for */
    bool fell_silent;       /* it stands because its owner is gone */
    uint32_t held_us;       /* for how long */
    bool is_by_wire;        /* what is asked for now comes over a wire */
    bool has_configurer;    /* on a bench: whose CONFIGURATION it is */
    brace_who_t configurer;
    int32_t last_refusal;
} ownership_t;

/* What the limb does. */
typedef struct {
    bool runs;       /* something of ours adds to the set-points: moving, held, or waiting to begin */
    bool moves;      /* set-points change, or would if they were not held */
    bool configures; /* the mode is CONFIGURATION */
    bool stores;     /* a set is being stored: the processor may have stood still for 2 s */
    uint32_t since_us;
    uint32_t let_go_after_us; /* 0: never */
} ownership_inputs_t;

typedef enum {
    OWNERSHIP_GOES_ON,
    OWNERSHIP_STOPS,   /* from this tick on the limb stands: a loading test is over */
    OWNERSHIP_FORGETS, /* no sign of life came: what was asked for is taken back */
    OWNERSHIP_LETS_GO  /* the owner has been silent for let_go_after_us */
} ownership_step_t;

/* Does nobody own or want anything? Then there is nothing to step, while nothing of ours moves the limb. */
static inline bool ownership_is_idle(const ownership_t *ownership)
{
    const session_t *session = &ownership->session;
    const bool wants_challenge = session->setting == BRACE_SETTING_GUARDED && !session->has_challenge;
    return !(session->is_open || session->has_heard || wants_challenge || ownership->is_held ||
             ownership->program_moves || ownership->has_configurer);
}

/* One tick, before anything moves. At most 100 instructions. */
ownership_step_t ownership_step(ownership_t *ownership, const ownership_inputs_t *inputs);

/* What has been asked for is to move the limb from now on. Over a wire of a bench, with the first sign of life. */
void ownership_begin(ownership_t *ownership);

/* Everything stands from now on. returns whether something waited to begin, which is to be taken back */
bool ownership_stop(ownership_t *ownership);

/* On a bench: may this master write? The first that enters CONFIGURATION has it until it ends.
 *   has_gone: whoever has it is not there any more
 * returns BRACE_OK, BRACE_REFUSED_OWNED */
int32_t ownership_may_write(ownership_t *ownership, brace_who_t who, bool has_gone);

#endif
