/* Commands of an owner. */
#ifndef BRACE_CLIENT_COMMAND_H
#define BRACE_CLIENT_COMMAND_H

#include "client_state.h"

/* A command, for both wires. */
typedef struct {
    brace_question_t question; /* over CAN */
    bool moves;                /* it begins with a sign of life, so it may be sent again until it is answered */
    uint32_t place, values[2], count; /* over Modbus */
} brace_command_t;

/* Sends a command. On a guarded board opens a session before, and again when the controller has ended it. */
brace_client_status_t brace_client_command(brace_client_t *client, brace_command_t *command, uint64_t deadline_us);

/* Opens a session on a guarded board, if none is open. */
brace_client_status_t brace_client_become_owner(brace_client_t *client, uint64_t deadline_us);

#endif
