/* Modbus TCP: transaction 2, protocol 2, length 2 (from the unit on), unit 1, PDU; high bytes first (Modbus messaging
 * on TCP/IP 1.0b, 3.1.3). The door hands over whole ADUs, one after another, and sends the answer to who asked. */
#include "modbus/bytes.h"
#include "modbus/link.h"

enum { LENGTH_AT = 4, UNIT_AT = 6, HEADER = 7, LEAST_LENGTH = 2, MOST_LENGTH = MODBUS_PDU_BYTES + 1, LEAST = HEADER +
       1 };
enum { ANY_UNIT = 0, DEVICE_ITSELF = 255 };

#define PATIENCE_US 1000000u

/* returns whether something came */
static bool read(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t most, uint32_t now_us)
{
    const uint32_t room = most < LINK_READ ? most : LINK_READ;
    const int32_t count =
        app->hal->serial_read(app->hal->context, BRACE_SERIAL_MODBUS_TCP, link->bytes + link->count, room);
    if (count > 0) {
        link->count = (uint16_t)(link->count + count);
        link->heard_us = now_us;
    }
    return count > 0;
}

static uint32_t whole_length(const brace_app_modbus_link_t *link)
{
    return UNIT_AT + get_16(link->bytes + LENGTH_AT);
}

static bool is_modbus(const brace_app_modbus_link_t *link)
{
    const uint32_t length = get_16(link->bytes + LENGTH_AT);
    return get_16(link->bytes + 2) == 0u && length >= LEAST_LENGTH && length <= MOST_LENGTH;
}

/* What is no Modbus is read to its end. */
static void skip(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t now_us)
{
    link->count = 0;
    if (!read(app, link, LINK_READ, now_us)) {
        link_broken(app, link);
    }
}

static void gather(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t now_us)
{
    if (link->drop) {
        skip(app, link, now_us);
        return;
    }
    if (link->count < LEAST && !read(app, link, LEAST - (uint32_t)link->count, now_us) && link->count == 0u) {
        return;
    }
    if (link->count >= LEAST) {
        link->drop = !is_modbus(link);
        if (!link->drop && link->count < whole_length(link)) {
            (void)read(app, link, whole_length(link) - link->count, now_us);
        }
        link->phase = !link->drop && link->count == whole_length(link) ? LINK_WORK : LINK_LISTEN;
    }
    if (link->phase == LINK_LISTEN && now_us - link->heard_us > PATIENCE_US) {
        link_broken(app, link);
    }
}

void tcp_poll(brace_app_t *app, uint32_t now_us)
{
    brace_app_modbus_link_t *link = &app->modbus.tcp;
    if (link->phase == LINK_LISTEN) {
        gather(app, link, now_us);
    } else if (link->phase == LINK_SEND) {
        link_send(app, link, BRACE_SERIAL_MODBUS_TCP, now_us);
    }
}

/* The unit is the controller's address; 0 and 255 mean the device behind the connection. Others are not there. */
static uint32_t answer(brace_app_t *app, brace_app_modbus_link_t *link, uint32_t now_us)
{
    const uint8_t unit = link->bytes[UNIT_AT];
    brace_app_modbus_t *modbus = &app->modbus;
    modbus->messages = (uint16_t)(modbus->messages + !link->work.begun);
    if (unit != modbus->address && unit != ANY_UNIT && unit != DEVICE_ITSELF) {
        return modbus_refuse(app, link->bytes + HEADER, MODBUS_E_TARGET);
    }
    modbus->served = (uint16_t)(modbus->served + !link->work.begun);
    return modbus_pdu_work(app, &link->work, link->bytes + HEADER, (uint32_t)link->count - HEADER, now_us);
}

void tcp_serve(brace_app_t *app, uint32_t now_us)
{
    brace_app_modbus_link_t *link = &app->modbus.tcp;
    const uint32_t length = answer(app, link, now_us);
    if (length > 0u) {
        put_16(link->bytes + LENGTH_AT, length + 1u);
        link->count = (uint16_t)(HEADER + length);
        link->heard_us = now_us;
        link->phase = LINK_SEND;
    }
}
