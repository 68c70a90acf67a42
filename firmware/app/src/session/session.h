/* Who may move the limb and write to its controller? There is one owner at a time, and the owner gives signs of life.
 *
 * On a bench, the master that begins a motion first owns it. The session tells masters apart by their port and number.
 * On a guarded board, a master becomes the owner when it answers the session's challenge with a check under the key.
 * From then on every command and every sign of life carries a counter and a check over challenge, counter and command.
 * Each session has a challenge of its own, so a frame recorded in one session is refused in every other one.
 *
 * The session knows neither the limb nor the wires. The tick calls it. Costs are instructions on a Cortex-M4F. */
#ifndef BRACE_SESSION_SESSION_H
#define BRACE_SESSION_SESSION_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/codes.h"
#include "brace/who.h"
#include "session/siphash.h"

enum {
    SESSION_LIFE_US = 130000, /* so long may the owner be silent while the limb moves; 100 ms, and a frame that is late */
    SESSION_IDLE_US = 1000000, /* and while nothing moves and nothing is configured */
    SESSION_CLOSED_US = 10000000 /* and in CONFIGURATION, which ends by itself then */
};

typedef struct {
    uint32_t strangers, replays, silences;
} session_counts_t;

typedef struct {
    brace_setting_t setting;
    uint8_t key[SIPHASH_KEY_BYTES];
    bool has_challenge;
    uint64_t challenge;     /* of the session that is open, else of the next one */
    bool is_open;           /* there is an owner */
    bool is_alive;          /* it has given a sign of life since it became the owner */
    brace_who_t owner;
    bool has_hung_up;       /* on a bench: its connection is closed, and another one may go on */
    uint32_t counter;       /* of the last sealed command or life sign */
    uint32_t silent_us;     /* since then */
    uint32_t life_us;       /* so long may the owner be silent while the limb moves: SESSION_LIFE_US, or the board's own */
    bool has_heard;         /* on a bench: a life sign of somebody who is not the owner */
    brace_who_t heard;
    uint32_t heard_us;      /* since then */
    session_counts_t counts;
} session_t;

/* What is checked with a seal. */
typedef enum { SESSION_LIFE = 1, SESSION_COMMAND = 2 } session_kind_t;

/* Begins without an owner.
 *   key: of SIPHASH_KEY_BYTES; null: there is none */
void session_start(session_t *session, bool is_bench, const uint8_t *key);

/* A board that is told so on its console becomes a bench, until its next start. */
void session_become_bench(session_t *session);

/* Gives the next session its challenge. random: never the same twice; it need not be secret. 400 instructions. */
void session_challenge(session_t *session, uint64_t random);

/* A sign of life; number 0 opens a session on a guarded board.
 * returns BRACE_OK, BRACE_REFUSED_NO_KEY, BRACE_REFUSED_STRANGER, BRACE_REFUSED_REPLAY, BRACE_REFUSED_OWNED: somebody
 *   else is the owner. At most 600 instructions. */
int32_t session_life(session_t *session, brace_who_t who, const brace_seal_t *seal);

/* May somebody command? On a bench it becomes the owner if there is none.
 *   seal: null on a bench, or where none has come
 *   bytes: of the command, `count` of them
 * returns as session_life. At most 600 instructions, and 20 for each byte beyond eight. */
int32_t session_command(session_t *session, brace_who_t who, const brace_seal_t *seal, const uint8_t *bytes,
                        uint32_t count);

/* Counts a refusal. returns the status */
int32_t session_refuse(session_t *session, int32_t status);

/* Is this the owner, or is there none? On a bench, for what is configured. */
bool session_is_free_for(const session_t *session, brace_who_t who);

/* One tick.
 *   since_us: since the tick before
 *   limit_us: how long the owner may be silent now
 * returns whether it has been silent for longer: the session has ended. 20 instructions. */
bool session_tick(session_t *session, uint32_t since_us, uint32_t limit_us);

/* The owner has gone: its port is closed, or what it began has ended. */
void session_end(session_t *session);

/* The owner's connection is closed. On a bench the next one of that port may go on for it. */
void session_hang_up(session_t *session);

/* May what the owner has begun move the limb? On a bench, only once a sign of life has come. */
static inline bool session_may_move(const session_t *session)
{
    return session->is_open && session->is_alive;
}

#endif
