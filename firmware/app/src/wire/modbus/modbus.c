#include "wire/modbus/modbus.h"

#include <stddef.h>

#include "wire/modbus/ask.h"

void modbus_start(modbus_t *modbus, const brace_hal_t *hal, const brace_parameters_t *parameters)
{
    *modbus = (modbus_t){.server = {.address = (uint8_t)parameters->controller.modbus_address}};
    modbus_ask_nothing(&modbus->server);
    if (hal->serial_setup == NULL || hal->serial_read == NULL || hal->serial_write == NULL) {
        return;
    }
    modbus_line_start(&modbus->line, hal, parameters->controller.modbus_baud);
    modbus_tcp_start(&modbus->tcp, hal, parameters->controller.modbus_baud);
}

bool modbus_hear(modbus_t *modbus, const wire_tick_t *tick, uint32_t *done)
{
    bool stops = false;
    if (modbus->line.link.is_fitted) {
        stops = modbus_line_hear(&modbus->line, &modbus->server, tick, done);
    }
    if (modbus->tcp.link.is_fitted) {
        stops = modbus_tcp_hear(&modbus->tcp, &modbus->server, tick, done) || stops;
    }
    return stops;
}

uint32_t modbus_answer(modbus_t *modbus, const wire_tick_t *tick, bool has_room)
{
    uint32_t done = WIRE_NOTHING;
    if (modbus->line.link.is_fitted) {
        done += modbus_line_answer(&modbus->line, &modbus->server, tick, has_room);
    }
    if (modbus->tcp.link.is_fitted && has_room) {
        done += modbus_tcp_answer(&modbus->tcp, &modbus->server, tick);
    }
    return done;
}
