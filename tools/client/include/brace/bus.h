/* A CAN bus as a host reaches it: SocketCAN, or SLCAN (LAWICEL text) over TCP or a serial device.
 *
 *   can0                       a SocketCAN interface (Linux)
 *   slcan:/dev/ttyACM0[@baud]  an SLCAN adapter or a controller's own SLCAN port; default 115200
 *   tcp://host:port            SLCAN over TCP
 *
 * One caller per bus. Every call ends within its time-out; nothing waits for ever.
 */
#ifndef BRACE_BUS_H
#define BRACE_BUS_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    BRACE_BUS_OK = 0,
    BRACE_BUS_E_USAGE = -1,       /* the URL cannot be read, or the frame is not valid */
    BRACE_BUS_E_NO_DEVICE = -2,   /* there is no such interface, device, host or port; `why` says more */
    BRACE_BUS_E_NO_KERNEL = -3,   /* this kernel has no CAN (SocketCAN) */
    BRACE_BUS_E_DOWN = -4,        /* the interface exists but is not up, or the connection was closed */
    BRACE_BUS_E_TIMEOUT = -5,
    BRACE_BUS_E_FULL = -6         /* the bus accepts no more: nobody acknowledges, or it is overloaded */
} brace_bus_status_t;

typedef struct {
    uint32_t id;     /* 11 bits */
    uint8_t length;  /* 0-8; up to 64 in a CAN FD frame */
    bool fd;         /* a CAN FD frame; only received */
    uint8_t data[64];
    uint64_t received_us; /* CLOCK_MONOTONIC; the kernel's time stamp where there is one; 0 in frames to send */
} brace_bus_frame_t;

typedef struct brace_bus brace_bus_t;

/* Opens a bus within timeout_ms [1, 60 000]. bit_rate [bit/s]: 10 000, 20 000, 50 000, 100 000, 125 000, 250 000,
 * 500 000, 800 000 or 1 000 000, or 0 for that; others are E_USAGE. It is set on an SLCAN adapter. A SocketCAN
 * interface keeps the rate that the system has set. On anything but OK *bus is null, and `why`, when not null, gets one
 * line that says what, why and what to try (at most why_room characters with its end). */
brace_bus_status_t brace_bus_open(const char *url, uint32_t bit_rate, int timeout_ms, brace_bus_t **bus, char *why,
                                  unsigned why_room);

/* Closes the bus and frees it; null is allowed. */
void brace_bus_close(brace_bus_t *bus);

/* Sends one frame, and waits at most timeout_ms for room.
 * returns OK, E_USAGE, E_DOWN, E_FULL */
brace_bus_status_t brace_bus_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms);

/* Gives the next data frame with an 11-bit identifier. It skips remote, extended and error frames. It waits at most
 * timeout_ms, however many frames it skips; on SocketCAN it returns E_TIMEOUT after 4,096 skipped ones, too.
 * returns OK, E_TIMEOUT, E_DOWN */
brace_bus_status_t brace_bus_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms);

/* How many frames this computer is known to have lost since the bus was opened, because its queue was full or a line of
 * SLCAN was broken. The count includes a loss before the frame that follows it is received. */
uint32_t brace_bus_lost(const brace_bus_t *bus);

/* How many errors of the bus the interface has reported (a wrong bit rate causes them). An SLCAN adapter is asked, and
 * may take timeout_ms to answer; frames received in this time are dropped. */
uint32_t brace_bus_errors(brace_bus_t *bus, int timeout_ms);

#ifdef __cplusplus
}
#endif
#endif
