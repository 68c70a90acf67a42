/* Modbus' functions and exceptions that this server knows (Modbus application protocol 1.1b3). */
#ifndef BRACE_WIRE_MODBUS_PROTOCOL_H
#define BRACE_WIRE_MODBUS_PROTOCOL_H

enum { MODBUS_PDU_BYTES = 253 }; /* the largest request and the largest answer, without address and check */

enum {
    MODBUS_READ_HOLDING = 3,
    MODBUS_READ_INPUT = 4,
    MODBUS_WRITE_ONE = 6,
    MODBUS_DIAGNOSE = 8,
    MODBUS_WRITE_BLOCK = 16,
    MODBUS_SERVER_ID = 17,
    MODBUS_DEVICE_ID = 43,
    MODBUS_REFUSED = 0x80 /* added to the function in an exception */
};

typedef enum {
    MODBUS_AGAIN = -1,     /* no exception: it is being worked out, and is asked again in the next tick */
    MODBUS_FINE = 0,
    MODBUS_E_FUNCTION = 1, /* no such function; or not in this mode, which the protocol calls the wrong state */
    MODBUS_E_ADDRESS = 2,  /* no such registers */
    MODBUS_E_VALUE = 3,    /* a count, a length or a value that cannot be */
    MODBUS_E_DEVICE = 4,   /* it could not be done */
    MODBUS_E_BUSY = 6,     /* a set of parameters is being stored, or too many questions wait: ask again */
    MODBUS_E_OWNER = 7,    /* negative acknowledge: the limb is another's to move, or there is no proof that it is
                              yours; last_refusal reports which */
    MODBUS_E_TARGET = 11   /* no such unit behind this TCP connection */
} modbus_exception_t;

#endif
