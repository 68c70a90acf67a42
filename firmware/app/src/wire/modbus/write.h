/* Functions 06 and 16. The two registers of a value belong together: neither is written without the other. */
#ifndef BRACE_WIRE_MODBUS_WRITE_H
#define BRACE_WIRE_MODBUS_WRITE_H

#include "wire/modbus/protocol.h"
#include "wire/modbus/server.h"
#include "wire/wire.h"

/* Function 06. The high register is kept in `half`; the low one has to be its master's next request, and writes
 * the value.
 *   answer (out): its length [bytes]; of no meaning when refused
 * At most what modbus_command_run costs. */
modbus_exception_t modbus_write_one(modbus_server_t *server, modbus_half_t *half, const wire_tick_t *tick, uint8_t *pdu,
                                    uint32_t length, uint32_t *answer);

/* Function 16: parameters, of which all are judged before the first is written; or one command; or the values of one
 * question. Stack: 300 bytes.
 *   answer (out): its length [bytes]; untouched when refused
 * At most 2,800 instructions for 61 parameters, 2,350 if some are staged already; else what modbus_command_run or
 * modbus_ask costs. */
modbus_exception_t modbus_write_block(modbus_server_t *server, const wire_tick_t *tick, uint8_t *pdu, uint32_t length,
                                      uint32_t *answer);

#endif
