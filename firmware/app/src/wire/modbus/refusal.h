/* The one rule by which what the controller refuses becomes a Modbus exception. */
#ifndef BRACE_WIRE_MODBUS_REFUSAL_H
#define BRACE_WIRE_MODBUS_REFUSAL_H

#include "wire/answers/answer.h"
#include "wire/modbus/protocol.h"

/* status: a brace_status_t, or what an answer says (wire/answers/answer.h).
 * BRACE_E_MODE: not in this mode (01). A number that is not finite, out of its range, or a place out of reach: a value
 * that cannot be (03). A set that is being stored is no lasting refusal, so it is BUSY (06). Everything else: it could
 * not be done (04). */
modbus_exception_t modbus_refusal_of(int32_t status);

/* Why parameters may not be written now. Asking keeps CONFIGURATION going. */
modbus_exception_t modbus_refusal_to_write(brace_app_t *app);

#endif
