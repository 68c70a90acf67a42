/* The bus as a whole: opened, polled, closed, and its entries of the door. */
#include <string.h>

#include "posix_door.h"
#include "posix_io.h"
#include "posix_nodes.h"
#include "posix_slcan.h"
#include "posix_socketcan.h"

/* ------------------------------------------------------------------------------------ opening, polling -- */

static int32_t open_line(brace_posix_bus_t *bus, const char *place)
{
    int file = -1;
    const int32_t status =
        strcmp(place, "pty") == 0 ? io_pty(&file, &bus->kept, bus->where) : io_tty(place, &file, bus->where);
    if (status == BRACE_POSIX_OK) {
        posix_slcan_start(&bus->client[0], file);
    }
    return status;
}

int32_t brace_posix_bus_open(brace_posix_bus_t *bus, const char *url)
{
    memset(bus, 0, sizeof *bus);
    bus->listener = bus->kept = bus->socket_can = -1;
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        bus->client[i].file = -1;
    }
    int32_t status = BRACE_POSIX_OK;
    if (strcmp(url, "none") == 0) {
        bus->kind = BRACE_POSIX_BUS_NONE;
    } else if (strncmp(url, "tcp://", 6) == 0) {
        bus->kind = BRACE_POSIX_BUS_TCP;
        status = io_listen("tcp", url + 6, &bus->listener, bus->where);
    } else if (strncmp(url, "slcan:", 6) == 0) {
        bus->kind = BRACE_POSIX_BUS_LINE;
        status = open_line(bus, url + 6);
    } else {
        bus->kind = BRACE_POSIX_BUS_SOCKETCAN;
        status = socketcan_open(bus, url);
    }
    if (status != BRACE_POSIX_OK) {
        bus->kind = BRACE_POSIX_BUS_NONE;
    }
    return status;
}

void brace_posix_bus_close(brace_posix_bus_t *bus)
{
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        io_close(&bus->client[i].file);
    }
    io_close(&bus->listener);
    io_close(&bus->kept);
    io_close(&bus->socket_can);
    bus->kind = BRACE_POSIX_BUS_NONE;
}

static void accept_client(brace_posix_bus_t *bus)
{
    int file = io_accept(bus->listener);
    for (uint32_t i = 0; file >= 0 && i < BRACE_POSIX_CLIENTS; i++) {
        if (bus->client[i].file < 0) {
            posix_slcan_start(&bus->client[i], file);
            return;
        }
    }
    io_close(&file);
}

void brace_posix_bus_poll(brace_posix_bus_t *bus, uint32_t now_us)
{
    bus->milliseconds = now_us / 1000u;
    accept_client(bus);
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        if (bus->client[i].file >= 0) {
            posix_slcan_poll(bus, &bus->client[i]);
        }
    }
    if (bus->socket_can >= 0) {
        socketcan_poll(bus);
    }
}

uint32_t brace_posix_bus_clients(const brace_posix_bus_t *bus)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < BRACE_POSIX_CLIENTS; i++) {
        count += bus->client[i].file >= 0 && bus->client[i].open;
    }
    return count;
}

/* ------------------------------------------------------------------------------------------ controllers --
 */

static brace_posix_node_t *node_of(void *context)
{
    brace_posix_t *posix = context;
    return &posix->bus->node[posix->node];
}

int32_t door_can_setup(void *context, const brace_can_setup_t *setup)
{
    const brace_posix_bus_t *bus = ((brace_posix_t *)context)->bus;
    brace_posix_node_t *node = node_of(context);
    if (setup->bit_rate != 125000u && setup->bit_rate != 250000u && setup->bit_rate != 500000u &&
        setup->bit_rate != 1000000u) {
        return BRACE_HAL_E_RANGE;
    }
    if (setup->fd_bit_rate != 0u && bus->kind == BRACE_POSIX_BUS_SOCKETCAN && !bus->socket_can_fd) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    node->setup = *setup;
    node->on = true;
    node->bus_off = node->fault_bus_off;
    node->start = node->count = 0u;
    node->has_urgent = false;
    return BRACE_HAL_OK;
}

static bool is_frame(const brace_can_frame_t *frame)
{
    if (frame->id > 0x7ffu) {
        return false;
    }
    if (frame->length <= 8u) {
        return true;
    }
    return frame->fd && frame->length <= 64u &&
           (frame->length <= 24u ? frame->length % 4u == 0u : frame->length % 16u == 0u);
}

int32_t door_can_send(void *context, const brace_can_frame_t *frame)
{
    brace_posix_t *posix = context;
    brace_posix_node_t *node = node_of(context);
    if (!is_frame(frame)) {
        return BRACE_HAL_E_RANGE;
    }
    if (!node->on || node->setup.listen_only || (frame->fd && node->setup.fd_bit_rate == 0u)) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    node->bus_off |= node->fault_bus_off;
    if (node->bus_off) {
        return BRACE_HAL_E_BUS_OFF;
    }
    node->sent++;
    if (node->setup.loopback) {
        node_takes(node, frame);
        return BRACE_HAL_OK;
    }
    const brace_posix_wire_frame_t wire = {*frame, false, false};
    bus_to_nodes(posix->bus, (int32_t)posix->node, &wire, node->setup.bit_rate);
    bus_to_outside(posix->bus, NULL, &wire);
    return BRACE_HAL_OK;
}

int32_t door_can_receive(void *context, brace_can_frame_t *frame)
{
    brace_posix_node_t *node = node_of(context);
    if (node->has_urgent) {
        *frame = node->urgent;
        node->has_urgent = false;
        return 1;
    }
    if (node->count == 0u) {
        return 0;
    }
    *frame = node->ring[node->start];
    node->start = (node->start + 1u) % BRACE_POSIX_RING;
    node->count--;
    return 1;
}

int32_t door_can_health(void *context, brace_can_health_t *health)
{
    brace_posix_node_t *node = node_of(context);
    node->bus_off |= node->on && node->fault_bus_off;
    *health = (brace_can_health_t){.tx_errors = node->bus_off ? 255u : 0u,
                                   .error_passive = node->bus_off,
                                   .bus_off = node->bus_off,
                                   .frames_lost = node->frames_lost};
    return BRACE_HAL_OK;
}

int32_t door_can_recover(void *context)
{
    brace_posix_node_t *node = node_of(context);
    node->bus_off = node->fault_bus_off;
    return BRACE_HAL_OK;
}
