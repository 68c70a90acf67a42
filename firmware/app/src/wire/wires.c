#include "wire/wires.h"

#include <string.h>

void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters)
{
    memset(&wires->measured, 0xff, sizeof wires->measured); /* what a value that is gone reads from here on */
    can_start(&wires->can, hal, parameters);
    modbus_start(&wires->modbus, hal, parameters);
}

static bool listen(wires_t *wires, bool to_can, const wire_tick_t *tick)
{
    return to_can ? can_listen(&wires->can, tick) : modbus_tick(&wires->modbus, tick);
}

bool wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                wires_room_t room, uint32_t now_us)
{
    wire_tick_t tick = {.hal = hal,
                        .app = app,
                        .counters = counters,
                        .measured = &wires->measured,
                        .requests_wait = room == WIRES_NONE,
                        .answers_wait = room == WIRES_NONE,
                        .now_us = now_us};
    measured_take(app, counters, now_us, &wires->measured);
    wires->can_is_first = room == WIRES_ONE ? !wires->can_is_first : wires->can_is_first;
    const bool by_first = listen(wires, wires->can_is_first, &tick);
    tick.requests_wait = room == WIRES_NONE || (room == WIRES_ONE && by_first);
    const bool by_second = listen(wires, !wires->can_is_first, &tick);
    const bool has_answered = by_first || by_second;
    const uint32_t most = has_answered || room == WIRES_NONE ? 0u
                          : room == WIRES_ONE              ? 1u
                                                           : (uint32_t)PROCESS_FRAMES_PER_TICK;
    const bool has_told = can_speak(&wires->can, &tick, most);
    return has_answered || has_told;
}

bool wires_data_are_overdue(const wires_t *wires)
{
    return can_data_are_overdue(&wires->can);
}

bool wires_are_bus_off(const wires_t *wires)
{
    return can_is_bus_off(&wires->can);
}
