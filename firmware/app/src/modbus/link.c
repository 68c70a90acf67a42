#include "modbus/link.h"

void link_rest(brace_app_modbus_link_t *link)
{
    link->phase = LINK_LISTEN;
    link->count = link->sent = link->checked = 0;
    link->drop = false;
    link->work.begun = false;
}

void link_send(brace_app_t *app, brace_app_modbus_link_t *link, brace_serial_port_t port, uint32_t now_us)
{
    const int32_t taken = app->hal->serial_write(app->hal->context, port, link->bytes + link->sent,
                                                 (uint32_t)link->count - link->sent);
    if (taken > 0) {
        link->sent = (uint16_t)(link->sent + taken);
        link->heard_us = now_us;
    }
    if (link->sent >= link->count || now_us - link->heard_us > LINK_SEND_US) {
        link_rest(link);
    }
}

void link_broken(brace_app_t *app, brace_app_modbus_link_t *link)
{
    app->modbus.broken++;
    app->counters.modbus_broken += app->counters.modbus_broken < UINT32_MAX;
    link_rest(link);
}
