#include "brace/requests.h"

#include <stddef.h>

#include "brace/refusals.h"
#include "controller.h"

/* ------------------------------------------------------------------------------------ what is known -- */

const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app)
{
    const controller_t *controller = controller_in(app);
    return &controller->snapshot[controller->newest];
}

brace_mode_t brace_app_mode(const brace_app_t *app)
{
    return controller_in(app)->mode.now;
}

uint32_t brace_app_faults(const brace_app_t *app)
{
    return controller_in(app)->faults.now;
}

const brace_parameters_t *brace_app_parameters(const brace_app_t *app)
{
    return &controller_in(app)->parameters.in_force;
}

void brace_app_counters(const brace_app_t *app, brace_app_counters_t *counters)
{
    *counters = controller_in(app)->counters;
}

const brace_drift_report_t *brace_app_drift_report(const brace_app_t *app)
{
    return &controller_in(app)->drift.report;
}

brace_drift_next_t brace_app_drift_next_step(const brace_app_t *app)
{
    return drift_job_next_step(&controller_in(app)->drift);
}

/* ------------------------------------------------------------------------ what the limb has done -- */

bool brace_app_loading_is_returning(const brace_app_t *app)
{
    return controller_in(app)->loading.phase == LOADING_RETURN;
}

const brace_loading_result_t *brace_app_loading_result(const brace_app_t *app)
{
    return &controller_in(app)->loading.result;
}

uint32_t brace_app_row_count(const brace_app_t *app)
{
    return app == NULL ? 0u : controller_in(app)->recorder.count;
}

brace_status_t brace_app_row(const brace_app_t *app, uint32_t index, brace_row_t *row)
{
    return app == NULL ? BRACE_E_NULL : brace_recorder_row(&controller_in(app)->recorder, index, row);
}

brace_status_t brace_app_clear(brace_app_t *app, uint32_t faults)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    static const uint32_t jumped[BRACE_LINK_COUNT] = {[BRACE_COXA] = BRACE_FAULT_JUMP_COXA,
                                                      [BRACE_FEMUR] = BRACE_FAULT_JUMP_FEMUR,
                                                      [BRACE_TIBIA] = BRACE_FAULT_JUMP_TIBIA};
    const uint32_t cleared_by_hand = BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED | BRACE_FAULT_ENCODER_STUCK |
                                     BRACE_FAULT_OLD_PARAMETERS | BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR |
                                     BRACE_FAULT_JUMP_TIBIA;
    if ((faults & ~cleared_by_hand) != 0u) {
        return BRACE_E_RANGE;
    }
    if ((faults & BRACE_FAULT_MODEL_DRIFT) != 0u) {
        drift_job_clear(&controller->drift);
    }
    if ((faults & BRACE_FAULT_ENCODER_STUCK) != 0u) {
        frozen_start(&controller->frozen);
    }
    if ((faults & BRACE_FAULT_OLD_PARAMETERS) != 0u) {
        parameter_job_accept(&controller->parameters);
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if ((faults & jumped[i]) != 0u) {
            joints_believe(&controller->joints, i);
        }
    }
    if ((faults & BRACE_FAULT_CRASHED) != 0u) {
        const brace_hal_t *hal = controller->hal;
        hal->crash_clear(hal->context);
        controller->has_crashed = false;
    }
    controller->faults.now &= ~faults;
    return BRACE_OK;
}

/* --------------------------------------------------------------------------------------- parameters -- */

brace_status_t brace_app_configuration_enter(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    const brace_mode_t mode = controller->mode.now;
    if (mode == BRACE_MODE_CONFIGURATION) {
        parameter_job_keep_open(&controller->parameters);
        return BRACE_OK;
    }
    const bool moves = controller_takes_up(controller) || loading_runs(&controller->loading);
    if (moves || (mode != BRACE_MODE_MONITOR && mode != BRACE_MODE_FAULT)) {
        return BRACE_E_MODE;
    }
    controller->mode.now = BRACE_MODE_CONFIGURATION;
    parameter_job_open(&controller->parameters);
    return BRACE_OK;
}

brace_status_t brace_app_configuration_leave(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    if (controller->mode.now != BRACE_MODE_CONFIGURATION || parameter_job_is_busy(&controller->parameters)) {
        return BRACE_E_MODE;
    }
    mode_start(&controller->mode);
    return BRACE_OK;
}

brace_status_t brace_app_may_write(brace_app_t *app)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    if (controller->mode.now != BRACE_MODE_CONFIGURATION) {
        return BRACE_E_MODE;
    }
    parameter_job_keep_open(&controller->parameters);
    return parameter_job_is_busy(&controller->parameters) ? BRACE_E_UNSUPPORTED : BRACE_OK;
}

const brace_parameters_t *brace_app_parameters_staged(const brace_app_t *app)
{
    return parameter_job_staged(&controller_in(app)->parameters);
}

bool brace_app_has_staged(const brace_app_t *app)
{
    return controller_in(app)->parameters.has_staged;
}

brace_status_t brace_app_parameters_stage(brace_app_t *app, uint32_t first_number, uint32_t count,
                                          const uint32_t *words)
{
    const brace_status_t status = words == NULL ? BRACE_E_NULL : brace_app_may_write(app);
    return status == BRACE_OK ? parameter_job_write(&controller_of(app)->parameters, first_number, count, words)
                              : status;
}

brace_status_t brace_app_parameters_commit_staged(brace_app_t *app, uint32_t *wrong_index)
{
    const brace_status_t status = brace_app_may_write(app);
    return status == BRACE_OK ? parameter_job_commit_staged(&controller_of(app)->parameters, wrong_index) : status;
}

brace_status_t brace_app_parameters_commit_named(brace_app_t *app, uint32_t crc, uint32_t *wrong_index)
{
    const brace_status_t status = brace_app_parameters_commit_staged(app, wrong_index);
    if (status == BRACE_OK) {
        brace_store_expect(&controller_of(app)->parameters.store, crc);
    }
    return status;
}

int32_t brace_app_may_commit(brace_app_t *app, uint32_t *wait_ms)
{
    controller_t *controller = controller_of(app);
    *wait_ms = parameter_job_wait_ms(&controller->parameters);
    if (*wait_ms == 0u) {
        return BRACE_OK;
    }
    brace_count(&controller->parameters.commits_refused);
    controller->ownership.last_refusal = BRACE_REFUSED_EARLY;
    return BRACE_REFUSED_EARLY;
}

uint32_t brace_app_beyond_board(const brace_app_t *app, const brace_parameters_t *parameters)
{
    const controller_t *controller = controller_in(app);
    const brace_hal_ceiling_t *ceiling = controller->hal->ceiling;
    if (parameters->controller.node_id == 0u && controller->parameters.in_force.controller.node_id != 0u) {
        return BRACE_PARAMETER_CONTROLLER_NODE_ID;
    }
    for (uint32_t i = 0; i < BRACE_LINK_COUNT && ceiling != NULL; i++, ceiling++) {
        const brace_drive_t *drive = &parameters->drive[i];
        const uint32_t first = (uint32_t)((const uint32_t *)drive - (const uint32_t *)parameters);
        if (drive->torque_range_n_mm > ceiling->torque_most_n_mm) {
            return first + (uint32_t)(offsetof(brace_drive_t, torque_range_n_mm) / 4);
        }
        if (drive->angle_min_rad < ceiling->angle_least_rad) {
            return first + (uint32_t)(offsetof(brace_drive_t, angle_min_rad) / 4);
        }
        if (drive->angle_max_rad > ceiling->angle_most_rad) {
            return first + (uint32_t)(offsetof(brace_drive_t, angle_max_rad) / 4);
        }
    }
    return BRACE_PARAMETER_COUNT;
}

brace_status_t brace_app_parameters_commit(brace_app_t *app, const brace_parameters_t *parameters)
{
    const brace_status_t status = parameters == NULL ? BRACE_E_NULL : brace_app_may_write(app);
    return status == BRACE_OK ? parameter_job_commit(&controller_of(app)->parameters, parameters) : status;
}

brace_status_t brace_app_parameters_rollback(brace_app_t *app)
{
    const brace_status_t status = brace_app_may_write(app);
    return status == BRACE_OK ? parameter_job_rollback(&controller_of(app)->parameters) : status;
}

bool brace_app_is_storing(const brace_app_t *app)
{
    return parameter_job_is_busy(&controller_in(app)->parameters);
}

brace_status_t brace_app_store_status(const brace_app_t *app, brace_store_status_t *status)
{
    if (app == NULL || status == NULL) {
        return BRACE_E_NULL;
    }
    brace_store_status(&controller_in(app)->parameters.store, status);
    return BRACE_OK;
}

/* ------------------------------------------------------------------------------------ where down is -- */

brace_status_t brace_app_set_gravity(brace_app_t *app, float direction_rad, float lean_rad)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    const brace_status_t status =
        gravity_set(&controller->gravity, &controller->parameters.in_force.gravity, direction_rad, lean_rad);
    const guard_span_t changed = {&controller->gravity, sizeof controller->gravity / 4u};
    guard_take(&controller->guard, GUARDED_GRAVITY, &changed);
    return status;
}

void brace_app_gravity(const brace_app_t *app, float *direction_rad, float *lean_rad)
{
    const gravity_t *gravity = &controller_in(app)->gravity;
    *direction_rad = gravity->direction_rad;
    *lean_rad = gravity->lean_rad;
}
