/* Functions 03 and 04. */
#ifndef BRACE_APP_MODBUS_READ_H
#define BRACE_APP_MODBUS_READ_H

#include "modbus/pdu.h"

/* What is measured is taken as one block of one snapshot. At most 2,000 instructions, 300 bytes of stack.
 *   answer: its length */
modbus_exception_t modbus_read(const brace_app_t *app, uint8_t *pdu, uint32_t length, uint32_t now_us,
                               uint32_t *answer);

#endif
