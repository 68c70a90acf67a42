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
    const bool is_old = status == BRACE_REFUSED_REPLAY || status == BRACE_REFUSED_LATE;
    uint32_t *count = is_old ? &session->counts.replays : &session->counts.strangers;
    *count += *count < UINT32_MAX;
    return status;
}

/* ----------------------------------------------------------------------------------------- numbers -- */

static uint32_t mac_of(const session_t *session, uint32_t counter, session_kind_t kind, const uint8_t *bytes,
                       uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, session->key);
    siphash_word(&hash, session->challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | counter);
    return (uint32_t)siphash_end(&hash, bytes, count);
}

/* One word for each word, so that no number comes twice: the steps of MurmurHash3's finalizer, which is public
 * domain. */
static uint32_t mixed(uint32_t word)
{
    word = (word ^ word >> 16) * 0x85ebca6bu;
    word = (word ^ word >> 13) * 0xc2b2ae35u;
    return word ^ word >> 16;
}

/* A number that the controller sends. Without the key nobody can predict which one comes on a guarded board. */
static uint32_t drawn(const session_t *session, uint32_t place)
{
    return session->setting == BRACE_SETTING_GUARDED ? mac_of(session, place, SESSION_NUMBER, NULL, 0)
                                                     : mixed(session->seed + place);
}

static void change_number(session_t *session)
{
    session->slot++;
    session->number[session->slot % (uint32_t)SESSION_NUMBERS] = drawn(session, session->slot);
}

void session_await(session_t *session)
{
    session->begins++;
    /* Of the places that change_number comes to in 1.7 years. With both in it, no place comes twice in five days. */
    session->begin = drawn(session, 0x80000000u | (session->slot << 7 & 0x7fffff80u) | (session->begins & 0x7fu));
    session->has_begin = true;
    session->has_begun = session->is_begun = false;
    session->begin_us = 0;
}

void session_pass(session_t *session, uint32_t since_us)
{
    const uint32_t slot_us = session->life_us / (uint32_t)SESSION_SLOTS_PER_LIFE;
    const uint32_t most_us = slot_us * (uint32_t)SESSION_NUMBERS; /* after which no number of before is left */
    session->slot_us += since_us < most_us ? since_us : most_us;
    for (uint32_t i = 0; i <= (uint32_t)SESSION_NUMBERS && session->slot_us >= slot_us; i++) {
        session->slot_us -= slot_us;
        change_number(session);
    }
    session->begin_us += session->begin_us <= session->life_us ? since_us : 0u;
    const bool is_good = session->begin_us <= session->life_us;
    session->has_begin = session->has_begin && is_good;
    session->is_begun = session->is_begun && is_good;
    session->challenge_us += session->challenge_us < (uint32_t)SESSION_CHALLENGE_US ? since_us : 0u;
    if (!session->is_open && session->challenge_us >= (uint32_t)SESSION_CHALLENGE_US) {
        session->has_challenge = false;
    }
}

/* ----------------------------------------------------------------------------------- begin and end -- */

void session_start(session_t *session, bool is_bench, const uint8_t *key, uint32_t seed)
{
    const brace_setting_t guarded = key != NULL ? BRACE_SETTING_GUARDED : BRACE_SETTING_NO_KEY;
    *session =
        (session_t){.setting = is_bench ? BRACE_SETTING_BENCH : guarded, .life_us = SESSION_LIFE_US, .seed = seed};
    if (key != NULL) {
        memcpy(session->key, key, sizeof session->key);
    }
    for (uint32_t i = 0; i < (uint32_t)SESSION_NUMBERS; i++) {
        change_number(session);
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
    siphash_start(&hash, session->key); /* so nobody without the key can predict the next one */
    siphash_word(&hash, random);
    session->challenge = siphash_end(&hash, NULL, 0);
    session->has_challenge = true;
    session->challenge_us = 0;
}

void session_end(session_t *session)
{
    session->has_challenge = session->has_challenge && !session->is_open; /* each session has its own */
    session->is_open = session->is_alive = session->has_begin = session->has_begun = session->is_begun = false;
    session->counter = session->silent_us = 0;
}

static void open_for(session_t *session, brace_who_t who)
{
    session->is_open = true;
    session->owner = who;
    session->counted = session->slot - (uint32_t)SESSION_NUMBERS;
}

/* -------------------------------------------------------------------------------------------- seals -- */

/* The whole counter that low bits stand for: the next one above the last. returns false: it is not above the last */
static bool whole_counter(const session_t *session, const brace_seal_t *seal, uint32_t *counter)
{
    const uint32_t mask = UINT32_MAX >> (32u - seal->counter_bits);
    const uint32_t ahead = (seal->counter - session->counter) & mask;
    *counter = session->counter + ahead;
    return ahead != 0u && ahead <= mask / 2u && *counter > session->counter;
}

/* Is one of the seals the right one? Their counter is the same, so one check is worked out for all. */
static bool one_fits(const brace_seal_t *seal, uint32_t mac)
{
    bool fits = false;
    for (uint32_t i = 0; i < (uint32_t)BRACE_SEALS_MOST && seal != NULL; i++) {
        fits = fits || seal->mac == mac;
        seal = seal->next;
    }
    return fits;
}

static int32_t check(session_t *session, brace_who_t who, const brace_seal_t *seal, const uint8_t *bytes,
                     uint32_t count)
{
    uint32_t counter = 0;
    if (session->setting == BRACE_SETTING_NO_KEY) {
        return session_refuse(session, BRACE_REFUSED_NO_KEY);
    }
    if (seal == NULL || !seal->is_there || !session->is_open) {
        return session_refuse(session, session->is_open ? BRACE_REFUSED_OWNED : BRACE_REFUSED_STRANGER);
    }
    if (!is_same(who, session->owner)) {
        return session_refuse(session, BRACE_REFUSED_OWNED);
    }
    if (!whole_counter(session, seal, &counter)) {
        return session_refuse(session, BRACE_REFUSED_REPLAY);
    }
    if (!one_fits(seal, mac_of(session, counter, SESSION_COMMAND, bytes, count))) {
        return session_refuse(session, BRACE_REFUSED_STRANGER);
    }
    session->counter = counter;
    session->silent_us = 0;
    return BRACE_OK;
}

int32_t session_command(session_t *session, brace_who_t who, const brace_seal_t *seal, const uint8_t *bytes,
                        uint32_t count)
{
    if (session->setting != BRACE_SETTING_BENCH) {
        return check(session, who, seal, bytes, count);
    }
    if (!session_is_free_for(session, who)) {
        return session_refuse(session, BRACE_REFUSED_OWNED);
    }
    if (!session->is_open) {
        open_for(session, who);
    }
    session->owner = who;
    session->has_hung_up = false;
    return BRACE_OK;
}

/* ------------------------------------------------------------------------------------------ signs -- */

/* Finds the number that a sign of life carries back.
 *   slot (out): of that number; of the number that begins a motion, the one that has counted last
 * returns whether it is one of those that are good */
static bool is_heard(const session_t *session, const brace_sign_t *sign, uint32_t *number, uint32_t *slot)
{
    const uint32_t mask = UINT32_MAX >> (32u - sign->heard_bits);
    *slot = session->counted;
    *number = session->begin;
    bool is_found = (session->has_begin || session->is_begun) && (*number & mask) == sign->heard;
    for (uint32_t back = 0; back < (uint32_t)SESSION_NUMBERS && !is_found; back++) {
        *slot = session->slot - back;
        *number = session->number[*slot % (uint32_t)SESSION_NUMBERS];
        is_found = (*number & mask) == sign->heard;
    }
    return is_found;
}

/* A good number of the owner. returns whether it says something new */
static bool is_news(session_t *session, uint32_t number, uint32_t slot)
{
    if (session->has_begin && number == session->begin) {
        session->has_begin = false;
        session->has_begun = session->is_begun = true;
        return true;
    }
    const bool is_newer = (int32_t)(slot - session->counted) > 0;
    session->counted = is_newer ? slot : session->counted;
    return is_newer;
}

int32_t session_life(session_t *session, brace_who_t who, const brace_sign_t *sign)
{
    const bool is_bench = session->setting == BRACE_SETTING_BENCH;
    uint32_t number, slot;
    if (session->setting == BRACE_SETTING_NO_KEY) {
        return session_refuse(session, BRACE_REFUSED_NO_KEY);
    }
    if (!session_is_free_for(session, who)) {
        return session_refuse(session, BRACE_REFUSED_OWNED);
    }
    if (!is_heard(session, sign, &number, &slot)) {
        return session_refuse(session, BRACE_REFUSED_LATE);
    }
    if (!is_bench && (!session->has_challenge || sign->check != mac_of(session, number, SESSION_LIFE, NULL, 0))) {
        return session_refuse(session, BRACE_REFUSED_STRANGER);
    }
    if (!session->is_open) {
        if (is_bench) {
            return BRACE_OK;
        }
        open_for(session, who);
    }
    session->owner = who;
    session->has_hung_up = false;
    if (is_news(session, number, slot)) {
        session->silent_us = 0;
        session->is_alive = true;
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
    if (!session->is_open) {
        return false;
    }
    session->silent_us += since_us;
    if (session->silent_us <= limit_us) {
        return false;
    }
    session_end(session);
    return true;
}
