#include "wire/wires.h"

#include <string.h>

#define BURST_EVERY_TICKS 2u /* ticks behind a burst in which another one counts as none: questions and jobs go on */
#define OBEYED_MOST 1u /* a tick that has obeyed more leaves questions to the next one, but each fifth one does not */

void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters)
{
    memset(&wires->measured, 0xff, sizeof wires->measured); /* what a value that is gone reads from here on */
    can_start(&wires->can, hal, parameters);
    modbus_start(&wires->modbus, hal, parameters);
}

/* To sort a burst takes most of what a tick may spend on its wires. */
static bool takes_burst(wires_t *wires, const wire_tick_t *tick)
{
    const bool has_come = can_has_burst(&wires->can, tick) || modbus_line_has_burst(&wires->modbus.line);
    const bool is_taken = has_come && wires->ticks_without_burst == BURST_EVERY_TICKS;
    const uint32_t passed = (uint32_t)wires->ticks_without_burst + (wires->ticks_without_burst < BURST_EVERY_TICKS);
    wires->ticks_without_burst = is_taken ? (uint8_t)0u : (uint8_t)passed;
    return is_taken;
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
    wires->has_burst = takes_burst(wires, &tick);
    wires->obeyed += can_obey(&wires->can, &tick, wires->has_burst);
}

uint32_t wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                    uint32_t now_us)
{
    const wire_tick_t tick = {
        .hal = hal, .app = app, .counters = counters, .measured = &wires->measured, .now_us = now_us};
    measured_take(app, counters, now_us, &wires->measured);
    const bool is_too_full = wires->obeyed > OBEYED_MOST && can_leaves_room(&wires->can);
    wires->leaves_room = is_too_full || (can_leaves_room(&wires->can) && can_session_waits(&wires->can));
    const uint32_t obeyed = is_too_full ? OBEYED_MOST : wires->obeyed;
    const bool has_room = obeyed <= OBEYED_MOST && !wires->has_burst;
    const uint32_t sorted = wires->has_burst ? (uint32_t)WIRE_BURST_IS_SORTED : (uint32_t)WIRE_NOTHING;
    const uint32_t handled =
        sorted + obeyed + modbus_answer(&wires->modbus, &tick, has_room) + can_answer(&wires->can, &tick, has_room);
    return handled + can_speak(&wires->can, &tick, handled > 0u ? 0u : (uint32_t)PROCESS_FRAMES_PER_TICK);
}

bool wires_are_bus_off(const wires_t *wires)
{
    return can_is_bus_off(&wires->can);
}
