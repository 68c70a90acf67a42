#include "wire/can/bus.h"

#define HEALTH_US 10000u
#define RECOVER_FIRST_US 125000u
#define RECOVER_MOST_US 2000000u

void can_bus_start(can_bus_t *bus, const brace_hal_t *hal, const brace_controller_t *parameters)
{
    *bus = (can_bus_t){.recover_wait_us = RECOVER_FIRST_US};
    if (hal->can_setup == NULL || hal->can_send == NULL || hal->can_receive == NULL || hal->can_health == NULL ||
        hal->can_recover == NULL) {
        return;
    }
    brace_can_setup_t setup = {.bit_rate = parameters->can_bit_rate,
                               .fd_bit_rate = parameters->can_fd_bit_rate,
                               .listen_only = parameters->node_id == 0u};
    if (setup.fd_bit_rate != 0u && hal->can_setup(hal->context, &setup) == BRACE_HAL_OK) {
        bus->is_there = true;
        bus->fd_bit_rate = setup.fd_bit_rate;
        return;
    }
    setup.fd_bit_rate = 0; /* classic frames rather than silence */
    bus->is_there = hal->can_setup(hal->context, &setup) == BRACE_HAL_OK;
}

static void ask_health(can_bus_t *bus, const brace_hal_t *hal)
{
    brace_can_health_t health;
    if (hal->can_health(hal->context, &health) != BRACE_HAL_OK) {
        return;
    }
    bus->is_off = health.bus_off;
    if (!health.bus_off && health.tx_errors == 0u) {
        bus->recover_wait_us = RECOVER_FIRST_US; /* it has sent since, so the last recovery has succeeded */
    }
}

void can_bus_watch(can_bus_t *bus, const brace_hal_t *hal, uint32_t tick_us)
{
    if (!bus->is_there) {
        return;
    }
    bus->health_us += tick_us;
    if (bus->health_us >= HEALTH_US) {
        bus->health_us = 0;
        ask_health(bus, hal);
    }
    bus->recover_us = bus->is_off ? bus->recover_us + tick_us : 0u;
    if (bus->recover_us >= bus->recover_wait_us) {
        const bool may_double = bus->recover_wait_us < RECOVER_MOST_US / 2u;
        bus->recover_us = 0;
        bus->recover_wait_us = may_double ? 2u * bus->recover_wait_us : RECOVER_MOST_US;
        (void)hal->can_recover(hal->context);
    }
}

bool can_bus_send(can_bus_t *bus, const wire_tick_t *tick, const brace_can_frame_t *frame)
{
    const int32_t status = tick->hal->can_send(tick->hal->context, frame);
    if (status != BRACE_HAL_OK && status != BRACE_HAL_AGAIN) {
        brace_count(&tick->counters->frames_refused);
        bus->is_off = bus->is_off || status == BRACE_HAL_E_BUS_OFF;
    }
    return status == BRACE_HAL_OK;
}

bool can_bus_receive(const can_bus_t *bus, const brace_hal_t *hal, brace_can_frame_t *frame)
{
    return bus->is_there && hal->can_receive(hal->context, frame) == 1;
}
