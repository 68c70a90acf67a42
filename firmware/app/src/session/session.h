/* Who may move the limb and write to its controller? There is one owner at a time, and the owner gives signs of life.
 *
 * The controller has a number of 32 bits that changes every 26 ms, and sends it to whoever asks. A sign of life carries
 * this number back, and the controller takes a number only for a short time and only once. So a sign of life shows that
 * its sender has heard the controller lately: one that was held up on its way counts for nothing.
 *
 * A motion begins with a number of its own. The controller sends it in the answer to the command that asks for the
 * motion, and the owner's sign of life carries it back. Who has sent a command long ago, and lives, does not know that
 * number.
 *
 * On a bench, the master that asks for a motion first owns it. The session distinguishes masters by port and number.
 * On a guarded board, a master becomes the owner when its sign of life has a check under the key, over the session's
 * challenge and the controller's number. From then on every sign of life has such a check, and every command a counter
 * and a check over challenge, counter and command. Each session has a challenge of its own, so a frame recorded in one
 * session is refused in every other one.
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
    /* so long may the owner be silent while the limb moves; 100 ms, and a frame that is late */
    SESSION_LIFE_US = 130000,
    SESSION_IDLE_US = 1000000,      /* and while nothing moves and nothing is configured */
    SESSION_CLOSED_US = 10000000,   /* and in CONFIGURATION, which ends by itself then */
    SESSION_CHALLENGE_US = 2000000, /* a challenge without a session is renewed after this time */
    SESSION_SLOTS_PER_LIFE = 5,     /* so often the number changes while the owner may be silent */
    SESSION_NUMBERS = SESSION_SLOTS_PER_LIFE + 1 /* that are taken: each for life_us, and at most for a slot more */
};

typedef struct {
    uint32_t strangers, replays, silences;
} session_counts_t;

typedef struct {
    brace_setting_t setting;
    uint8_t key[SIPHASH_KEY_BYTES];
    bool has_challenge;
    uint64_t challenge;     /* of the session that is open, else of the next one */
    uint32_t challenge_us;  /* how old it is */
    bool is_open;           /* there is an owner */
    bool is_alive;          /* it has given a sign of life since it became the owner */
    brace_who_t owner;
    bool has_hung_up;       /* on a bench: its connection is closed, and another one may go on */
    uint32_t counter;       /* of the last sealed command */
    uint32_t silent_us;     /* since it or the last sign of life */
    /* so long may the owner be silent while the limb moves: SESSION_LIFE_US, or the board's own */
    uint32_t life_us;
    uint32_t seed;          /* on a bench: where its numbers begin */
    uint32_t slot;          /* how often the number has changed since start; the number of now is that of this slot */
    uint32_t slot_us;       /* since it has changed */
    uint32_t number[SESSION_NUMBERS]; /* each in the place of its slot */
    uint32_t counted;       /* this slot's number, and those before, have counted; slots below are none of ours */
    bool has_begin;         /* a motion waits for the sign of life with the number `begin` */
    bool has_begun;         /* that sign has come, and the motion is about to begin */
    bool is_begun;          /* it has come: once more it says nothing new */
    uint32_t begin;
    uint32_t begin_us;      /* how old that number is */
    uint32_t begins;        /* how many of them there have been */
    session_counts_t counts;
} session_t;

/* What is checked with a seal, and what a number is made from. */
typedef enum { SESSION_LIFE = 1, SESSION_COMMAND = 2, SESSION_NUMBER = 3 } session_kind_t;

/* Begins without an owner.
 *   key: of SIPHASH_KEY_BYTES; null: there is none
 *   seed: another one at each start where the board can; a bench's numbers follow from it. A bench has no forgers, only
 *     frames that come late, and a late frame does not know which number comes next */
void session_start(session_t *session, bool is_bench, const uint8_t *key, uint32_t seed);

/* A board becomes a bench when its console's user says so, until its next start. */
void session_become_bench(session_t *session);

/* Gives the next session its challenge. random: never the same twice; it need not be secret. 400 instructions. */
void session_challenge(session_t *session, uint64_t random);

/* The number of now. */
static inline uint32_t session_number(const session_t *session)
{
    return session->number[session->slot % (uint32_t)SESSION_NUMBERS];
}

/* A sign of life. The first one opens a session on a guarded board. On a bench a command does, and a sign of life of
 * somebody who is not the owner does nothing. Nor does one whose number has counted already.
 * returns BRACE_OK; BRACE_REFUSED_LATE: the number is too old; BRACE_REFUSED_NO_KEY;
 *   BRACE_REFUSED_STRANGER; BRACE_REFUSED_OWNED: somebody else is the owner. At most 700 instructions. */
int32_t session_life(session_t *session, brace_who_t who, const brace_sign_t *sign);

/* May somebody command? On a bench it becomes the owner if there is none.
 *   seal: null on a bench, or where none has come; those that follow it have the same counter, and one of them has to
 *     fit
 *   bytes: of the command, `count` of them
 * returns BRACE_OK, BRACE_REFUSED_NO_KEY, BRACE_REFUSED_STRANGER, BRACE_REFUSED_REPLAY, BRACE_REFUSED_OWNED. At most
 *   600 instructions, and 20 for each byte beyond eight. */
int32_t session_command(session_t *session, brace_who_t who, const brace_seal_t *seal, const uint8_t *bytes,
                        uint32_t count);

/* A motion waits for the owner's sign of life with a number of its own, session->begin. The one that has waited before
 * waits no longer. The number is good for life_us. 400 instructions. */
void session_await(session_t *session);

/* Counts a refusal. returns the status */
int32_t session_refuse(session_t *session, int32_t status);

/* Is this the owner, or is there none? On a bench, for what is configured. */
bool session_is_free_for(const session_t *session, brace_who_t who);

/* Time passes: numbers and challenge become older. To be called in every tick.
 *   since_us: since the tick before. At most 400 instructions in a tick in which the number changes, else 20. */
void session_pass(session_t *session, uint32_t since_us);

/* One tick in which the owner may be silent.
 *   since_us: since the tick before
 *   limit_us: how long the owner may be silent now
 * returns whether it has been silent for longer: the session has ended. 20 instructions. */
bool session_tick(session_t *session, uint32_t since_us, uint32_t limit_us);

/* The owner has gone: its port is closed, or what it began has ended. */
void session_end(session_t *session);

/* The owner's connection is closed. On a bench the next one of that port may go on for it. */
void session_hang_up(session_t *session);

/* May what the owner has begun move the limb? Only once a sign of life has come. */
static inline bool session_may_move(const session_t *session)
{
    return session->is_open && session->is_alive;
}

#endif
