/* Modbus TCP: transaction 2 bytes, protocol 2, length 2 (from the unit on), unit 1, PDU; high bytes first (Modbus
 * messaging on TCP/IP 1.0b, 3.1.3). The port hands over whole requests, of its connections in turn, and says whose each
 * one is.
 *
 * All that has come is read in every tick, whichever connection waits for what: a stop is obeyed first, and commands
 * are obeyed and answered at once. Questions wait in a small queue for each connection, and connections are answered in
 * turn. A question that finds its connection's queue full is answered with the exception 06, busy. While one connection
 * waits for its K, the others are answered. */
#ifndef BRACE_WIRE_MODBUS_TCP_H
#define BRACE_WIRE_MODBUS_TCP_H

#include "brace_hal.h"
#include "wire/modbus/link.h"

enum {
    MODBUS_CONNECTIONS = 16,
    MODBUS_QUESTIONS_EACH = 4,
    MODBUS_QUESTION_BYTES = 64 /* the longest question that writes has 53; a longer one is answered at once */
};

/* One connection. */
typedef struct {
    modbus_half_t half; /* of a value; and the connection's number */
    bool is_used;
    uint8_t first, count; /* of its questions */
    struct {
        uint8_t length;
        uint8_t bytes[MODBUS_QUESTION_BYTES];
    } question[MODBUS_QUESTIONS_EACH];
} modbus_connection_t;

typedef struct {
    modbus_link_t link; /* the request that is being read, or answered */
    modbus_connection_t connection[MODBUS_CONNECTIONS];
    uint8_t turn;       /* the connection that was answered last */
    bool waits;         /* a question is being worked out: */
    uint8_t waiting;    /* of this connection */
} modbus_tcp_t;

/* Opens the port, if the board has it. Before the first tick. */
void modbus_tcp_start(modbus_tcp_t *tcp, const brace_hal_t *hal, uint32_t baud);

/* The beginning of a tick: looks at all that has come, at most 8,192 requests, each of at most 3,000 instructions.
 *   done (out): how much it has done is added (wire/wire.h)
 * returns whether there was a stop */
bool modbus_tcp_hear(modbus_tcp_t *tcp, modbus_server_t *server, const wire_tick_t *tick, uint32_t *done);

/* The end of a tick: answers a question of the next connection. At most 1,500 instructions.
 * returns how much it has done (wire/wire.h) */
uint32_t modbus_tcp_answer(modbus_tcp_t *tcp, modbus_server_t *server, const wire_tick_t *tick);

#endif
