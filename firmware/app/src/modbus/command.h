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
    COMMAND_ASKED_THETA2,
    COMMAND_ASKED_TIP_X,
    COMMAND_ASKED_TIP_Z,
    COMMAND_ASKED_KNEE,
    COMMAND_ASKED_DX,
    COMMAND_ASKED_DZ,
    COMMAND_ASKED_LOAD_X,
    COMMAND_ASKED_LOAD_Z,
    COMMAND_ASKED_NORMAL,
    COMMAND_ASKED_FRICTION
};

modbus_exception_t command_run(brace_app_t *app, uint32_t index, uint32_t value);

/* A question: values of commands from COMMAND_ASKED_THETA1 on that belong together, as Modbus has them. The answer is
 * there when this returns. MODBUS_E_VALUE: these are none. At most 1,200 instructions. */
modbus_exception_t command_ask(brace_app_t *app, uint32_t index, uint32_t count, const uint8_t *data);

/* Forgets what was asked. */
void command_ask_nothing(brace_app_t *app);

/* What a command has come to: set_mode the mode; commit and rollback 1 while a set is being stored, 0 once it is in
 * force, else 256 less brace_store_failure_t; clear_faults the faults; take_up what was asked last; let_go 0;
 * what was asked. */
uint32_t command_read(const brace_app_t *app, uint32_t index);

#endif
