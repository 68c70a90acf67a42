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
    BRACE_BUS_E_USAGE = -1,       /* a URL that can not be read, a frame that is none */
    BRACE_BUS_E_NO_DEVICE = -2,   /* no such interface, device, host or port; brace_bus_why tells */
    BRACE_BUS_E_NO_KERNEL = -3,   /* this kernel has no CAN (SocketCAN) */
    BRACE_BUS_E_DOWN = -4,        /* the interface is there and not up; the connection was closed */
    BRACE_BUS_E_TIMEOUT = -5,
    BRACE_BUS_E_FULL = -6         /* the bus takes no more: nobody acknowledges, or it is overloaded */
} brace_bus_status_t;

typedef struct {
    uint32_t id;     /* 11 bits */
    uint8_t length;  /* 0-8; of CAN FD up to 64 */
    bool fd;         /* a frame of CAN FD; received only */
    uint8_t data[64];
    uint64_t received_us; /* CLOCK_MONOTONIC, the kernel's stamp where it gives one; 0 for frames to send */
} brace_bus_frame_t;

typedef struct brace_bus brace_bus_t;

/* Opens a bus within timeout_ms [1, 60 000]. bit_rate [bit/s] is set on an SLCAN adapter (10 000 to 1 000 000 as it
 * knows them; 0: 1 000 000); a SocketCAN interface has the system's. On anything but OK *bus is null and `why`, when
 * not null, gets one line that says what, why and what to try (at most why_room characters with its end). */
brace_bus_status_t brace_bus_open(const char *url, uint32_t bit_rate, int timeout_ms, brace_bus_t **bus, char *why,
                                  unsigned why_room);

/* Closes and frees; null is fine. */
void brace_bus_close(brace_bus_t *bus);

/* Sends one frame; waits at most timeout_ms for room.
 * returns OK, E_USAGE, E_DOWN, E_FULL */
brace_bus_status_t brace_bus_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms);

/* The next frame, of whatever identifier (remote, extended and error frames are passed over); waits at most timeout_ms,
 * however much comes that is passed over.
 * returns OK, E_TIMEOUT, E_DOWN */
brace_bus_status_t brace_bus_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms);

/* Frames that are known to have been lost on this computer since the bus was opened: its queue was full, or a line of
 * SLCAN was broken. Counts before the frame that was received after the loss. */
uint32_t brace_bus_lost(const brace_bus_t *bus);

/* Errors of the bus that its interface has told of (a wrong bit rate gives them). An SLCAN adapter is asked, and
 * answers within timeout_ms or not at all; frames received meanwhile are dropped. */
uint32_t brace_bus_errors(brace_bus_t *bus, int timeout_ms);

#ifdef __cplusplus
}
#endif
#endif
