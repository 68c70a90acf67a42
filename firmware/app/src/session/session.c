#include "session/session.h"

#include <stddef.h>
#include <string.h>

#include "brace/refusals.h"
#include "brace/status.h"

static bool is_same(brace_who_t one, brace_who_t other)
{
    return one.port == other.port && one.master == other.master;
}

int32_t session_refuse(session_t *session, int32_t status)
{
    uint32_t *count = status == BRACE_REFUSED_REPLAY ? &session->counts.replays : &session->counts.strangers;
    *count += *count < UINT32_MAX;
    return status;
}

void session_start(session_t *session, bool is_bench, const uint8_t *key)
{
    const brace_setting_t guarded = key != NULL ? BRACE_SETTING_GUARDED : BRACE_SETTING_NO_KEY;
    *session = (session_t){.setting = is_bench ? BRACE_SETTING_BENCH : guarded, .life_us = SESSION_LIFE_US};
    if (key != NULL) {
        memcpy(session->key, key, sizeof session->key);
    }
}

void session_become_bench(session_t *session)
{
    session_end(session);
    session->setting = BRACE_SETTING_BENCH;
    session->has_challenge = false;
}

void session_challenge(session_t *session, uint64_t random)
{
    siphash_t hash;
    siphash_start(&hash, session->key); /* so nobody without the key can tell the next one in advance */
    siphash_word(&hash, random);
    session->challenge = siphash_end(&hash, NULL, 0);
    session->has_challenge = true;
}

void session_end(session_t *session)
{
    session->has_challenge = session->has_challenge && !session->is_open; /* each session has its own */
    session->is_open = session->is_alive = session->has_heard = false;
    session->counter = session->silent_us = 0;
}

static void open_for(session_t *session, brace_who_t who)
{
    session->is_open = true;
    session->owner = who;
}

/* -------------------------------------------------------------------------------------------- seals -- */

static uint32_t mac_of(const session_t *session, uint32_t counter, session_kind_t kind, const uint8_t *bytes,
                       uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, session->key);
    siphash_word(&hash, session->challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | counter);
    return (uint32_t)siphash_end(&hash, bytes, count);
}

/* The whole counter that low bits stand for: the next one above the last. returns false: it is not above the last */
static bool whole_counter(const session_t *session, const brace_seal_t *seal, uint32_t *counter)
{
    const uint32_t mask = UINT32_MAX >> (32u - seal->counter_bits);
    const uint32_t ahead = (seal->counter - session->counter) & mask;
    *counter = session->counter + ahead;
    return ahead != 0u && ahead <= mask / 2u && *counter > session->counter;
}

static int32_t check(session_t *session, brace_who_t who, const brace_seal_t *seal, session_kind_t kind,
                     const uint8_t *bytes, uint32_t count)
{
    uint32_t counter = 0;
    if (session->setting == BRACE_SETTING_NO_KEY) {
        return session_refuse(session, BRACE_REFUSED_NO_KEY);
    }
    if (seal == NULL || !seal->is_there || !session->has_challenge) {
        return session_refuse(session, session->is_open ? BRACE_REFUSED_OWNED : BRACE_REFUSED_STRANGER);
    }
    const bool opens = kind == SESSION_LIFE && seal->counter == 0u && !session->is_open;
    if (!opens && !session->is_open) {
        return session_refuse(session, BRACE_REFUSED_STRANGER);
    }
    if (!opens && !whole_counter(session, seal, &counter)) {
        return session_refuse(session, is_same(who, session->owner) ? BRACE_REFUSED_REPLAY : BRACE_REFUSED_OWNED);
    }
    if (seal->mac != mac_of(session, counter, kind, bytes, count)) {
        return session_refuse(session, is_same(who, session->owner) || opens ? BRACE_REFUSED_STRANGER : BRACE_REFUSED_OWNED);
    }
    if (opens) {
        open_for(session, who);
    } else if (!is_same(who, session->owner)) {
        return session_refuse(session, BRACE_REFUSED_OWNED);
    }
    session->counter = counter;
    session->silent_us = 0;
    session->is_alive = true;
    return BRACE_OK;
}

/* ------------------------------------------------------------------------------------------ signs -- */

int32_t session_life(session_t *session, brace_who_t who, const brace_seal_t *seal)
{
    if (session->setting != BRACE_SETTING_BENCH) {
        return check(session, who, seal, SESSION_LIFE, NULL, 0);
    }
    if (!session->is_open) {
        session->has_heard = true;
        session->heard = who;
        session->heard_us = 0;
        return BRACE_OK;
    }
    if (!session_is_free_for(session, who)) {
        return session_refuse(session, BRACE_REFUSED_OWNED);
    }
    session->owner = who;
    session->has_hung_up = false;
    session->silent_us = 0;
    session->is_alive = true;
    return BRACE_OK;
}

int32_t session_command(session_t *session, brace_who_t who, const brace_seal_t *seal, const uint8_t *bytes,
                        uint32_t count)
{
    if (session->setting != BRACE_SETTING_BENCH) {
        return check(session, who, seal, SESSION_COMMAND, bytes, count);
    }
    if (!session_is_free_for(session, who)) {
        return session_refuse(session, BRACE_REFUSED_OWNED);
    }
    session->owner = who;
    session->has_hung_up = false;
    if (!session->is_open) {
        open_for(session, who);
        session->is_alive = session->has_heard && is_same(who, session->heard);
        session->silent_us = session->is_alive ? session->heard_us : 0u;
    }
    return BRACE_OK;
}

bool session_is_free_for(const session_t *session, brace_who_t who)
{
    const bool goes_on = session->has_hung_up && session->owner.port == who.port;
    return !session->is_open || is_same(who, session->owner) || goes_on;
}

void session_hang_up(session_t *session)
{
    if (session->setting == BRACE_SETTING_BENCH) {
        session->has_hung_up = true;
    } else {
        session_end(session);
    }
}

bool session_tick(session_t *session, uint32_t since_us, uint32_t limit_us)
{
    session->heard_us += since_us;
    session->has_heard = session->has_heard && session->heard_us <= session->life_us;
    if (!session->is_open) {
        return false;
    }
    session->silent_us += since_us;
    if (session->silent_us <= limit_us) {
        return false;
    }
    const uint32_t silent_us = session->silent_us;
    const bool lives_on = session->is_alive && silent_us <= session->life_us;
    session_end(session);
    session->has_heard = lives_on && session->setting == BRACE_SETTING_BENCH; /* it may begin something else */
    session->heard = session->owner;
    session->heard_us = silent_us;
    return true;
}
