/* The controller as a Modbus server, on a serial line (RTU) and over TCP. docs/modbus.md lists the registers.
 *
 * The two ports are independent. Each looks at all that has come before anything else in a tick: a stop is obeyed at
 * once, commands go before questions, and each port answers one question a tick. */
#ifndef BRACE_WIRE_MODBUS_MODBUS_H
#define BRACE_WIRE_MODBUS_MODBUS_H

#include "brace/parameters.h"
#include "brace/snapshot.h"
#include "brace_hal.h"
#include "wire/modbus/line.h"
#include "wire/modbus/link.h"
#include "wire/modbus/server.h"
#include "wire/modbus/tcp.h"
#include "wire/wire.h"

typedef struct {
    modbus_server_t server;
    modbus_line_t line;
    modbus_tcp_t tcp;
} modbus_t;

/* Opens the ports that the board has. Before the first tick. */
void modbus_start(modbus_t *modbus, const brace_hal_t *hal, const brace_parameters_t *parameters);

/* The beginning of a tick: obeys stops and commands. At most 5,600 instructions, HAL excluded: 61 parameters by each
 * port, of which one finds some staged already.
 *   done (out): how much both have done is added (wire/wire.h)
 * returns whether there was a stop */
bool modbus_hear(modbus_t *modbus, const wire_tick_t *tick, uint32_t *done);

/* The end of a tick: answers a question of each port. At most 3,000 instructions.
 *   has_room: questions may be answered; else they wait
 * returns how much both have done (wire/wire.h) */
uint32_t modbus_answer(modbus_t *modbus, const wire_tick_t *tick, bool has_room);

#endif
