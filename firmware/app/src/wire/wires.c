#include "wire/wires.h"

#include <string.h>

void wires_start(wires_t *wires, const brace_hal_t *hal, const controller_t *controller)
{
    const brace_parameters_t *parameters = request_parameters(controller);
    memset(&wires->measured, 0xff, sizeof wires->measured); /* what a value that is gone reads from here on */
    can_start(&wires->can, hal, parameters);
    modbus_start(&wires->modbus, hal, parameters);
}

void wires_tick(wires_t *wires, const brace_hal_t *hal, controller_t *controller, uint32_t now_us)
{
    brace_app_counters_t counters;
    request_counters(controller, &counters);
    wires_counters(wires, &counters);
    measured_take(controller, &counters, now_us, &wires->measured);
    const wire_tick_t tick = {
        .hal = hal, .controller = controller, .measured = &wires->measured, .now_us = now_us};
    can_tick(&wires->can, &tick);
    modbus_tick(&wires->modbus, &tick);
}

bool wires_are_bus_off(const wires_t *wires)
{
    return can_is_bus_off(&wires->can);
}

void wires_counters(const wires_t *wires, brace_app_counters_t *counters)
{
    can_counters(&wires->can, counters);
    modbus_counters(&wires->modbus, counters);
}
