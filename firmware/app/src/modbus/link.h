/* The two ways by which requests come: frames on a serial line (RTU), and ADUs of TCP connections. One request at a
 * time on each; what comes meanwhile waits in the port's own ring. */
#ifndef BRACE_APP_MODBUS_LINK_H
#define BRACE_APP_MODBUS_LINK_H

#include "modbus/pdu.h"

typedef enum {
    LINK_LISTEN = 0, /* gathers a request */
    LINK_CHECK,      /* silence: what has come is to be judged */
    LINK_WORK,       /* a request is whole: its answer is to be made */
    LINK_SEAL,       /* the answer's check is to be made */
    LINK_SEND
} link_phase_t;

enum {
    LINK_READ = 64,    /* bytes taken from a port at a time */
    LINK_PIECE = 16,   /* bytes checked in a tick */
    LINK_SHORT = 16    /* so few are checked beside other work */
};

#define LINK_SEND_US 1000000u /* the longest that a port may take nothing */

/* Forgets the request. */
void link_rest(brace_app_modbus_link_t *link);

/* Sends what the port takes; at the end, or when it takes nothing for LINK_SEND_US, listens again. */
void link_send(brace_app_t *app, brace_app_modbus_link_t *link, brace_serial_port_t port, uint32_t now_us);

/* A frame that is none: counted and forgotten. */
void link_broken(brace_app_t *app, brace_app_modbus_link_t *link);

/* Each tick: gathers what has come, sends what is to go; at most 80 instructions. */
void line_poll(brace_app_t *app, uint32_t now_us);
void tcp_poll(brace_app_t *app, uint32_t now_us);

/* In a tick that has room for it: judges, works, or makes the check; all of these at once of what is short.
 * Instructions: modbus.h */
void line_serve(brace_app_t *app, uint32_t now_us, bool all);
void tcp_serve(brace_app_t *app, uint32_t now_us);

#endif
