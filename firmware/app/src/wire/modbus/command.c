#include "wire/modbus/command.h"

#include "wire/modbus/refusal.h"

#define KEY 0xc0de0000u /* in the high half of what nobody must write by mistake */

enum { FLANK_POSITIVE = 256, FLANK_NEGATIVE = 512 };

static modbus_exception_t command_set_mode(modbus_server_t *server, brace_app_t *app, uint32_t value)
{
    (void)server;
    const bool configures = brace_app_mode(app) == BRACE_MODE_CONFIGURATION;
    if (value == (KEY | BRACE_MODE_CONFIGURATION)) {
        return modbus_refusal_of(brace_app_configuration_enter(app));
    }
    if (value != (KEY | BRACE_MODE_MONITOR)) {
        return MODBUS_E_VALUE;
    }
    if (brace_app_is_storing(app)) {
        return MODBUS_E_BUSY;
    }
    return configures ? modbus_refusal_of(brace_app_configuration_leave(app)) : MODBUS_FINE;
}

static modbus_exception_t store(brace_app_t *app, uint32_t value, bool is_commit)
{
    if (value != (KEY | 1u)) {
        return MODBUS_E_VALUE;
    }
    const modbus_exception_t why = modbus_refusal_to_write(app);
    if (why != MODBUS_FINE) {
        return why;
    }
    return modbus_refusal_of(is_commit ? brace_app_parameters_commit_staged(app, NULL) : brace_app_parameters_rollback(app));
}

static modbus_exception_t command_commit(modbus_server_t *server, brace_app_t *app, uint32_t value)
{
    (void)server;
    return store(app, value, true);
}

static modbus_exception_t command_rollback(modbus_server_t *server, brace_app_t *app, uint32_t value)
{
    (void)server;
    return store(app, value, false);
}

static modbus_exception_t command_clear_faults(modbus_server_t *server, brace_app_t *app, uint32_t value)
{
    (void)server;
    return modbus_refusal_of(brace_app_clear(app, value));
}

static modbus_exception_t command_take_up(modbus_server_t *server, brace_app_t *app, uint32_t value)
{
    const uint32_t joint = value & 0xffu, flank = value - joint;
    if (flank != FLANK_POSITIVE && flank != FLANK_NEGATIVE) {
        return MODBUS_E_VALUE;
    }
    const brace_status_t status = brace_app_take_up(app, (int32_t)joint, flank == FLANK_POSITIVE ? 1 : -1);
    if (status == BRACE_OK) {
        server->written.take_up = value;
    }
    return modbus_refusal_of(status);
}

static modbus_exception_t command_let_go(modbus_server_t *server, brace_app_t *app, uint32_t value)
{
    (void)server;
    (void)value;
    return modbus_refusal_of(brace_app_let_go(app));
}

/* Who does a command; null: it is a value of a question. */
typedef struct {
    modbus_exception_t (*run)(modbus_server_t *server, brace_app_t *app, uint32_t value);
} command_entry_t;

#define ENTRY(member) [MODBUS_COMMAND(member)] = {command_##member},
static const command_entry_t entries[BRACE_COMMANDS_COUNT] = {BRACE_COMMANDS(ENTRY)};
#undef ENTRY

modbus_exception_t modbus_command_run(modbus_server_t *server, brace_app_t *app, uint32_t command,
                                      uint32_t value)
{
    const bool is_known = command < (uint32_t)BRACE_COMMANDS_COUNT && entries[command].run != NULL;
    return is_known ? entries[command].run(server, app, value) : MODBUS_E_VALUE;
}

static uint32_t storing(const brace_app_t *app)
{
    brace_store_status_t status;
    (void)brace_app_store_status(app, &status);
    const uint32_t outcome = status.state == BRACE_STORE_FAILED ? (uint32_t)(256 + (int)status.failure) : 0u;
    return brace_app_is_storing(app) ? 1u : outcome;
}

void modbus_command_tell(const modbus_server_t *server, const brace_app_t *app, brace_commands_t *told)
{
    *told = server->written;
    told->set_mode = brace_app_mode(app);
    told->commit = told->rollback = storing(app);
    told->clear_faults = brace_app_faults(app);
    told->let_go = 0;
}
