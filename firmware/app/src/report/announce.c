#include "report/announce.h"

#include "report/frames.h"

#define HEARTBEAT_US 1000000u
#define HEALTH_US 10000u
#define RECOVER_US 250000u

void announce_start(brace_app_t *app)
{
    const brace_hal_t *hal = app->hal;
    brace_app_report_t *report = &app->report;
    const brace_controller_t *controller = &app->parameters.controller;
    *report = (brace_app_report_t){0};
    if (hal->can_setup == NULL || hal->can_send == NULL || hal->can_receive == NULL || hal->can_health == NULL ||
        hal->can_recover == NULL) {
        return;
    }
    const brace_can_setup_t setup = {.bit_rate = controller->can_bit_rate, .listen_only = controller->node_id == 0u};
    report->listens = hal->can_setup(hal->context, &setup) == BRACE_HAL_OK;
    report->node_id = (uint8_t)controller->node_id;
    report->speaks = report->listens && controller->node_id >= 1u && controller->node_id <= 127u;
}

static void watch_bus(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    brace_can_health_t health;
    report->health_us += app->tick_us;
    report->recover_us += report->bus_off ? app->tick_us : 0u;
    if (report->health_us >= HEALTH_US) {
        report->health_us = 0;
        if (app->hal->can_health(app->hal->context, &health) == BRACE_HAL_OK) {
            report->bus_off = health.bus_off;
        }
    }
    if (report->bus_off && report->recover_us >= RECOVER_US) {
        report->recover_us = 0;
        (void)app->hal->can_recover(app->hal->context);
    }
}

static bool send(brace_app_t *app, const brace_can_frame_t *frame)
{
    const int32_t answer = app->hal->can_send(app->hal->context, frame);
    if (answer != BRACE_HAL_OK && answer != BRACE_HAL_AGAIN) {
        app->counters.frames_refused += app->counters.frames_refused < UINT32_MAX;
        app->report.bus_off = app->report.bus_off || answer == BRACE_HAL_E_BUS_OFF;
    }
    return answer == BRACE_HAL_OK;
}

bool announce(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    brace_can_frame_t frame;
    if (!report->listens) {
        return false;
    }
    watch_bus(app);
    report->heartbeat_us += report->heartbeat_us < 0x40000000u ? app->tick_us : 0u;
    if (!report->speaks || report->bus_off) {
        return false;
    }
    if (app->faults != report->faults_told) {
        frame_emergency(&frame, report->node_id, report->faults_told, app->faults, app->mode);
        report->faults_told = send(app, &frame) ? app->faults : report->faults_told;
    } else if (report->heartbeat_us >= HEARTBEAT_US || app->mode != report->mode_told) {
        frame_heartbeat(&frame, report->node_id, app->mode, app->faults);
        if (send(app, &frame)) {
            report->heartbeat_us = 0;
            report->mode_told = app->mode;
        }
    } else {
        return false;
    }
    return true;
}
