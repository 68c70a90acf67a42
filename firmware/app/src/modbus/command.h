/* Holding registers that do something when written. */
#ifndef BRACE_APP_MODBUS_COMMAND_H
#define BRACE_APP_MODBUS_COMMAND_H

#include "modbus/pdu.h"

/* As in brace_commands_t. */
enum {
    COMMAND_SET_MODE = 0,
    COMMAND_COMMIT,
    COMMAND_ROLLBACK,
    COMMAND_CLEAR_FAULTS,
    COMMAND_TAKE_UP,
    COMMAND_LET_GO,
    COMMAND_ASKED_THETA1,
    COMMAND_ASKED_THETA2
};

modbus_exception_t command_run(brace_app_t *app, uint32_t index, uint32_t value);

/* A posture to know K at: the floats' bits. The answer is there when this returns. */
modbus_exception_t command_ask(brace_app_t *app, uint32_t theta1, uint32_t theta2);

/* Forgets what was asked. */
void command_ask_nothing(brace_app_t *app);

/* What a command has come to: set_mode the mode; commit and rollback 1 while a set is being stored, 0 once it is in force,
 * else 256 less brace_store_failure_t; clear_faults the faults; take_up what was asked last; let_go 0; the angles asked. */
uint32_t command_read(const brace_app_t *app, uint32_t index);

#endif
