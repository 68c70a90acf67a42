/* Functions 06 and 16. A block is written whole or not at all; a value's two registers belong together: function 06
 * holds the high one back until the low one follows it on the same port. */
#ifndef BRACE_APP_MODBUS_WRITE_H
#define BRACE_APP_MODBUS_WRITE_H

#include "modbus/pdu.h"

modbus_exception_t modbus_write_one(brace_app_t *app, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                                    uint32_t *answer);

/* A piece of it. answer: its length once it is done, else 0 */
modbus_exception_t modbus_write_block(brace_app_t *app, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                                      uint32_t *answer);

#endif
