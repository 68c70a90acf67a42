#include "wire/modbus/link.h"

#define SEND_PATIENCE_US 1000000u

void modbus_link_rest(modbus_link_t *link)
{
    link->is_sending = link->is_skipping = false;
    link->count = link->ready = link->sent = 0;
}

uint32_t modbus_link_receive(modbus_link_t *link, const wire_tick_t *tick, brace_serial_port_t port, uint32_t room)
{
    const int32_t count = tick->hal->serial_read(tick->hal->context, port, link->bytes + link->count, room);
    if (count <= 0) {
        return 0;
    }
    link->count = (uint16_t)(link->count + count);
    link->active_us = tick->now_us;
    return (uint32_t)count;
}

void modbus_link_break(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick)
{
    server->broken++;
    brace_count(&tick->counters->modbus_broken);
    modbus_link_rest(link);
}

void modbus_link_answer(modbus_link_t *link, const wire_tick_t *tick, uint32_t count)
{
    link->count = link->ready = (uint16_t)count;
    link->sent = 0;
    link->active_us = tick->now_us;
    link->is_sending = true;
}

void modbus_link_send(modbus_link_t *link, const wire_tick_t *tick, brace_serial_port_t port)
{
    const int32_t taken =
        tick->hal->serial_write(tick->hal->context, port, link->bytes + link->sent, (uint32_t)link->ready - link->sent);
    if (taken > 0) {
        link->sent = (uint16_t)(link->sent + taken);
        link->active_us = tick->now_us;
    }
    if (link->sent >= link->count || tick->now_us - link->active_us > SEND_PATIENCE_US) {
        modbus_link_rest(link);
    }
}
