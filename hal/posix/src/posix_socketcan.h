/* The socket of SocketCAN. What it receives goes to the controllers. */
#ifndef POSIX_SOCKETCAN_H
#define POSIX_SOCKETCAN_H

#include "brace_hal_posix.h"

int32_t socketcan_open(brace_posix_bus_t *bus, const char *interface);
void socketcan_poll(brace_posix_bus_t *bus);
void socketcan_send(brace_posix_bus_t *bus, const brace_posix_wire_frame_t *frame);

#endif
