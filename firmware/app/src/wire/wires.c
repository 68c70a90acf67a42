#include "wire/wires.h"

#include <string.h>

void wires_start(wires_t *wires, const brace_hal_t *hal, const brace_parameters_t *parameters)
{
    memset(&wires->measured, 0xff, sizeof wires->measured); /* what a value that is gone reads from here on */
    can_start(&wires->can, hal, parameters);
    modbus_start(&wires->modbus, hal, parameters);
}

void wires_tick(wires_t *wires, const brace_hal_t *hal, brace_app_t *app, brace_app_counters_t *counters,
                bool requests_wait, bool data_waits, uint32_t now_us)
{
    const wire_tick_t tick = {.hal = hal,
                              .app = app,
                              .counters = counters,
                              .measured = &wires->measured,
                              .requests_wait = requests_wait,
                              .data_waits = data_waits,
                              .now_us = now_us};
    if (!requests_wait || !data_waits) { /* Else no wire tells any of it in this tick. */
        measured_take(app, counters, now_us, &wires->measured);
    }
    if (!data_waits && !requests_wait) {
        measured_take_session(app, &wires->measured);
    }
    can_tick(&wires->can, &tick);
    modbus_tick(&wires->modbus, &tick);
}

bool wires_are_bus_off(const wires_t *wires)
{
    return can_is_bus_off(&wires->can);
}
