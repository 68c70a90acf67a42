/* A bus by its URL: opened, sent to, received from, closed. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bus_slcan.h"
#include "bus_socketcan.h"

brace_bus_status_t brace_bus_open(const char *url, uint32_t bit_rate, int timeout_ms, brace_bus_t **bus, char *why,
                                  unsigned why_room)
{
    char rate;
    if (bus == NULL) {
        return BRACE_BUS_E_USAGE;
    }
    *bus = NULL;
    if (url == NULL || url[0] == '\0' || timeout_ms < 1 || timeout_ms > 60000) {
        brace_bus_say(why, why_room, "no bus named; try can0, slcan:/dev/ttyACM0 or tcp://127.0.0.1:29536");
        return BRACE_BUS_E_USAGE;
    }
    if (!brace_slcan_rate(bit_rate, &rate)) {
        brace_bus_say(why, why_room,
                      "%u bit/s is no rate that SLCAN adapters know; try 1000000, 500000, 250000 or 125000",
                      (unsigned)bit_rate);
        return BRACE_BUS_E_USAGE;
    }
    brace_bus_t *opened = calloc(1, sizeof *opened);
    if (opened == NULL) {
        brace_bus_say(why, why_room, "out of memory");
        return BRACE_BUS_E_NO_DEVICE;
    }
    opened->fd = -1;
    brace_bus_status_t status;
    if (strncmp(url, "slcan:", 6) == 0) {
        status = brace_slcan_open_tty(opened, url + 6, rate, why, why_room);
    } else if (strncmp(url, "tcp://", 6) == 0) {
        status = brace_slcan_open_tcp(opened, url + 6, rate, timeout_ms, why, why_room);
    } else if (strchr(url, ':') == NULL && strchr(url, '/') == NULL) {
        status = brace_socketcan_open(opened, url, why, why_room);
    } else {
        brace_bus_say(why, why_room,
                      "%s: not a bus that is known here; try can0, slcan:/dev/ttyACM0 or tcp://host:port", url);
        status = BRACE_BUS_E_USAGE;
    }
    if (status != BRACE_BUS_OK) {
        brace_bus_close(opened);
        return status;
    }
    *bus = opened;
    return BRACE_BUS_OK;
}

void brace_bus_close(brace_bus_t *bus)
{
    if (bus == NULL) {
        return;
    }
    if (bus->fd >= 0) {
        if (bus->is_slcan) {
            brace_slcan_leave(bus);
        }
        close(bus->fd);
    }
    free(bus);
}

brace_bus_status_t brace_bus_send(brace_bus_t *bus, const brace_bus_frame_t *frame, int timeout_ms)
{
    if (bus == NULL || frame == NULL || frame->id > 0x7ffu || frame->length > 8u) {
        return BRACE_BUS_E_USAGE;
    }
    return bus->is_slcan ? brace_slcan_send(bus, frame, timeout_ms) : brace_socketcan_send(bus, frame, timeout_ms);
}

brace_bus_status_t brace_bus_receive(brace_bus_t *bus, brace_bus_frame_t *frame, int timeout_ms)
{
    if (bus == NULL || frame == NULL) {
        return BRACE_BUS_E_USAGE;
    }
    return bus->is_slcan ? brace_slcan_receive(bus, frame, timeout_ms)
                         : brace_socketcan_receive(bus, frame, timeout_ms);
}

uint32_t brace_bus_lost(const brace_bus_t *bus)
{
    return bus == NULL ? 0u : bus->lost;
}

uint32_t brace_bus_errors(brace_bus_t *bus, int timeout_ms)
{
    if (bus == NULL) {
        return 0u;
    }
    if (bus->is_slcan) {
        brace_slcan_ask_status(bus, timeout_ms);
    }
    return bus->errors;
}
