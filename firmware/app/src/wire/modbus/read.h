/* Functions 03 and 04. */
#ifndef BRACE_WIRE_MODBUS_READ_H
#define BRACE_WIRE_MODBUS_READ_H

#include "wire/modbus/protocol.h"
#include "wire/modbus/server.h"
#include "wire/wire.h"

/* Reads up to 125 registers; the answer takes the request's place. Several registers begin with a value's first half:
 * else MODBUS_E_ADDRESS. What is measured is of one snapshot, because all of
 * it comes from the tick's own block.
 *   pdu: room for MODBUS_PDU_BYTES
 *   answer (out): its length [bytes]; untouched when refused
 * At most 700 instructions. */
modbus_exception_t modbus_read(const modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, uint32_t length,
                               uint32_t *answer);

#endif
