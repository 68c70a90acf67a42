#include "wire/wires.h"

#include <string.h>

#define OBEYED_MOST 1u /* a tick that has obeyed more leaves questions to the next one, but each fifth one does not */

void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters)
{
    memset(&wires->measured, 0xff, sizeof wires->measured); /* what a value that is gone reads from here on */
    can_start(&wires->can, hal, parameters);
    modbus_start(&wires->modbus, hal, parameters);
}

void wires_hear(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                uint32_t now_us)
{
    const wire_tick_t tick = {
        .hal = hal, .app = app, .counters = counters, .measured = &wires->measured, .now_us = now_us};
    wires->obeyed = WIRE_NOTHING;
    const bool stops_by_can = can_hear(&wires->can, &tick);
    if (modbus_hear(&wires->modbus, &tick, &wires->obeyed) || stops_by_can) {
        can_stop(&wires->can);
    }
    wires->obeyed += can_obey(&wires->can, &tick);
}

uint32_t wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                    uint32_t now_us)
{
    const wire_tick_t tick = {
        .hal = hal, .app = app, .counters = counters, .measured = &wires->measured, .now_us = now_us};
    measured_take(app, counters, now_us, &wires->measured);
    const bool is_too_full = wires->obeyed > OBEYED_MOST && can_leaves_room(&wires->can);
    const uint32_t obeyed = is_too_full ? OBEYED_MOST : wires->obeyed;
    const bool has_room = obeyed <= OBEYED_MOST;
    const uint32_t handled = obeyed + modbus_answer(&wires->modbus, &tick, has_room) +
                             can_answer(&wires->can, &tick, has_room);
    return handled + can_speak(&wires->can, &tick, handled > 0u ? 0u : (uint32_t)PROCESS_FRAMES_PER_TICK);
}

bool wires_are_bus_off(const wires_t *wires)
{
    return can_is_bus_off(&wires->can);
}
