/* Modbus RTU: address, PDU and CRC on a serial line (8E1). 3.5 characters of silence end a frame (Modbus over serial
 * line 1.02, 2.5.1). */
#ifndef BRACE_WIRE_MODBUS_LINE_H
#define BRACE_WIRE_MODBUS_LINE_H

#include "brace_hal.h"
#include "wire/modbus/link.h"

/* A receiver that hears its own controller gives each answer back once. The answer to function 06 or 08 has the bytes
 * of its request, so it would be answered again, without end. What comes behind any other answer shows whether the line
 * has an echo. Until that is known, the first frame equal to the answer before it counts as that answer come back. */
typedef enum { MODBUS_ECHO_UNKNOWN, MODBUS_ECHO, MODBUS_NO_ECHO } modbus_echo_t;

typedef struct {
    modbus_link_t link;
    uint16_t crc;         /* of the first bytes that have come, or of the answer */
    uint16_t checked;     /* so many */
    uint32_t silence_us;  /* that ends a frame */
    uint32_t bytes_per_ms; /* at most, that the line carries */
    modbus_echo_t echo;
    uint16_t answer_bytes; /* of the answer that left last; 0: another frame has come since */
    uint32_t answer_mark;  /* what tells it from others of its length */
} modbus_line_t;

/* Opens the port, if the board has it. Before the first tick. */
void modbus_line_start(modbus_line_t *line, const brace_hal_t *hal, uint32_t baud);

/* One tick: takes what has come; or, when silence has ended a request, answers it, and the answer begins to leave in
 * the same tick. The check of an answer is worked out while it leaves, a part in each tick, ahead of the line. At most
 * 900 instructions while bytes come, and 1,500 for an answer; 3,400 for one to a write of 61 parameters.
 * returns how much it has done (wire/wire.h) */
uint32_t modbus_line_tick(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick);

#endif
