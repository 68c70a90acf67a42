/* What the Modbus server remembers, whichever port a request comes by. */
#ifndef BRACE_WIRE_MODBUS_SERVER_H
#define BRACE_WIRE_MODBUS_SERVER_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/k_question.h"
#include "brace/measured.h"
#include "brace/who.h"

/* Shared by all ports: what one master asks, another may read. */
typedef struct {
    uint8_t address; /* of the controller on the line, and its unit behind a TCP connection */
    uint16_t messages, broken, refused, served, unanswered, busy; /* function 08's counters; they wrap */
    brace_commands_t written;   /* the take-up that began last, and the questions that were answered last */
    brace_answered_t answered;  /* their answers */
    brace_asker_t asker;        /* the port whose request is being answered */
    brace_who_t who;            /* and its master */
    brace_seal_t *seal;         /* that came before it from that master */
    const uint8_t *pdu;         /* the request */
    uint32_t length;
} modbus_server_t;

/* Function 06 writes a value in two requests, the high register first. Each connection of each port keeps its own first
 * half, so that what another master does is no part of it. */
typedef struct {
    bool is_known;
    uint32_t peer; /* the connection's number */
    uint16_t register_address;
    uint16_t value;
    brace_seal_t seal; /* of this master's next write */
} modbus_half_t;

#endif
