/* What the controller says when it is asked who answers: function 17, and function 43 with 14. */
#ifndef BRACE_WIRE_MODBUS_IDENTITY_H
#define BRACE_WIRE_MODBUS_IDENTITY_H

#include <stdint.h>

#include "wire/modbus/protocol.h"

/* Function 17: server identity 0xb2, run indicator 0xff, then "Brace 0.1.0 dictionary 1234abcd" as ASCII.
 *   answer (out): its length [bytes]; untouched when refused. At most 300 instructions, as the next. */
modbus_exception_t modbus_server_id(uint8_t *pdu, uint32_t length, uint32_t *answer);

/* Function 43, kind 14: vendor's name, product's code and revision, as a stream or one by one. */
modbus_exception_t modbus_device_id(uint8_t *pdu, uint32_t length, uint32_t *answer);

#endif
