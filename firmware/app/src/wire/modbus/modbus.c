#include "wire/modbus/modbus.h"

#include <stddef.h>

#include "wire/modbus/ask.h"
#include "wire/modbus/tcp.h"

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

uint32_t modbus_tick(modbus_t *modbus, const wire_tick_t *tick)
{
    uint32_t done = WIRE_NOTHING;
    if (modbus->line.link.is_fitted) {
        done += modbus_line_tick(&modbus->line, &modbus->server, tick);
    }
    if (modbus->tcp.is_fitted) {
        done += modbus_tcp_tick(&modbus->tcp, &modbus->server, tick);
    }
    return done;
}
