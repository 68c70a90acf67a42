/* Modbus' functions, whatever carries them (Modbus application protocol 1.1b3): 03, 04, 06, 08, 16, 17, 43/14.
 * Registers as docs/modbus.md lists them.
 *
 * Exceptions: 01 no such function, or not in this mode (the protocol's own use of it: the server is in the wrong
 * state); 02 no such registers; 03 a number that can not be: a count, a length, a value out of its range; 04 it could
 * not be done; 06 a set of parameters is being stored: ask again.
 */
#ifndef BRACE_APP_MODBUS_PDU_H
#define BRACE_APP_MODBUS_PDU_H

#include "brace/app.h"

enum { MODBUS_PDU_BYTES = 253 };

enum {
    MODBUS_READ_HOLDING = 3,
    MODBUS_READ_INPUT = 4,
    MODBUS_WRITE_ONE = 6,
    MODBUS_DIAGNOSE = 8,
    MODBUS_WRITE_BLOCK = 16,
    MODBUS_SERVER_ID = 17,
    MODBUS_DEVICE_ID = 43,
    MODBUS_REFUSED = 0x80
};

typedef enum {
    MODBUS_FINE = 0,
    MODBUS_E_FUNCTION = 1,
    MODBUS_E_ADDRESS = 2,
    MODBUS_E_VALUE = 3,
    MODBUS_E_DEVICE = 4,
    MODBUS_E_BUSY = 6,
    MODBUS_E_TARGET = 11
} modbus_exception_t;

/* One piece of the work on a request; the answer takes the request's place.
 *   pdu: room for MODBUS_PDU_BYTES
 *   length: of the request [1, MODBUS_PDU_BYTES]
 * returns the answer's length, or 0: there is more to do. At most 2,000 instructions; a commit, 21,000. */
uint32_t modbus_pdu_work(brace_app_t *app, brace_app_modbus_work_t *work, uint8_t *pdu, uint32_t length,
                         uint32_t now_us);

/* An exception as the answer; counted. returns its length */
uint32_t modbus_refuse(brace_app_t *app, uint8_t *pdu, modbus_exception_t why);

/* Bytes that a request must have before it can be whole, by what has come of it; 1 when that is not known. */
uint32_t modbus_request_length(const uint8_t *pdu, uint32_t length);

#endif
