#include "session/ownership.h"

#include "brace/refusals.h"
#include "brace/status.h"

/* How long the owner may be silent now. */
static uint32_t patience_us(const ownership_t *ownership, const ownership_inputs_t *inputs)
{
    const bool is_bench = ownership->session.setting == BRACE_SETTING_BENCH;
    if (inputs->moves || ((inputs->runs || ownership->waits) && is_bench)) {
        return ownership->session.life_us;
    }
    if (is_bench) {
        return 0; /* what it began has ended */
    }
    return inputs->configures ? SESSION_CLOSED_US : SESSION_IDLE_US;
}

static void hold(ownership_t *ownership, bool fell_silent)
{
    ownership->is_held = true;
    ownership->fell_silent = fell_silent;
    ownership->held_us = 0;
}

/* What waits for its sign of life. returns whether that has come */
static bool has_begun(ownership_t *ownership)
{
    session_t *session = &ownership->session;
    const bool has_come = session->has_begun;
    session->has_begun = false;
    ownership->waits = session->has_begin;
    session->counts.silences += !has_come && !session->has_begin && session->counts.silences < UINT32_MAX;
    return has_come;
}

/* What moves the limb, or is held. */
static ownership_step_t run(ownership_t *ownership, const ownership_inputs_t *inputs)
{
    session_t *session = &ownership->session;
    if (!ownership->is_held && !ownership->program_moves && !session_may_move(session)) {
        hold(ownership, true);
        session->counts.silences += inputs->moves && session->counts.silences < UINT32_MAX;
        return inputs->moves ? OWNERSHIP_STOPS : OWNERSHIP_GOES_ON; /* what is held already is held on */
    }
    ownership->held_us += ownership->is_held && ownership->held_us < UINT32_MAX / 2u ? inputs->since_us : 0u;
    const bool lets_go = ownership->is_held && ownership->fell_silent && inputs->let_go_after_us != 0u &&
                         ownership->held_us >= inputs->let_go_after_us;
    return lets_go ? OWNERSHIP_LETS_GO : OWNERSHIP_GOES_ON;
}

ownership_step_t ownership_step(ownership_t *ownership, const ownership_inputs_t *inputs)
{
    (void)session_tick(&ownership->session, inputs->stores ? 0u : inputs->since_us, patience_us(ownership, inputs));
    ownership->has_configurer = ownership->has_configurer && inputs->configures;
    if (ownership->waits && has_begun(ownership)) {
        return OWNERSHIP_BEGINS;
    }
    if (!inputs->runs) {
        ownership->is_held = ownership->program_moves = ownership->fell_silent = false;
        return OWNERSHIP_GOES_ON;
    }
    return run(ownership, inputs);
}

void ownership_wait(ownership_t *ownership)
{
    session_await(&ownership->session);
    ownership->waits = true;
}

void ownership_begin(ownership_t *ownership)
{
    if (!ownership->is_by_wire) {
        session_end(&ownership->session);
    }
    ownership->program_moves = !ownership->is_by_wire;
    ownership->is_held = ownership->waits = ownership->fell_silent = false;
}

void ownership_stop(ownership_t *ownership, bool runs)
{
    session_t *session = &ownership->session;
    ownership->waits = session->has_begin = session->has_begun = session->is_begun = false;
    if (runs) {
        hold(ownership, false);
    }
}

int32_t ownership_may_write(ownership_t *ownership, brace_who_t who, bool has_gone)
{
    const brace_who_t has = ownership->configurer;
    const bool is_other = ownership->has_configurer && (has.port != who.port || has.master != who.master);
    if (is_other && !(has_gone && has.port == who.port)) {
        ownership->session.counts.strangers += ownership->session.counts.strangers < UINT32_MAX;
        return BRACE_REFUSED_OWNED;
    }
    ownership->configurer = who;
    ownership->has_configurer = true;
    return BRACE_OK;
}
