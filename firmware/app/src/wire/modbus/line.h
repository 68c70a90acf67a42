/* Modbus RTU: address, PDU and CRC on a serial line (8E1). 3.5 characters of silence end a frame (Modbus over serial
 * line 1.02, 2.5.1). */
#ifndef BRACE_WIRE_MODBUS_LINE_H
#define BRACE_WIRE_MODBUS_LINE_H

#include "brace_hal.h"
#include "wire/modbus/link.h"

enum {
    MODBUS_AHEAD_BYTES = 128,       /* that come while an answer leaves: five ticks at 230,400 baud */
    MODBUS_LINE_QUESTION_BYTES = 64 /* the longest question that is worked out has 47 */
};

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
    uint32_t answer_mark;  /* what distinguishes it from others of its length */
    modbus_half_t half;    /* of a value */
    uint16_t sound;        /* so many bytes were a sound frame in a tick in which none came; 0: none are */
    uint16_t looked;       /* through so many bytes for a stop */
    uint16_t came;         /* so many bytes, in this tick */
    bool has_question;     /* the link holds one, to be answered at the end of this tick, or of one that has room */
    uint8_t asked_count;   /* bytes of the question that is being worked out, without its check; 0: none is */
    uint8_t asked[MODBUS_LINE_QUESTION_BYTES];
    uint8_t ahead_count;   /* what has come while the link holds an answer */
    uint8_t ahead[MODBUS_AHEAD_BYTES];
} modbus_line_t;

/* Opens the port, if the board has it. Before the first tick. */
void modbus_line_start(modbus_line_t *line, const brace_hal_t *hal, uint32_t baud);

/* The beginning of a tick: takes what has come. A stop is obeyed as soon as its bytes are there, also behind or among
 * others' bytes, and while an answer leaves. When silence has ended a command, it is obeyed and its answer begins to
 * leave. At most 900 instructions while bytes come, and 1,500 for a command; 3,400 for a write of 61 parameters.
 *   done (out): how much it has done is added (wire/wire.h)
 * returns whether there was a stop */
bool modbus_line_hear(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, uint32_t *done);

/* Have far more bytes come in this tick than a line carries, from an adapter that gathers them? */
bool modbus_line_has_burst(const modbus_line_t *line);

/* The end of a tick: answers the question that silence has ended, or whose K is there, and the answer begins to leave.
 * Its check is worked out while it leaves, a part in each tick, ahead of the line. A master that sends another request
 * has given up the one before: what waits for its K is forgotten then, and counted. At most 1,500 instructions.
 * returns how much it has done (wire/wire.h) */
uint32_t modbus_line_answer(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, bool has_room);

#endif
