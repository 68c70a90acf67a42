/* SLCAN clients. What one sends goes to the controllers, to all other clients and out of the socket. */
#ifndef POSIX_SLCAN_H
#define POSIX_SLCAN_H

#include "brace_hal_posix.h"

void posix_slcan_start(brace_posix_slcan_t *client, int file);
void posix_slcan_poll(brace_posix_bus_t *bus, brace_posix_slcan_t *client);

/* Sends a frame to all clients except one, and out of the socket. sender NULL: to all clients. */
void bus_to_outside(brace_posix_bus_t *bus, const brace_posix_slcan_t *sender, const brace_posix_wire_frame_t *frame);

#endif
