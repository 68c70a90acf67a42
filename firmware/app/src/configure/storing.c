#include "configure/storing.h"

#include "configure/configure.h"

enum { STORING_NOTHING = 0, STORING_COMMIT, STORING_ROLLBACK };

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
    const brace_status_t status = brace_store_begin(&app->store, parameters, NULL);
    if (status == BRACE_OK) {
        app->next = *parameters;
        app->next_crc = brace_parameters_crc(parameters);
        app->store_work = STORING_COMMIT;
    }
    return status;
}

brace_status_t storing_rollback(brace_app_t *app)
{
    if (storing_busy(app)) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = brace_store_rollback(&app->store);
    app->store_work = status == BRACE_OK ? STORING_ROLLBACK : STORING_NOTHING;
    return status;
}

bool storing_busy(const brace_app_t *app)
{
    return app->store_work != STORING_NOTHING || app->configure_piece != 0;
}

void storing_step(brace_app_t *app)
{
    if (app->store_work == STORING_NOTHING) {
        return;
    }
    const brace_store_state_t state = brace_store_step(&app->store);
    if (state == BRACE_STORE_BUSY) {
        return;
    }
    if (state == BRACE_STORE_DONE && app->store_work == STORING_ROLLBACK) {
        (void)brace_store_take(&app->store, &app->parameters, &app->parameter_crc);
        configure_begin(app);
    } else if (state == BRACE_STORE_DONE) {
        app->parameters = app->next; /* every byte of it has read back */
        app->parameter_crc = app->next_crc;
        configure_begin(app);
    }
    app->store_work = STORING_NOTHING;
    judge(app);
}
