/* A bus of the system: SocketCAN. */
#ifndef BRACE_BUS_SOCKETCAN_H
#define BRACE_BUS_SOCKETCAN_H

#include "bus_common.h"

brace_bus_status_t brace_socketcan_open(brace_bus_t *bus, const char *name, char *why, unsigned why_room);
brace_bus_status_t brace_socketcan_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms);
brace_bus_status_t brace_socketcan_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms);

#endif
