/* The controller as a Modbus server, on a serial line (RTU) and over TCP. docs/modbus.md lists the registers.
 *
 * The two ports are independent: each takes at most one request a tick and answers it in that tick, whatever comes by
 * the other one or over CAN. */
#ifndef BRACE_WIRE_MODBUS_MODBUS_H
#define BRACE_WIRE_MODBUS_MODBUS_H

#include "brace/parameters.h"
#include "brace/snapshot.h"
#include "brace_hal.h"
#include "wire/modbus/line.h"
#include "wire/modbus/link.h"
#include "wire/modbus/server.h"
#include "wire/wire.h"

typedef struct {
    modbus_server_t server;
    modbus_line_t line;
    modbus_link_t tcp;
} modbus_t;

/* Opens the ports that the board has. Before the first tick. */
void modbus_start(modbus_t *modbus, const brace_hal_t *hal, const brace_parameters_t *parameters);

/* One tick. At most 5,600 instructions, HAL excluded: 61 parameters by each port, of which one finds some staged
 * already.
 * returns how much both have done (wire/wire.h) */
uint32_t modbus_tick(modbus_t *modbus, const wire_tick_t *tick);

#endif
