/* What goes out without being asked for and is no process data: heartbeat and emergency on CAN. */
#ifndef BRACE_APP_ANNOUNCE_H
#define BRACE_APP_ANNOUNCE_H

#include "brace/app.h"

/* A heartbeat at controller.heartbeat_hz and at every change of mode, an emergency for every change of the
 * faults. At most one frame a tick; what the bus has no room for is tried again. About 150 instructions when
 * there is something to say, else 30.
 * returns whether a frame was due */
bool announce(brace_app_t *app);

/* Is there anything to say now? About 20 instructions. */
bool announce_wants(const brace_app_t *app);

#endif
