/* Holding registers that do something when written: brace_commands_t. */
#ifndef BRACE_WIRE_MODBUS_COMMAND_H
#define BRACE_WIRE_MODBUS_COMMAND_H

#include "wire/answers/answer.h"
#include "wire/modbus/protocol.h"
#include "wire/modbus/server.h"
#include "wire/wire.h"

/* Does what a command says.
 *   command: its place among the values of brace_commands_t; the values of questions are refused here (MODBUS_E_VALUE),
 *     modbus_ask asks them
 * At most what brace_app_parameters_commit_staged costs, 2,000 instructions; all others 300. */
modbus_exception_t modbus_command_run(modbus_server_t *server, const wire_tick_t *tick, uint32_t command,
                                      uint32_t value);

/* Do these values show who commands? Then modbus_command_show takes them: a sign of life, or the seal of this master's
 * next write. At most 650 instructions. */
bool modbus_command_shows(uint32_t first, uint32_t count);
modbus_exception_t modbus_command_show(modbus_server_t *server, const wire_tick_t *tick, uint32_t first,
                                       const uint32_t words[2]);

/* The request that is being answered, for whoever answers it. */
request_t modbus_request(const modbus_server_t *server, const wire_tick_t *tick);

/* What every command has come to. set_mode: the mode; commit and rollback: 1 while a set is being stored, 0 once it is
 * in force, else 256 less brace_store_failure_t; clear_faults: the faults; take_up: the one that began last; let_go: 0;
 * questions: what was answered last. At most 150 instructions. */
void modbus_command_report(const modbus_server_t *server, const brace_app_t *app, brace_commands_t *reported);

#endif
