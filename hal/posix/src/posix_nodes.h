/* The controllers of the process, as the bus sees them. Knows neither clients nor the socket. */
#ifndef POSIX_NODES_H
#define POSIX_NODES_H

#include "brace_hal_posix.h"

/* Sends a frame to all controllers except one; -1: to all. bit_rate 0: to controllers of any rate. */
void bus_to_nodes(brace_posix_bus_t *bus, int32_t sender, const brace_posix_wire_frame_t *frame, uint32_t bit_rate);

/* Queues a frame that this controller's filter lets through. */
void node_takes(brace_posix_node_t *node, const brace_can_frame_t *frame);

/* The bit rate of the controllers on the bus; 0: no controller is on yet. */
uint32_t bus_bit_rate(const brace_posix_bus_t *bus);

/* Is this a frame that some controller takes before all others? */
bool bus_is_urgent(const brace_posix_bus_t *bus, const brace_posix_wire_frame_t *frame);

#endif
