#include "report/announce.h"

#include "can/bus.h"
#include "report/frames.h"

#define MOST_US 100000000u

static bool heart_beats(const brace_app_t *app)
{
    /* period = 1e6 / rate, without the division */
    const uint32_t since_us = app->last_us - app->report.beat_us;
    return since_us >= MOST_US || since_us * app->parameters.controller.heartbeat_hz >= 1000000u;
}

bool announce_wants(const brace_app_t *app)
{
    const brace_app_report_t *report = &app->report;
    return bus_speaks(app) &&
           (app->faults != report->faults_told || app->mode != report->mode_told || heart_beats(app));
}

bool announce(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    uint8_t data[8];
    if (!announce_wants(app)) {
        return false;
    }
    if (app->faults != report->faults_told) {
        frame_emergency(data, report->faults_told, app->faults, app->mode);
        report->faults_told = bus_send(app, BRACE_CAN_ID_EMERGENCY, data) ? app->faults : report->faults_told;
        return true;
    }
    frame_heartbeat(data, app->mode, app->faults);
    if (bus_send(app, BRACE_CAN_ID_HEARTBEAT, data)) {
        report->beat_us = app->last_us;
        report->mode_told = app->mode;
    }
    return true;
}
