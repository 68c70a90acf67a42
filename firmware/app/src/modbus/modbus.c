#include "modbus/modbus.h"

#include "modbus/command.h"
#include "modbus/link.h"

#define CHARACTER_BITS 11u
#define LEAST_SILENCE_US 1750u /* above 19200 bit/s, whatever the rate */

void modbus_start(brace_app_t *app)
{
    const brace_hal_t *hal = app->hal;
    const uint32_t baud = app->parameters.controller.modbus_baud;
    brace_app_modbus_t *modbus = &app->modbus;
    *modbus = (brace_app_modbus_t){.address = (uint8_t)app->parameters.controller.modbus_address};
    command_ask_nothing(app);
    if (hal->serial_setup == NULL || hal->serial_read == NULL || hal->serial_write == NULL) {
        return;
    }
    const uint32_t characters_us = 3500000u * CHARACTER_BITS / baud;
    modbus->silence_us = baud > 19200u ? LEAST_SILENCE_US : characters_us;
    modbus->line.there = hal->serial_setup(hal->context, BRACE_SERIAL_MODBUS, baud, BRACE_PARITY_EVEN) == BRACE_HAL_OK;
    modbus->tcp.there =
        hal->serial_setup(hal->context, BRACE_SERIAL_MODBUS_TCP, baud, BRACE_PARITY_NONE) == BRACE_HAL_OK;
}

static bool wants(const brace_app_modbus_link_t *link)
{
    return link->phase == LINK_CHECK || link->phase == LINK_WORK || link->phase == LINK_SEAL;
}

bool modbus_poll(brace_app_t *app, uint32_t now_us)
{
    brace_app_modbus_t *modbus = &app->modbus;
    modbus->polls_tcp = modbus->tcp.there && !(modbus->polls_tcp && modbus->line.there);
    if (modbus->polls_tcp) {
        tcp_poll(app, now_us);
    } else if (modbus->line.there) {
        line_poll(app, now_us);
    }
    return wants(&modbus->line) || wants(&modbus->tcp);
}

static uint32_t step_costs(const brace_app_modbus_link_t *link, const uint8_t *pdu)
{
    return link->phase != LINK_WORK       ? MODBUS_CHECK_COSTS
           : pdu[0] == MODBUS_WRITE_BLOCK ? MODBUS_ASK_COSTS
                                          : MODBUS_READ_COSTS;
}

uint32_t modbus_costs(const brace_app_t *app)
{
    const brace_app_modbus_t *modbus = &app->modbus;
    const uint32_t line = wants(&modbus->line) ? step_costs(&modbus->line, modbus->line.bytes + 1) : 0u;
    const uint32_t tcp = wants(&modbus->tcp) ? step_costs(&modbus->tcp, modbus->tcp.bytes + 7) : 0u;
    return line > tcp ? line : tcp;
}

/* The ports take turns. */
void modbus_serve(brace_app_t *app, uint32_t now_us, bool all)
{
    brace_app_modbus_t *modbus = &app->modbus;
    const bool line = wants(&modbus->line), tcp = wants(&modbus->tcp);
    modbus->turn = !modbus->turn;
    if (line && (modbus->turn || !tcp)) {
        line_serve(app, now_us, all);
    } else if (tcp) {
        tcp_serve(app, now_us);
    }
}
