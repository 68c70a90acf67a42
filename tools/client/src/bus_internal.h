/* Shared by the two kinds of bus: a file descriptor, and text that comes in pieces. */
#ifndef BRACE_BUS_INTERNAL_H
#define BRACE_BUS_INTERNAL_H

#include <stddef.h>

#include "brace/bus.h"

struct brace_bus {
    int fd;
    bool is_slcan;
    char rate; /* SLCAN: the digit behind 'S' */
    char line[160]; /* SLCAN: the command being received */
    size_t line_length;
    bool line_is_too_long;
    unsigned char chunk[512];
    size_t chunk_at, chunk_end;
    bool has_status; /* SLCAN: the adapter has answered 'F' */
    uint64_t empty_us, chunk_us; /* SLCAN: when the port was last found empty; when the chunk came */
    uint32_t lost, errors, unacknowledged;
};

uint64_t brace_bus_now_us(void);

/* Milliseconds left until deadline_us, rounded up; never negative. */
int brace_bus_left_ms(uint64_t deadline_us);

void brace_bus_say(char *why, unsigned why_room, const char *format, ...) __attribute__((format(printf, 3, 4)));

brace_bus_status_t brace_socketcan_open(brace_bus_t *bus, const char *name, char *why, unsigned why_room);
brace_bus_status_t brace_socketcan_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms);
brace_bus_status_t brace_socketcan_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms);

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
