#include "modbus/command.h"

#include <string.h>

#include "configure/staging.h"
#include "configure/storing.h"
#include "measure/model.h"

#define KEY 0xc0de0000u /* of what nobody writes by mistake */

enum { FLANK_POSITIVE = 256, FLANK_NEGATIVE = 512 };

static modbus_exception_t refusal_of(brace_status_t status)
{
    switch (status) {
    case BRACE_OK: return MODBUS_FINE;
    case BRACE_E_MODE: return MODBUS_E_FUNCTION;
    case BRACE_E_RANGE:
    case BRACE_E_PARAMETER:
    case BRACE_E_NOT_FINITE: return MODBUS_E_VALUE;
    default: return MODBUS_E_DEVICE;
    }
}

static modbus_exception_t set_mode(brace_app_t *app, uint32_t value)
{
    const bool configures = app->mode == BRACE_MODE_CONFIGURATION;
    if (value == (KEY | BRACE_MODE_CONFIGURATION)) {
        staging_keep(app);
        return configures ? MODBUS_FINE : refusal_of(brace_app_configuration_enter(app));
    }
    if (value != (KEY | BRACE_MODE_MONITOR)) {
        return MODBUS_E_VALUE;
    }
    if (storing_busy(app)) {
        return MODBUS_E_BUSY;
    }
    return configures ? refusal_of(brace_app_configuration_leave(app)) : MODBUS_FINE;
}

static modbus_exception_t store(brace_app_t *app, uint32_t value, bool is_commit)
{
    if (value != (KEY | 1u)) {
        return MODBUS_E_VALUE;
    }
    const brace_status_t open = staging_open(app);
    if (open != BRACE_OK) {
        return open == BRACE_E_UNSUPPORTED ? MODBUS_E_BUSY : refusal_of(open);
    }
    return refusal_of(is_commit ? staging_commit(app, NULL) : brace_app_parameters_rollback(app));
}

static modbus_exception_t take_up(brace_app_t *app, uint32_t value)
{
    const uint32_t joint = value & 0xffu, flank = value - joint;
    if (flank != FLANK_POSITIVE && flank != FLANK_NEGATIVE) {
        return MODBUS_E_VALUE;
    }
    const brace_status_t status = brace_app_take_up(app, (int32_t)joint, flank == FLANK_POSITIVE ? 1 : -1);
    app->modbus.take_up = status == BRACE_OK ? value : app->modbus.take_up;
    return refusal_of(status);
}

modbus_exception_t command_run(brace_app_t *app, uint32_t index, uint32_t value)
{
    switch (index) {
    case COMMAND_SET_MODE: return set_mode(app, value);
    case COMMAND_COMMIT: return store(app, value, true);
    case COMMAND_ROLLBACK: return store(app, value, false);
    case COMMAND_CLEAR_FAULTS: return refusal_of(brace_app_clear(app, value));
    case COMMAND_TAKE_UP: return take_up(app, value);
    case COMMAND_LET_GO: return refusal_of(brace_app_let_go(app));
    default: return MODBUS_E_VALUE; /* part of a question */
    }
}

static uint32_t stored(const brace_app_t *app)
{
    brace_store_status_t status;
    brace_store_status(&app->store, &status);
    return storing_busy(app) ? 1u : status.state == BRACE_STORE_FAILED ? (uint32_t)(256 + (int)status.failure) : 0u;
}

uint32_t command_read(const brace_app_t *app, uint32_t index)
{
    switch (index) {
    case COMMAND_SET_MODE: return app->mode;
    case COMMAND_COMMIT:
    case COMMAND_ROLLBACK: return stored(app);
    case COMMAND_CLEAR_FAULTS: return app->faults;
    case COMMAND_TAKE_UP: return app->modbus.take_up;
    case COMMAND_LET_GO: return 0;
    default: return app->modbus.asked[index - COMMAND_ASKED_THETA1];
    }
}
