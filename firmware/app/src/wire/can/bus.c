#include "wire/can/bus.h"

#include "brace/can_frames.h"

#define HEALTH_US 10000u
#define RECOVER_FIRST_US 125000u
#define RECOVER_MOST_US 2000000u
#define IDENTIFIER_BITS 0x7ffu

static void set_up(can_bus_t *bus, const brace_hal_t *hal)
{
    int32_t status = hal->can_setup(hal->context, &bus->setup);
    if (status != BRACE_HAL_OK && bus->setup.fd_bit_rate != 0u) {
        brace_can_setup_t classic = bus->setup; /* classic frames rather than silence */
        classic.fd_bit_rate = 0;
        status = hal->can_setup(hal->context, &classic);
        bus->setup.fd_bit_rate = status == BRACE_HAL_OK ? 0u : bus->setup.fd_bit_rate;
    }
    bus->is_there = status == BRACE_HAL_OK;
    bus->is_fitted = status != BRACE_HAL_E_UNSUPPORTED;
}

void can_bus_start(can_bus_t *bus, const brace_hal_t *hal, const brace_controller_t *parameters)
{
    *bus = (can_bus_t){.recover_wait_us = RECOVER_FIRST_US,
                       .setup = {.bit_rate = parameters->can_bit_rate,
                                 .fd_bit_rate = parameters->can_fd_bit_rate,
                                 .listen_only = parameters->node_id == 0u,
                                 .filter_id = (uint32_t)BRACE_CAN_ID_REQUEST + parameters->node_id,
                                 .filter_mask = IDENTIFIER_BITS,
                                 .urgent_id = parameters->stop_id}};
    if (hal->can_setup != NULL && hal->can_send != NULL && hal->can_receive != NULL && hal->can_health != NULL &&
        hal->can_recover != NULL) {
        set_up(bus, hal);
    }
}

static void ask_health(can_bus_t *bus, const brace_hal_t *hal)
{
    brace_can_health_t health;
    if (hal->can_health(hal->context, &health) != BRACE_HAL_OK) {
        return;
    }
    bus->is_off = health.bus_off;
    bus->frames_lost = health.frames_lost;
}

void can_bus_watch(can_bus_t *bus, const brace_hal_t *hal, uint32_t tick_us)
{
    if (!bus->is_there) {
        bus->recover_us += bus->is_fitted ? tick_us : 0u;
        if (bus->recover_us >= RECOVER_MOST_US) {
            bus->recover_us = 0;
            set_up(bus, hal);
        }
        return;
    }
    bus->health_us += tick_us;
    if (bus->health_us >= HEALTH_US) {
        bus->health_us = 0;
        ask_health(bus, hal);
    }
    bus->recover_us = bus->is_off ? bus->recover_us + tick_us : 0u;
    bus->on_us = bus->is_off ? 0u : bus->on_us + (bus->on_us < RECOVER_MOST_US ? tick_us : 0u);
    if (bus->on_us >= RECOVER_MOST_US) {
        bus->recover_wait_us = RECOVER_FIRST_US; /* heartbeats have left since, so the last recovery has succeeded */
    }
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
