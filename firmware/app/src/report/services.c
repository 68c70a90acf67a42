#include "report/services.h"

#include "can/bus.h"
#include "can/cyclic.h"
#include "can/requests.h"
#include "report/announce.h"

void services_start(brace_app_t *app)
{
    app->report = (brace_app_report_t){0};
    bus_start(app);
    requests_start(app);
    cyclic_configure(app);
}

bool services_listen(brace_app_t *app, bool may_serve)
{
    return requests_take(app, may_serve);
}

void services_run(brace_app_t *app, bool serves)
{
    bus_watch(app);
    if (serves) {
        requests_serve(app);
    }
    requests_send(app);
    if (app->cyclic.parameter_crc != app->parameter_crc) {
        cyclic_configure(app);
    } else if (!announce(app) && bus_speaks(app)) {
        cyclic_send(app);
    }
}
