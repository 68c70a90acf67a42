/* What the parts of the bus share. A frame goes to everybody except its sender. */
#ifndef POSIX_BUS_H
#define POSIX_BUS_H

#include "brace_hal_posix.h"

enum { FROM_SOCKET = -1 };

/* Sends a frame to all controllers except one; -1: to all. bit_rate 0: to controllers of any rate. */
void bus_to_nodes(brace_posix_bus_t *bus, int32_t sender, const brace_posix_wire_frame_t *frame,
                  uint32_t bit_rate);

/* Sends a frame to all clients except one, and out of the socket. */
void bus_to_outside(brace_posix_bus_t *bus, const brace_posix_slcan_t *sender,
                    const brace_posix_wire_frame_t *frame);

/* The bit rate of the controllers on the bus; 0: no controller is on yet. */
uint32_t bus_bit_rate(const brace_posix_bus_t *bus);

/* Is this a frame that some controller takes before all others? */
bool bus_is_urgent(const brace_posix_bus_t *bus, const brace_posix_wire_frame_t *frame);

void posix_slcan_start(brace_posix_slcan_t *client, int file);
void posix_slcan_poll(brace_posix_bus_t *bus, brace_posix_slcan_t *client);
void posix_slcan_frame(const brace_posix_bus_t *bus, brace_posix_slcan_t *client,
                 const brace_posix_wire_frame_t *frame);

int32_t socketcan_open(brace_posix_bus_t *bus, const char *interface);
void socketcan_poll(brace_posix_bus_t *bus);
void socketcan_send(brace_posix_bus_t *bus, const brace_posix_wire_frame_t *frame);

#endif
