/* A port with one request at a time: it comes, is worked on in the tick that finds it whole, and its answer leaves.
 * What else comes meanwhile waits in the port's own buffer. */
#ifndef BRACE_WIRE_MODBUS_LINK_H
#define BRACE_WIRE_MODBUS_LINK_H

#include "wire/modbus/server.h"
#include "wire/wire.h"

enum { MODBUS_LINK_BYTES = 260 }; /* the longest: a PDU behind the header of TCP */

typedef struct {
    bool is_fitted;    /* the board has this port */
    bool is_sending;   /* bytes hold an answer; else a request that is coming */
    bool is_skipping;  /* what is coming is none: all of it is thrown away */
    uint16_t count;    /* bytes of it */
    uint16_t ready;    /* of an answer, so many of its bytes may leave */
    uint16_t sent;     /* of an answer, by the port */
    uint32_t active_us; /* when bytes last came or left */
    uint8_t bytes[MODBUS_LINK_BYTES];
} modbus_link_t;

/* Forgets what is in the buffer: the next byte begins a request. */
void modbus_link_rest(modbus_link_t *link);

/* Takes what has come, behind what is there already; at most `room` bytes. returns how many. */
uint32_t modbus_link_receive(modbus_link_t *link, const wire_tick_t *tick, brace_serial_port_t port, uint32_t room);

/* Forgets what is in the buffer and counts it as a broken frame. */
void modbus_link_break(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick);

/* The buffer holds an answer of so many bytes from here on; all of them are ready. */
void modbus_link_answer(modbus_link_t *link, const wire_tick_t *tick, uint32_t count);

/* Gives the port as many bytes of the answer as it takes. The link becomes idle when the whole answer is sent, and also
 * when the port has taken no byte for a second: then the master that asked has gone. */
void modbus_link_send(modbus_link_t *link, const wire_tick_t *tick, brace_serial_port_t port);

#endif
