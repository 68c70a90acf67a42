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

/* CAN first, since its answers are due within a tick; Modbus, whose own line takes milliseconds, before it has waited
 * for long. */
bool services_listen(brace_app_t *app, bool may_serve)
{
    const uint32_t waited = modbus_poll(app, app->last_us);
    const bool may = may_serve && app->requests.rested;
    app->modbus.serves = may && waited > PATIENCE_TICKS;
    const bool can = requests_take(app, may && !app->modbus.serves);
    app->modbus.serves = app->modbus.serves || (may && !can && waited > 0u);
    app->requests.rested = !can && !app->modbus.serves;
    return !app->requests.rested;
}

void services_run(brace_app_t *app, bool serves)
{
    bus_watch(app);
    if (app->modbus.serves) {
        modbus_serve(app, app->last_us);
    } else if (serves) {
        requests_serve(app);
    }
    requests_send(app);
    if (app->cyclic.parameter_crc != app->parameter_crc) {
        cyclic_configure(app);
    } else if (!announce(app) && bus_speaks(app)) {
        cyclic_send(app);
    }
}
