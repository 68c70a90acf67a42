#include "report/announce.h"

#include "can/bus.h"
#include "report/frames.h"

static bool heart_beats(const brace_app_t *app)
{
    /* period = 1e6 / rate, without the division */
    return app->report.heartbeat_us * app->parameters.controller.heartbeat_hz >= 1000000u;
}

bool announce(brace_app_t *app)
{
    brace_app_report_t *report = &app->report;
    uint8_t data[8];
    report->heartbeat_us += report->heartbeat_us < 10000000u ? app->tick_us : 0u;
    if (!bus_speaks(app)) {
        return false;
    }
    if (app->faults != report->faults_told) {
        frame_emergency(data, report->faults_told, app->faults, app->mode);
        report->faults_told = bus_send(app, BRACE_CAN_ID_EMERGENCY, data) ? app->faults : report->faults_told;
    } else if (heart_beats(app) || app->mode != report->mode_told) {
        frame_heartbeat(data, app->mode, app->faults);
        if (bus_send(app, BRACE_CAN_ID_HEARTBEAT, data)) {
            report->heartbeat_us = 0;
            report->mode_told = app->mode;
        }
    } else {
        return false;
    }
    return true;
}
