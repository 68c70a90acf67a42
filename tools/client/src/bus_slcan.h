/* A bus behind an SLCAN adapter, on a serial line or over TCP. */
#ifndef BRACE_BUS_SLCAN_H
#define BRACE_BUS_SLCAN_H

#include "bus_common.h"

brace_bus_status_t brace_slcan_open_tty(brace_bus_t *bus, const char *where, char rate, char *why, unsigned why_room);
brace_bus_status_t brace_slcan_open_tcp(brace_bus_t *bus, const char *where, char rate, int timeout_ms, char *why,
                                        unsigned why_room);
bool brace_slcan_rate(uint32_t bit_rate, char *rate); /* the digit behind 'S'; false: there is no such rate */
brace_bus_status_t brace_slcan_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms);
brace_bus_status_t brace_slcan_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms);
void brace_slcan_ask_status(brace_bus_t *bus, int timeout_ms);
/* Opens the channel once more, for an adapter that was still starting and lost the first commands. */
void brace_slcan_enter_again(brace_bus_t *bus);
void brace_slcan_leave(brace_bus_t *bus);

#endif
