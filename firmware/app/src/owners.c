/* Who may move the limb and write: the answers to what brace/requests.h lets anybody ask about it. */
#include <stddef.h>

#include "brace/refusals.h"
#include "brace/requests.h"
#include "controller.h"

void brace_app_session(const brace_app_t *app, brace_session_report_t *report)
{
    const controller_t *controller = controller_in(app);
    const ownership_t *ownership = &controller->ownership;
    const session_t *session = &ownership->session;
    const brace_owner_t program = ownership->program_moves ? BRACE_OWNER_PROGRAM : BRACE_OWNER_NONE;
    report->setting = session->setting;
    report->owner = session->is_open ? (brace_owner_t)(session->owner.port + 1) : program;
    report->is_held = ownership->is_held;
    report->number = session_number(session);
    report->has_begin = session->has_begin;
    report->begin = session->begin;
    report->has_challenge = session->has_challenge;
    report->challenge = session->challenge;
    report->strangers = session->counts.strangers;
    report->replays = session->counts.replays;
    report->silences = session->counts.silences;
    report->commits_refused = controller->parameters.commits_refused;
    report->erases = controller->parameters.store.erases;
    report->last_refusal = ownership->last_refusal;
}

brace_setting_t brace_app_setting(const brace_app_t *app)
{
    return controller_in(app)->ownership.session.setting;
}

static int32_t note_refusal(controller_t *controller, int32_t status)
{
    if (status != BRACE_OK) {
        controller->ownership.last_refusal = status;
    }
    return status;
}

/* On a guarded board the token of a CAN request is a counter, and the session identifies the master. */
static brace_who_t master_of(const controller_t *controller, brace_who_t who)
{
    const bool is_can = who.port == BRACE_ASKER_CAN || who.port == BRACE_ASKER_SLCAN;
    const bool is_bench = controller->ownership.session.setting == BRACE_SETTING_BENCH;
    return is_can && !is_bench ? (brace_who_t){who.port, 0} : who;
}

int32_t brace_app_life(brace_app_t *app, brace_who_t who, const brace_sign_t *sign)
{
    controller_t *controller = controller_of(app);
    return note_refusal(controller, session_life(&controller->ownership.session, master_of(controller, who), sign));
}

/* Has that master hung up? By hand, on a bench, each thing that is written has a connection of its own. */
bool controller_has_hung_up(const controller_t *controller, brace_who_t who)
{
    const brace_hal_t *hal = controller->hal;
    return who.port == BRACE_ASKER_MODBUS_TCP && hal->serial_peer_is_open != NULL &&
           !hal->serial_peer_is_open(hal->context, BRACE_SERIAL_MODBUS_TCP, who.master);
}

int32_t brace_app_may_command(brace_app_t *app, brace_command_t command, brace_who_t who, const brace_seal_t *seal,
                              const uint8_t *bytes, uint32_t count)
{
    controller_t *controller = controller_of(app);
    ownership_t *ownership = &controller->ownership;
    const bool is_bench = ownership->session.setting == BRACE_SETTING_BENCH;
    if (command == BRACE_COMMAND_NONE || (is_bench && command == BRACE_COMMAND_INFORMS)) {
        return BRACE_OK;
    }
    if (is_bench && command == BRACE_COMMAND_WRITES) {
        /* Programs number their requests over CAN as they like: there the port is the master. */
        const brace_who_t writer = {who.port, who.port == BRACE_ASKER_MODBUS_TCP ? who.master : 0u};
        const bool has_hung_up = controller_has_hung_up(controller, ownership->configurer);
        return note_refusal(controller, ownership_may_write(ownership, writer, has_hung_up));
    }
    if (command == BRACE_COMMAND_MOVES && ownership->program_moves) {
        return note_refusal(controller, session_refuse(&ownership->session, BRACE_REFUSED_OWNED));
    }
    const brace_who_t master = master_of(controller, who);
    return note_refusal(controller, session_command(&ownership->session, master, seal, bytes, count));
}

void brace_app_gone(brace_app_t *app, brace_asker_t port)
{
    session_t *session = &controller_of(app)->ownership.session;
    if (session->is_open && session->owner.port == port) {
        session_end(session);
    }
}

void brace_app_become_bench(brace_app_t *app)
{
    session_become_bench(&controller_of(app)->ownership.session);
}

bool brace_app_moves(const brace_app_t *app)
{
    const controller_t *controller = controller_in(app);
    return controller_takes_up(controller) || loading_runs(&controller->loading);
}
