/* The controller as a Modbus server, on a serial line (RTU, 8E1) and on TCP: docs/modbus.md lists the registers. Work on a
 * request is done in ticks that compute no K, as requests over CAN are. */
#ifndef BRACE_APP_MODBUS_H
#define BRACE_APP_MODBUS_H

#include "brace/app.h"

/* Opens the ports that the board has; not for the tick. */
void modbus_start(brace_app_t *app);

/* Gathers and sends, each tick, the ports in turn; at most 110 instructions.
 * returns how many ticks a request has waited to be worked on; 0: none does */
uint32_t modbus_poll(brace_app_t *app, uint32_t now_us);

/* Works on what waits, at most 2,200 instructions; a commit, in CONFIGURATION only, 21,000. */
void modbus_serve(brace_app_t *app, uint32_t now_us);

#endif
