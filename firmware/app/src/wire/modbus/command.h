/* Holding registers that do something when written: brace_commands_t. */
#ifndef BRACE_WIRE_MODBUS_COMMAND_H
#define BRACE_WIRE_MODBUS_COMMAND_H

#include <stddef.h>

#include "brace/requests.h"
#include "wire/modbus/protocol.h"
#include "wire/modbus/server.h"

/* A command's number: its place among the values of brace_commands_t. */
#define MODBUS_COMMAND(member) ((uint32_t)(offsetof(brace_commands_t, member) / 4u))

/* Does what a command says. command.c has a function command_<member> for each of BRACE_COMMANDS. Questions are asked
 * by modbus_ask: their values are refused here (MODBUS_E_VALUE).
 * At most what brace_app_parameters_commit_staged costs, 2,000 instructions; all others 300. */
modbus_exception_t modbus_command_run(modbus_server_t *server, brace_app_t *app, uint32_t command,
                                      uint32_t value);

/* What every command has come to. set_mode: the mode; commit and rollback: 1 while a set is being stored, 0 once it is
 * in force, else 256 less brace_store_failure_t; clear_faults: the faults; take_up: the one that began last; let_go: 0;
 * questions: what was answered last. At most 150 instructions. */
void modbus_command_tell(const modbus_server_t *server, const brace_app_t *app, brace_commands_t *told);

#endif
