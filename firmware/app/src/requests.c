#include "brace/app.h"
#include "configure/keeping.h"
#include "configure/staging.h"
#include "configure/storing.h"
#include "measure/loading.h"
#include "motion/takeup.h"

brace_status_t brace_app_take_up(brace_app_t *app, int32_t joint_index, int32_t flank)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    if (app->mode != BRACE_MODE_MONITOR && app->mode != BRACE_MODE_TAKING_UP) {
        return BRACE_E_MODE;
    }
    const brace_status_t status = takeup_request(app, joint_index, flank);
    app->mode = takeup_active(app) ? BRACE_MODE_TAKING_UP : app->mode;
    return status;
}

brace_status_t brace_app_let_go(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    if (app->mode != BRACE_MODE_TAKING_UP && app->mode != BRACE_MODE_LOADING_TEST) {
        return BRACE_E_MODE;
    }
    loading_end(app, BRACE_LOADING_STOPPED);
    takeup_let_go(app);
    return BRACE_OK;
}

brace_status_t brace_app_loading_start(brace_app_t *app, const brace_loading_setup_t *setup)
{
    if (app == NULL || setup == NULL) {
        return BRACE_E_NULL;
    }
    const bool rests = app->mode == BRACE_MODE_MONITOR;
    if (app->loading.phase != LOADING_IDLE || !(rests || (app->mode == BRACE_MODE_TAKING_UP && takeup_holds(app)))) {
        return BRACE_E_MODE;
    }
    if (app->hal->joint_command == NULL) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = loading_start(app, setup);
    app->mode = status == BRACE_OK ? BRACE_MODE_LOADING_TEST : app->mode;
    return status;
}

brace_status_t brace_app_loading_stop(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    if (app->loading.phase == LOADING_IDLE) {
        return BRACE_E_MODE;
    }
    loading_end(app, BRACE_LOADING_STOPPED);
    return BRACE_OK;
}

const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app)
{
    return &app->loading.result;
}

uint32_t brace_app_row_count(const brace_app_t *app)
{
    return app == NULL ? 0u : app->recorder.count;
}

brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row)
{
    return app == NULL ? BRACE_E_NULL : brace_recorder_row(&app->recorder, index, row);
}

brace_status_t brace_app_configuration_enter(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const bool moves = takeup_active(app) || app->loading.phase != LOADING_IDLE;
    if (moves || (app->mode != BRACE_MODE_MONITOR && app->mode != BRACE_MODE_FAULT)) {
        return BRACE_E_MODE;
    }
    app->mode = BRACE_MODE_CONFIGURATION;
    app->staging.begun = false;
    staging_keep(app);
    return BRACE_OK;
}

brace_status_t brace_app_configuration_leave(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    if (app->mode != BRACE_MODE_CONFIGURATION || storing_busy(app)) {
        return BRACE_E_MODE;
    }
    app->mode = BRACE_MODE_START;
    app->start_us = 0;
    return BRACE_OK;
}

brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters)
{
    if (app == NULL || parameters == NULL) {
        return BRACE_E_NULL;
    }
    if (app->mode != BRACE_MODE_CONFIGURATION) {
        return BRACE_E_MODE;
    }
    if (storing_busy(app)) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = brace_parameters_check(parameters, NULL);
    return status == BRACE_OK ? storing_commit(app, parameters) : status;
}

brace_status_t brace_app_parameters_rollback(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    return app->mode == BRACE_MODE_CONFIGURATION ? storing_rollback(app) : BRACE_E_MODE;
}

brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    if ((faults & ~(uint32_t)(BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED)) != 0u) {
        return BRACE_E_RANGE;
    }
    if ((faults & BRACE_FAULT_MODEL_DRIFT) != 0u) {
        (void)brace_drift_reset(&app->drift);
        keeping_look(app);
    }
    if ((faults & BRACE_FAULT_CRASHED) != 0u) {
        app->hal->crash_clear(app->hal->context);
    }
    app->supervisor.latched &= ~faults;
    app->faults &= ~faults;
    return BRACE_OK;
}
