/* What goes out without being asked for, as far as no dictionary is needed: heartbeat and emergency on CAN. */
#ifndef BRACE_APP_ANNOUNCE_H
#define BRACE_APP_ANNOUNCE_H

#include "brace/app.h"

/* Sets the bus up; not for the tick. Without CAN or a bit rate there is none; with node 0 it only listens. */
void announce_start(brace_app_t *app);

/* Bus health and recovery, a heartbeat each second, an emergency for every change of the faults. At most
 * one frame a tick; what the bus refuses is tried again. About 150 instructions when there is something to
 * say, else 50.
 * returns whether a frame was due */
bool announce(brace_app_t *app);

#endif
