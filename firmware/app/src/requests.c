#include "requests.h"

#include <stddef.h>

#include "controller.h"
#include "stiffness/questions.h"

/* ------------------------------------------------------------------------------------ what is known -- */

const brace_snapshot_t *request_snapshot(const controller_t *controller)
{
    return &controller->snapshot[controller->newest];
}

brace_mode_t request_mode(const controller_t *controller)
{
    return controller->mode.now;
}

uint32_t request_faults(const controller_t *controller)
{
    return controller->faults.now;
}

const brace_parameters_t *request_parameters(const controller_t *controller)
{
    return &controller->parameters.in_force;
}

uint32_t request_parameter_crc(const controller_t *controller)
{
    return controller->parameters.crc;
}

uint32_t request_parameter_sequence(const controller_t *controller)
{
    return brace_store_sequence(&controller->parameters.store);
}

brace_parameter_origin_t request_parameter_origin(const controller_t *controller)
{
    return controller->parameters.origin;
}

void request_counters(const controller_t *controller, brace_app_counters_t *counters)
{
    *counters = (brace_app_counters_t){.ticks_late = controller->ticks_late,
                                       .samples_bad = controller->joints.samples_bad,
                                       .commands_failed = controller->drives.commands_failed};
}

const brace_drift_report_t *request_drift_report(const controller_t *controller)
{
    return &controller->drift.report;
}

brace_drift_next_t request_drift_next_step(const controller_t *controller)
{
    return drift_job_next_step(&controller->drift);
}

/* ------------------------------------------------------------------------------- what moves the limb -- */

brace_status_t request_take_up(controller_t *controller, int32_t joint_index, int32_t flank)
{
    const brace_mode_t mode = controller->mode.now;
    if (mode != BRACE_MODE_MONITOR && mode != BRACE_MODE_TAKING_UP) {
        return BRACE_E_MODE;
    }
    if (controller->hal->joint_command == NULL) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = takeup_request(&controller->takeup, &controller->flank, joint_index, flank);
    controller->mode.now = takeup_runs(&controller->takeup) ? BRACE_MODE_TAKING_UP : mode;
    return status;
}

brace_status_t request_let_go(controller_t *controller)
{
    const brace_mode_t mode = controller->mode.now;
    if (mode != BRACE_MODE_TAKING_UP && mode != BRACE_MODE_LOADING_TEST) {
        return BRACE_E_MODE;
    }
    loading_end(&controller->loading, BRACE_LOADING_STOPPED);
    takeup_let_go(&controller->takeup);
    return BRACE_OK;
}

brace_status_t request_loading_start(controller_t *controller, const brace_loading_setup_t *setup)
{
    const brace_mode_t mode = controller->mode.now;
    const bool holds = mode == BRACE_MODE_TAKING_UP && takeup_holds(&controller->takeup, &controller->flank);
    if (loading_runs(&controller->loading) || !(mode == BRACE_MODE_MONITOR || holds)) {
        return BRACE_E_MODE;
    }
    if (controller->hal->joint_command == NULL) {
        return BRACE_E_UNSUPPORTED;
    }
    const loading_inputs_t inputs = {.now = request_snapshot(controller),
                                     .joints = &controller->joints,
                                     .flank = &controller->flank,
                                     .posture = &controller->posture,
                                     .model = &controller->model,
                                     .parameters = &controller->parameters.in_force};
    const brace_status_t status = loading_start(&controller->loading, &inputs, setup);
    if (status == BRACE_OK) {
        drift_job_end_run(&controller->drift);
        controller->mode.now = BRACE_MODE_LOADING_TEST;
    }
    return status;
}

brace_status_t request_loading_stop(controller_t *controller)
{
    if (!loading_runs(&controller->loading)) {
        return BRACE_E_MODE;
    }
    loading_end(&controller->loading, BRACE_LOADING_STOPPED);
    return BRACE_OK;
}

const brace_loading_result_t *request_loading_result(const controller_t *controller)
{
    return &controller->loading.result;
}

bool request_loading_is_returning(const controller_t *controller)
{
    return controller->loading.phase == LOADING_RETURN;
}

uint32_t request_row_count(const controller_t *controller)
{
    return controller->recorder.count;
}

brace_status_t request_row(const controller_t *controller, uint32_t index, brace_row_t *row)
{
    return brace_recorder_row(&controller->recorder, index, row);
}

brace_status_t request_clear(controller_t *controller, uint32_t faults)
{
    if ((faults & ~(uint32_t)(BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED)) != 0u) {
        return BRACE_E_RANGE;
    }
    if ((faults & BRACE_FAULT_MODEL_DRIFT) != 0u) {
        drift_job_clear(&controller->drift);
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

brace_status_t request_configuration_enter(controller_t *controller)
{
    const brace_mode_t mode = controller->mode.now;
    const bool moves = takeup_runs(&controller->takeup) || loading_runs(&controller->loading);
    if (moves || (mode != BRACE_MODE_MONITOR && mode != BRACE_MODE_FAULT)) {
        return BRACE_E_MODE;
    }
    controller->mode.now = BRACE_MODE_CONFIGURATION;
    parameter_job_open(&controller->parameters);
    return BRACE_OK;
}

brace_status_t request_configuration_leave(controller_t *controller)
{
    if (controller->mode.now != BRACE_MODE_CONFIGURATION || parameter_job_is_busy(&controller->parameters)) {
        return BRACE_E_MODE;
    }
    mode_start(&controller->mode);
    return BRACE_OK;
}

void request_configuration_keep(controller_t *controller)
{
    parameter_job_keep_open(&controller->parameters);
}

bool request_is_storing(const controller_t *controller)
{
    return parameter_job_is_busy(&controller->parameters);
}

void request_store_status(const controller_t *controller, brace_store_status_t *status)
{
    brace_store_status(&controller->parameters.store, status);
}

brace_status_t request_may_write(controller_t *controller)
{
    if (controller->mode.now != BRACE_MODE_CONFIGURATION) {
        return BRACE_E_MODE;
    }
    parameter_job_keep_open(&controller->parameters);
    return parameter_job_is_busy(&controller->parameters) ? BRACE_E_UNSUPPORTED : BRACE_OK;
}

const brace_parameters_t *request_staged(const controller_t *controller)
{
    return parameter_job_staged(&controller->parameters);
}

brace_status_t request_stage(controller_t *controller, uint32_t number, uint32_t word)
{
    return request_stage_block(controller, number, 1, &word);
}

brace_status_t request_stage_block(controller_t *controller, uint32_t first_number, uint32_t count,
                                   const uint32_t *words)
{
    const brace_status_t status = request_may_write(controller);
    return status == BRACE_OK ? parameter_job_write(&controller->parameters, first_number, count, words) : status;
}

brace_status_t request_commit_staged(controller_t *controller, uint32_t *wrong_index)
{
    const brace_status_t status = request_may_write(controller);
    return status == BRACE_OK ? parameter_job_commit_staged(&controller->parameters, wrong_index) : status;
}

brace_status_t request_commit(controller_t *controller, const brace_parameters_t *parameters)
{
    const brace_status_t status = request_may_write(controller);
    return status == BRACE_OK ? parameter_job_commit(&controller->parameters, parameters) : status;
}

brace_status_t request_rollback(controller_t *controller)
{
    const brace_status_t status = request_may_write(controller);
    return status == BRACE_OK ? parameter_job_rollback(&controller->parameters) : status;
}

/* ------------------------------------------------------------------------------------------ questions -- */

static question_limb_t limb_of(controller_t *controller)
{
    return (question_limb_t){.model = &controller->model,
                             .parameters = &controller->parameters.in_force,
                             .origin = controller->parameters.origin,
                             .joints = &controller->joints};
}

brace_status_t request_k_at_posture(controller_t *controller, float theta1_rad, float theta2_rad,
                                    brace_stiffness_t *stiffness)
{
    const question_limb_t limb = limb_of(controller);
    return question_k_at_posture(&limb, theta1_rad, theta2_rad, stiffness);
}

brace_status_t request_k_at_tip(controller_t *controller, brace_point_t tip, brace_knee_t knee,
                                brace_stiffness_t *stiffness)
{
    const question_limb_t limb = limb_of(controller);
    return question_k_at_tip(&limb, tip, knee, stiffness);
}

brace_status_t request_k_in_space(controller_t *controller, float theta0_rad, float theta1_rad, float theta2_rad,
                                  brace_stiffness_spatial_t *stiffness)
{
    const question_limb_t limb = limb_of(controller);
    return question_k_in_space(&limb, theta0_rad, theta1_rad, theta2_rad, stiffness);
}

brace_status_t request_contact_force(const controller_t *controller, brace_displacement_t displacement,
                                     brace_contact_force_t *contact)
{
    return question_contact_force(request_snapshot(controller), displacement, contact);
}

brace_status_t request_sag(const controller_t *controller, brace_force_t load, brace_displacement_t *sag)
{
    return question_sag(request_snapshot(controller), load, sag);
}

brace_status_t request_grip(const controller_t *controller, float normal_rad, float friction_ratio,
                            brace_contact_grip_t *grip)
{
    return question_grip(request_snapshot(controller), normal_rad, friction_ratio, grip);
}
