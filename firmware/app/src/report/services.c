#include "report/services.h"

#include "can/bus.h"
#include "can/cyclic.h"
#include "can/requests.h"
#include "modbus/modbus.h"
#include "report/announce.h"

#define PATIENCE_TICKS 20u

void services_start(brace_app_t *app)
{
    app->report = (brace_app_report_t){0};
    bus_start(app);
    requests_start(app);
    cyclic_configure(app);
    modbus_start(app);
}

/* Is there room beside K? A limb on the general path fills its tick: what there is to say waits for a lean
 * one. */
static bool is_roomy(const brace_app_t *app)
{
    return app->model.collapsed || app->mode == BRACE_MODE_CONFIGURATION;
}

/* Which bus answers in this tick? CAN first, since its answers are due within a tick; Modbus, whose own line
 * takes milliseconds, before it has waited for long. */
static void choose(brace_app_t *app, bool may, bool in_brief)
{
    const uint32_t waited = app->modbus.waited; /* since an earlier tick: then CAN is looked through in brief */
    app->requests.serves = requests_take(app, may && waited <= PATIENCE_TICKS, in_brief || waited > 0u);
    app->modbus.serves = !app->requests.serves && waited > 0u && may;
    if (!app->requests.serves && !app->modbus.serves) {
        (void)modbus_poll(app, app->last_us);
    }
}

static bool wants_to_say(const brace_app_t *app)
{
    return announce_wants(app) || cyclic_wants(app);
}

/* A tick that answers says nothing else. Where only lean ticks speak, answers and the rest take turns. */
bool services_listen(brace_app_t *app, bool may_be_lean)
{
    const bool may = may_be_lean && app->requests.rested;
    const bool roomy = is_roomy(app);
    const bool moves = app->mode == BRACE_MODE_TAKING_UP || app->mode == BRACE_MODE_LOADING_TEST;
    const bool listens = !(roomy && moves) || (brace_app_snapshot(app)->sequence & 1u) != 0u; /* else it speaks */
    app->requests.serves = app->modbus.serves = false;
    app->report.speaks = !(roomy && moves && listens);
    app->report.runs = may || (may_be_lean && roomy);
    if (!app->report.runs) {
        app->requests.rested = true;
        return false;
    }
    const bool says = !roomy && wants_to_say(app);
    if (listens) {
        choose(app, may && !(says && app->report.owed), moves);
    }
    const bool serves = app->requests.serves || app->modbus.serves;
    const bool listened = !roomy && (moves || app->requests.looked > 1u || app->modbus.waited > 0u);
    const bool lean = serves || says || listened;
    app->report.owed = serves && says;
    app->requests.rested = !lean;
    return lean;
}

void services_run(brace_app_t *app, bool lean)
{
    bus_watch(app);
    if (!app->report.runs || !(lean || is_roomy(app))) {
        return;
    }
    if (app->modbus.serves) {
        modbus_serve(app, app->last_us);
    } else if (app->requests.serves) {
        requests_serve(app);
    }
    requests_send(app);
    if (app->requests.serves || app->modbus.serves || !app->report.speaks) {
        return;
    }
    if (app->cyclic.parameter_crc != app->parameter_crc) {
        cyclic_configure(app);
    } else if (!announce(app) && bus_speaks(app)) {
        cyclic_send(app);
    }
}
