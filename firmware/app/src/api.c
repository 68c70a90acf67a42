/* The requests of brace/app.h: pointers are checked here, everything else by requests.c. */
#include <stddef.h>

#include "brace/app.h"
#include "brace/app_memory.h"

const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app)
{
    return request_snapshot(&app->controller);
}

const brace_parameters_t *brace_app_parameters(const brace_app_t *app)
{
    return request_parameters(&app->controller);
}

void brace_app_counters(const brace_app_t *app, brace_app_counters_t *counters)
{
    request_counters(&app->controller, counters);
    wires_counters(&app->wires, counters);
}

const brace_drift_report_t *brace_app_drift_report(const brace_app_t *app)
{
    return request_drift_report(&app->controller);
}

brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint_index, int32_t flank)
{
    return app == NULL ? BRACE_E_NULL : request_take_up(&app->controller, joint_index, flank);
}

brace_status_t brace_app_let_go(brace_app_t *app)
{
    return app == NULL ? BRACE_E_NULL : request_let_go(&app->controller);
}

brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup)
{
    return app == NULL || setup == NULL ? BRACE_E_NULL : request_loading_start(&app->controller, setup);
}

brace_status_t brace_app_loading_stop(brace_app_t *app)
{
    return app == NULL ? BRACE_E_NULL : request_loading_stop(&app->controller);
}

const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app)
{
    return request_loading_result(&app->controller);
}

uint32_t brace_app_row_count(const brace_app_t *app)
{
    return app == NULL ? 0u : request_row_count(&app->controller);
}

brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row)
{
    return app == NULL ? BRACE_E_NULL : request_row(&app->controller, index, row);
}

brace_status_t brace_app_configuration_enter(brace_app_t *app)
{
    return app == NULL ? BRACE_E_NULL : request_configuration_enter(&app->controller);
}

brace_status_t brace_app_configuration_leave(brace_app_t *app)
{
    return app == NULL ? BRACE_E_NULL : request_configuration_leave(&app->controller);
}

brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters)
{
    if (app == NULL || parameters == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t open = request_may_write(&app->controller);
    const brace_status_t status = open == BRACE_OK ? brace_parameters_check(parameters, NULL) : open;
    return status == BRACE_OK ? request_commit(&app->controller, parameters) : status;
}

brace_status_t brace_app_parameters_rollback(brace_app_t *app)
{
    return app == NULL ? BRACE_E_NULL : request_rollback(&app->controller);
}

brace_status_t brace_app_store_status(const brace_app_t *app, brace_store_status_t *status)
{
    if (app == NULL || status == NULL) {
        return BRACE_E_NULL;
    }
    request_store_status(&app->controller, status);
    return BRACE_OK;
}

brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults)
{
    return app == NULL ? BRACE_E_NULL : request_clear(&app->controller, faults);
}
