#include "brace/app.h"

brace_status_t brace_app_start(brace_app_t *app, const brace_hal_t *hal)
{
    if (app == NULL || hal == NULL) {
        return BRACE_E_NULL;
    }
    *app = (brace_app_t){.hal = hal};
    return BRACE_OK;
}

void brace_app_tick(brace_app_t *app, uint32_t now_us)
{
    app->last_us = now_us;
    app->hal->watchdog_feed(app->hal->context);
}

const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app)
{
    return &app->snapshot[app->newest];
}
