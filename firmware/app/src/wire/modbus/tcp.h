/* Modbus TCP: transaction 2 bytes, protocol 2, length 2 (from the unit on), unit 1, PDU; high bytes first (Modbus
 * messaging on TCP/IP 1.0b, 3.1.3). The port hands over whole requests, one after another, and sends an answer to
 * whoever sent the request that was read last. So the next one is not read before the answer has left. */
#ifndef BRACE_WIRE_MODBUS_TCP_H
#define BRACE_WIRE_MODBUS_TCP_H

#include "brace_hal.h"
#include "wire/modbus/link.h"

/* Opens the port, if the board has it. Before the first tick. */
void modbus_tcp_start(modbus_link_t *link, const brace_hal_t *hal, uint32_t baud);

/* One tick: takes a request and answers it; the answer begins to leave in the same tick. At most 3,000 instructions.
 * returns how much it has done (wire/wire.h) */
uint32_t modbus_tcp_tick(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick);

#endif
