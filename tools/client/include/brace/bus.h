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
    uint8_t length;  /* 0-8 */
    uint8_t data[8];
    uint64_t received_us; /* CLOCK_MONOTONIC; 0 for frames to send */
} brace_bus_frame_t;

typedef struct brace_bus brace_bus_t;

/* Opens a bus within timeout_ms [1, 60 000]. On anything but OK *bus is null and `why`, when not null, gets one line that
 * says what, why and what to try (at most why_room characters with its end). */
brace_bus_status_t brace_bus_open(const char *url, int timeout_ms, brace_bus_t **bus, char *why, unsigned why_room);

/* Closes and frees; null is fine. */
void brace_bus_close(brace_bus_t *bus);

/* Sends one frame; waits at most timeout_ms for room.
 * returns OK, E_USAGE, E_DOWN, E_FULL */
brace_bus_status_t brace_bus_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms);

/* The next frame, of whatever identifier (remote, extended, error and FD frames are passed over).
 * returns OK, E_TIMEOUT, E_DOWN */
brace_bus_status_t brace_bus_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms);

#ifdef __cplusplus
}
#endif
#endif
