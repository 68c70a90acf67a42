/* Who may move the limb and write: one event, or one tick, from any sound state to one again. The check under the key
 * is replaced by one number that nobody can foresee; what it is made over is watched. */
#include "brace/refusals.h"
#include "brace/status.h"
#include "proof.h"
#include "session/ownership.h"
#include "session/siphash.h"

/* ------------------------------------------------------------------------------ the check, by stand-ins -- */

static uint64_t mac, hashed[2];
static uint32_t hashed_count;

void siphash_start(siphash_t *hash, const uint8_t key[SIPHASH_KEY_BYTES])
{
    (void)hash, (void)key;
    hashed_count = 0;
}

void siphash_word(siphash_t *hash, uint64_t word)
{
    (void)hash;
    if (hashed_count < 2u) {
        hashed[hashed_count] = word;
    }
    hashed_count++;
}

uint64_t siphash_end(siphash_t *hash, const uint8_t *bytes, uint32_t count)
{
    (void)hash, (void)bytes, (void)count;
    return mac;
}

/* ---------------------------------------------------------------------------------------- sound states -- */

static bool is_same_master(brace_who_t one, brace_who_t other)
{
    return one.port == other.port && one.master == other.master;
}

static bool is_guarded(const session_t *s)
{
    return s->setting == BRACE_SETTING_GUARDED;
}

static bool is_sound(const ownership_t *o)
{
    const session_t *s = &o->session;
    const bool is_bench = s->setting == BRACE_SETTING_BENCH;
    return (is_bench || is_guarded(s) || s->setting == BRACE_SETTING_NO_KEY) &&
           (s->setting != BRACE_SETTING_NO_KEY || (!s->is_open && !s->has_challenge)) &&
           (!is_guarded(s) || !s->is_open || (s->is_alive && s->has_challenge)) && (is_bench || !s->has_hung_up) &&
           (s->is_open || !(s->is_alive || s->has_begin || s->has_begun || s->is_begun)) &&
           (!s->has_begun || s->is_alive) && s->silent_us <= SESSION_CLOSED_US && s->life_us >= SESSION_LIFE_US &&
           s->life_us <= SESSION_IDLE_US && s->slot_us < s->life_us / (uint32_t)SESSION_SLOTS_PER_LIFE;
}

/* C lets a bool's byte hold 0 and 1 only. */
static void any_state(ownership_t *o)
{
    session_t *const s = &o->session;
    bool *const flags[] = {&s->has_challenge, &s->is_open,    &s->is_alive,      &s->has_hung_up, &s->has_begin,
                           &s->has_begun,     &s->is_begun,   &o->program_moves, &o->is_held,     &o->waits,
                           &o->fell_silent,   &o->is_by_wire, &o->has_configurer};
    ANY(*o);
    for (uint32_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        *flags[i] = any_bool();
    }
    ASSUME(is_sound(o));
}

/* Nothing that an owner has not asked for moves the limb. */
static bool may_move(const ownership_t *o)
{
    return o->program_moves || session_may_move(&o->session);
}

/* -------------------------------------------------------------------------------------------- events -- */

static void is_refused(const session_t *s, const session_t *was)
{
    PROVE(s->is_open == was->is_open && s->counter == was->counter && s->silent_us == was->silent_us &&
              s->counted == was->counted && s->has_begun == was->has_begun,
          "what is refused neither opens a session nor prolongs one, nor begins a motion");
    PROVE(s->counts.strangers != was->counts.strangers || s->counts.replays != was->counts.replays ||
              was->counts.strangers == UINT32_MAX || was->counts.replays == UINT32_MAX,
          "a refusal is counted");
}

/* Is it one of the numbers that a sign of life may carry, and the one that this sign carries? */
static bool is_good(const session_t *s, uint32_t number, const brace_sign_t *sign)
{
    bool is_one = (s->has_begin || s->is_begun) && number == s->begin;
    for (uint32_t i = 0; i < (uint32_t)SESSION_NUMBERS; i++) {
        is_one = is_one || number == s->number[i];
    }
    return is_one && (number & UINT32_MAX >> (32u - sign->heard_bits)) == sign->heard;
}

static void live(ownership_t *o, const ownership_t *before)
{
    const brace_who_t who = {(brace_asker_t)any_u8(), any_u32()};
    const brace_sign_t sign = {any_u32(), any_bool() ? 16u : 32u, any_u32()};
    const int32_t status = session_life(&o->session, who, &sign);
    const session_t *s = &o->session, *was = &before->session;
    if (s->setting == BRACE_SETTING_NO_KEY) {
        PROVE(status == BRACE_REFUSED_NO_KEY, "without a key nobody is let in");
    }
    if (status != BRACE_OK) {
        is_refused(s, was);
        return;
    }
    if (is_guarded(s)) {
        PROVE(sign.check == (uint32_t)mac, "only with the right check");
        PROVE(hashed_count == 2u && hashed[0] == was->challenge, "made over this session's challenge");
        PROVE(hashed[1] >> 32 == SESSION_LIFE && is_good(was, (uint32_t)hashed[1], &sign),
              "over the kind and a whole number that is good");
        PROVE(s->is_open && is_same_master(s->owner, who), "and by the owner alone");
    }
    const bool has_begun = was->has_begin && !s->has_begin && s->has_begun;
    PROVE(s->silent_us == was->silent_us || !was->is_open || has_begun || (int32_t)(s->counted - was->counted) > 0,
          "a number counts once");
    PROVE(s->has_begun == was->has_begun || has_begun, "a motion begins with its own number");
}

static void command(ownership_t *o, const ownership_t *before)
{
    const brace_who_t who = {(brace_asker_t)any_u8(), any_u32()};
    const brace_seal_t last = {any_bool(), any_u32(), any_u32(), any_u32(), NULL};
    const brace_seal_t seal = {any_bool(), any_u32(), any_u32(), any_u32(), any_bool() ? &last : NULL};
    const brace_seal_t *const given = any_bool() ? &seal : NULL;
    const uint8_t bytes[8] = {0};
    ASSUME(seal.counter_bits >= 8u && seal.counter_bits <= 32u);
    ASSUME(seal.counter_bits == 32u || seal.counter >> seal.counter_bits == 0u);
    const int32_t status = session_command(&o->session, who, given, bytes, sizeof bytes);
    const session_t *s = &o->session, *was = &before->session;
    if (s->setting == BRACE_SETTING_NO_KEY) {
        PROVE(status == BRACE_REFUSED_NO_KEY, "without a key nobody is let in");
    }
    if (status != BRACE_OK) {
        is_refused(s, was);
        return;
    }
    if (is_guarded(s)) {
        PROVE(given != NULL && seal.is_there &&
                  (seal.mac == (uint32_t)mac || (seal.next != NULL && last.mac == (uint32_t)mac)),
              "only with the right check");
        PROVE(hashed_count == 2u && hashed[0] == was->challenge, "made over this session's challenge");
        PROVE(hashed[1] == ((uint64_t)SESSION_COMMAND << 32 | s->counter), "over the kind and the whole counter");
        PROVE(was->is_open && s->counter > was->counter, "a counter comes once, in a session that is open");
        PROVE(is_same_master(s->owner, who), "and by the owner alone");
    }
    ownership_wait(o);
    PROVE(o->waits && s->has_begin && !s->has_begun, "what is let in waits for its sign of life");
    PROVE(o->is_held == before->is_held && may_move(o) == may_move(before), "and changes nothing of what moves");
}

static void pass(ownership_t *o, const ownership_t *before)
{
    const uint32_t since_us = any_u32();
    ASSUME(since_us <= UINT32_MAX / 2u);
    session_pass(&o->session, since_us);
    const session_t *s = &o->session, *was = &before->session;
    const uint32_t slot_us = s->life_us / (uint32_t)SESSION_SLOTS_PER_LIFE;
    PROVE(since_us < slot_us * (uint32_t)SESSION_NUMBERS || s->slot - was->slot >= (uint32_t)SESSION_NUMBERS,
          "no number is left for longer than life_us and a slot");
    PROVE(!(s->has_begin || s->is_begun) || (was->begin_us <= s->life_us && since_us <= s->life_us - was->begin_us),
          "nor that of a motion for longer than life_us");
    PROVE(s->is_open || !s->has_challenge || was->challenge_us + (uint64_t)since_us < SESSION_CHALLENGE_US,
          "a challenge that nobody answers goes");
    PROVE(s->is_open == was->is_open && s->is_alive == was->is_alive && s->has_begun == was->has_begun,
          "time alone opens and begins nothing");
}

static void tick(ownership_t *o, const ownership_t *before)
{
    const ownership_inputs_t inputs = {any_bool(), any_bool(), any_bool(), any_bool(), any_u32(), any_u32()};
    ASSUME(inputs.since_us <= UINT32_MAX / 2u);
    ASSUME(!inputs.moves || inputs.runs);
    const ownership_step_t step = ownership_step(o, &inputs);
    const session_t *s = &o->session, *was = &before->session;
    PROVE(!inputs.runs || o->is_held || may_move(o), "no motion without an owner");
    PROVE(step != OWNERSHIP_STOPS || o->is_held, "what is stopped stands");
    PROVE(!before->is_held || !inputs.runs || o->is_held, "and goes on standing");
    PROVE(step != OWNERSHIP_LETS_GO || (inputs.let_go_after_us != 0u && o->is_held && o->fell_silent),
          "it lets go only where it was asked to, after its owner has fallen silent");
    PROVE(was->is_open || !s->is_open, "no session begins by itself");
    if (s->is_open) {
        const uint32_t most_us = inputs.moves ? s->life_us : (uint32_t)SESSION_CLOSED_US;
        PROVE(s->silent_us == was->silent_us + (inputs.stores ? 0u : inputs.since_us), "silence adds up");
        PROVE(s->silent_us <= most_us, "and ends the session: it always ends");
    }
    if (step == OWNERSHIP_BEGINS) {
        PROVE(before->waits && was->has_begun, "a motion begins after its sign of life");
        o->is_by_wire = true;
        ownership_begin(o);
        PROVE(may_move(o) && !o->waits, "with its owner");
    }
}

static void stop(ownership_t *o)
{
    const bool runs = any_bool();
    ownership_stop(o, runs);
    PROVE(o->is_held || !runs, "stop is anybody's, and the limb stands");
    PROVE(!o->waits && !o->session.has_begin && !o->session.has_begun, "and nothing waits to begin");
}

static void begin_by_program(ownership_t *o)
{
    o->is_by_wire = false;
    ownership_begin(o);
    PROVE(!o->session.is_open && !o->waits, "what the program around the controller begins has no other owner");
}

int main(void)
{
    ownership_t o;
    any_state(&o);
    mac = any_u64();
    const ownership_t before = o;
    switch (any_u8() % 8u) {
    case 0: live(&o, &before); break;
    case 1: command(&o, &before); break;
    case 2: tick(&o, &before); break;
    case 3:
        ASSUME(is_guarded(&o.session) && !o.session.is_open); /* app.c asks for a challenge only then */
        session_challenge(&o.session, any_u64());
        break;
    case 4:
        session_hang_up(&o.session);
        PROVE(!is_guarded(&o.session) || !o.session.is_open, "who hangs up is the owner no longer");
        break;
    case 5: stop(&o); break;
    case 6: pass(&o, &before); break;
    default: begin_by_program(&o); break;
    }
    PROVE(is_sound(&o), "a sound state again");
    PROVE(o.session.setting == before.session.setting, "the setting stays");
    if (is_guarded(&o.session) && before.session.is_open && o.session.is_open) {
        PROVE(is_same_master(o.session.owner, before.session.owner), "never a second owner");
    }
    return 0;
}
