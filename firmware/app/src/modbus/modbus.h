/* The controller as a Modbus server, on a serial line (RTU, 8E1) and on TCP: docs/modbus.md lists the registers. Work
 * on a request is done in pieces, one a tick at most (report/services.h). */
#ifndef BRACE_APP_MODBUS_H
#define BRACE_APP_MODBUS_H

#include "brace/app.h"

/* Without a turn for so long, Modbus has one beside an answer, if there is room, and in CONFIGURATION text over SLCAN
 * waits for it; then it has one in a tick that senses nothing. */
enum { MODBUS_PATIENCE_TICKS = 8, MODBUS_LONGEST_TICKS = 16 };

/* Opens the ports that the board has; not for the tick. */
void modbus_start(brace_app_t *app);

/* Gathers and sends, the ports in turn; at most 110 instructions.
 * returns whether a request waits to be worked on */
bool modbus_poll(brace_app_t *app, uint32_t now_us);

/* Works on what waits: the next step, or all of a short request's at once. Instructions at most,
 * in CONFIGURATION 2,200. */
enum { MODBUS_CHECK_COSTS = 240, MODBUS_READ_COSTS = 740, MODBUS_ASK_COSTS = 1080, MODBUS_ALL_COSTS = 1260 };
void modbus_serve(brace_app_t *app, uint32_t now_us, bool all);

/* What the next step costs at most; 0: nothing waits. */
uint32_t modbus_costs(const brace_app_t *app);

#endif
