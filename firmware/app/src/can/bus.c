#include "can/bus.h"

#include <string.h>

#include "can/slcan.h"

#define HEALTH_US 10000u
#define RECOVER_FIRST_US 125000u
#define RECOVER_MOST_US 2000000u

void bus_start(brace_app_t *app)
{
    const brace_hal_t *hal = app->hal;
    const brace_controller_t *controller = &app->parameters.controller;
    brace_app_bus_t *bus = &app->bus;
    *bus = (brace_app_bus_t){.node_id = (uint8_t)controller->node_id,
                             .bit_rate = controller->can_bit_rate,
                             .recover_wait_us = RECOVER_FIRST_US};
    slcan_port_start(app);
    if (hal->can_setup != NULL && hal->can_send != NULL && hal->can_receive != NULL &&
        hal->can_health != NULL && hal->can_recover != NULL) {
        brace_can_setup_t setup = {.bit_rate = controller->can_bit_rate,
                                   .fd_bit_rate = controller->can_fd_bit_rate,
                                   .listen_only = controller->node_id == 0u};
        const bool fd = setup.fd_bit_rate != 0u && hal->can_setup(hal->context, &setup) == BRACE_HAL_OK;
        bus->fd_bit_rate = fd ? setup.fd_bit_rate : 0u;
        setup.fd_bit_rate = 0; /* where there is none: classic frames rather than silence */
        bus->listens = fd || hal->can_setup(hal->context, &setup) == BRACE_HAL_OK;
    }
    bus->speaks =
        controller->node_id >= 1u && controller->node_id <= 127u && (bus->listens || bus->slcan.fitted);
}

void bus_watch(brace_app_t *app)
{
    brace_app_bus_t *bus = &app->bus;
    brace_can_health_t health;
    if (!bus->listens) {
        return;
    }
    bus->health_us += app->tick_us;
    if (bus->health_us >= HEALTH_US) {
        bus->health_us = 0;
        if (app->hal->can_health(app->hal->context, &health) == BRACE_HAL_OK) {
            bus->bus_off = health.bus_off;
            if (!health.bus_off && health.tx_errors == 0u) {
                bus->recover_wait_us = RECOVER_FIRST_US; /* it has sent since: the way back was one */
            }
        }
    }
    bus->recover_us = bus->bus_off ? bus->recover_us + app->tick_us : 0u;
    if (bus->recover_us >= bus->recover_wait_us) {
        bus->recover_us = 0;
        bus->recover_wait_us =
            bus->recover_wait_us < RECOVER_MOST_US / 2u ? 2u * bus->recover_wait_us : RECOVER_MOST_US;
        (void)app->hal->can_recover(app->hal->context);
    }
}

bool bus_speaks(const brace_app_t *app)
{
    const brace_app_bus_t *bus = &app->bus;
    return bus->speaks && ((bus->listens && !bus->bus_off) || bus->slcan.open);
}

static int32_t send_can(brace_app_t *app, const brace_can_frame_t *frame)
{
    const int32_t answer = app->hal->can_send(app->hal->context, frame);
    if (answer != BRACE_HAL_OK && answer != BRACE_HAL_AGAIN) {
        app->counters.frames_refused += app->counters.frames_refused < UINT32_MAX;
        app->bus.bus_off = app->bus.bus_off || answer == BRACE_HAL_E_BUS_OFF;
    }
    return answer;
}

static bool is_ours(const brace_app_bus_t *bus)
{
    return bus->listens && bus->node_id != 0u && !bus->bus_off;
}

/* As text; and over CAN, where there is one, whatever comes of it. */
static bool send_text(brace_app_t *app, const brace_can_frame_t *frame)
{
    if (!slcan_port_send(app, frame)) {
        return false;
    }
    if (is_ours(&app->bus)) {
        (void)send_can(app, frame);
    }
    return true;
}

uint32_t bus_send_some(brace_app_t *app, uint32_t function, const uint8_t (*data)[8], uint32_t count)
{
    const brace_app_bus_t *bus = &app->bus;
    brace_can_frame_t frame;
    uint32_t sent = 0;
    if (!bus->slcan.open && !is_ours(bus)) {
        return 0;
    }
    frame.id = function + bus->node_id;
    frame.length = 8;
    frame.fd = false;
    for (; sent < count; sent++) { /* at most BRACE_APP_ANSWERS */
        memcpy(frame.data, data[sent], 8);
        if (bus->slcan.open ? !send_text(app, &frame) : send_can(app, &frame) != BRACE_HAL_OK) {
            return sent;
        }
    }
    return sent;
}

bool bus_send(brace_app_t *app, uint32_t function, const uint8_t data[8])
{
    return bus_send_some(app, function, (const uint8_t(*)[8])data, 1) == 1u;
}

bool bus_takes_fd(const brace_app_t *app)
{
    return app->bus.fd_bit_rate != 0u && !app->bus.slcan.open;
}

bool bus_send_fd(brace_app_t *app, uint32_t function, const uint8_t data[64])
{
    const brace_app_bus_t *bus = &app->bus;
    brace_can_frame_t frame;
    if (!is_ours(bus)) {
        return false;
    }
    frame.id = function + bus->node_id;
    frame.length = 64;
    frame.fd = true;
    memcpy(frame.data, data, 64);
    return send_can(app, &frame) == BRACE_HAL_OK;
}

bool bus_receive(brace_app_t *app, brace_can_frame_t *frame)
{
    return app->bus.listens && app->hal->can_receive(app->hal->context, frame) == 1;
}
