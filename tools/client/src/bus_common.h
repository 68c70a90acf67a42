/* What the two kinds of bus share: a file descriptor, text that comes in pieces, the clock, a reason in words. */
#ifndef BRACE_BUS_COMMON_H
#define BRACE_BUS_COMMON_H

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

#endif
