#include "session/ownership.h"

#include "brace/refusals.h"
#include "brace/status.h"

/* How long the owner may be silent now. */
static uint32_t patience_us(const ownership_t *ownership, const ownership_inputs_t *inputs)
{
    const bool is_bench = ownership->session.setting == BRACE_SETTING_BENCH;
    if (inputs->moves || (inputs->runs && is_bench)) {
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

static void rest(ownership_t *ownership)
{
    ownership->is_held = ownership->waits_for_life = ownership->program_moves = ownership->fell_silent = false;
}

/* What waits for a sign of life. */
static ownership_step_t wait(ownership_t *ownership)
{
    if (session_may_move(&ownership->session)) {
        ownership->is_held = ownership->waits_for_life = ownership->fell_silent = false;
    } else if (!ownership->session.is_open) {
        ownership->waits_for_life = false;
        ownership->is_held = ownership->was_held;
        ownership->session.counts.silences += ownership->session.counts.silences < UINT32_MAX;
        return OWNERSHIP_FORGETS;
    }
    return OWNERSHIP_GOES_ON;
}

ownership_step_t ownership_step(ownership_t *ownership, const ownership_inputs_t *inputs)
{
    session_t *session = &ownership->session;
    (void)session_tick(session, inputs->stores ? 0u : inputs->since_us, patience_us(ownership, inputs));
    ownership->has_configurer = ownership->has_configurer && inputs->configures;
    if (!inputs->runs) {
        rest(ownership);
        return OWNERSHIP_GOES_ON;
    }
    if (ownership->waits_for_life) {
        return wait(ownership);
    }
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

void ownership_begin(ownership_t *ownership)
{
    if (!ownership->is_by_wire) {
        session_end(&ownership->session);
        rest(ownership);
        ownership->program_moves = true;
        return;
    }
    ownership->program_moves = false;
    if (session_may_move(&ownership->session)) {
        ownership->is_held = ownership->waits_for_life = ownership->fell_silent = false;
        return;
    }
    ownership->was_held = ownership->waits_for_life ? ownership->was_held : ownership->is_held;
    ownership->is_held = ownership->waits_for_life = true;
}

bool ownership_stop(ownership_t *ownership)
{
    const bool waited = ownership->waits_for_life;
    ownership->waits_for_life = false;
    hold(ownership, false);
    return waited;
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
