#include "configure/storing.h"

#include "configure/configure.h"

/* Where the set in force comes from, and the faults that last as long as it. */
static void judge(brace_app_t *app)
{
    brace_store_status_t status;
    brace_store_status(&app->store, &status);
    app->origin = status.in_force;
    app->lasting_faults = (status.in_force == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FAULT_PARAMETERS : 0u) |
                          (status.memory_fault ? (uint32_t)BRACE_FAULT_STORE : 0u);
}

void storing_start(brace_app_t *app)
{
    (void)brace_store_start(&app->store, app->hal, &app->parameters);
    app->parameter_crc = brace_parameters_crc(&app->parameters);
    judge(app);
    app->faults = app->lasting_faults;
}

brace_status_t storing_commit(brace_app_t *app, const brace_parameters_t *parameters)
{
    if (storing_busy(app)) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = brace_store_offer(&app->store, parameters);
    app->storing = status == BRACE_OK;
    return status;
}

brace_status_t storing_rollback(brace_app_t *app)
{
    if (storing_busy(app)) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = brace_store_rollback(&app->store);
    app->storing = status == BRACE_OK;
    return status;
}

bool storing_busy(const brace_app_t *app)
{
    return app->storing || app->configure_piece != 0;
}

void storing_step(brace_app_t *app)
{
    const brace_store_state_t state = app->storing ? brace_store_step(&app->store) : BRACE_STORE_BUSY;
    if (state == BRACE_STORE_BUSY) {
        return;
    }
    if (state == BRACE_STORE_DONE) {
        (void)brace_store_take(&app->store, &app->parameters, &app->parameter_crc);
        app->staging.begun = false;
        configure_begin(app, !app->store.rolling_back);
    }
    app->storing = false;
    judge(app);
}
