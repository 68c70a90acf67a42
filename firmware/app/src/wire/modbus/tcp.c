#include "wire/modbus/tcp.h"

#include <stddef.h>

#include "wire/modbus/bytes.h"
#include "wire/modbus/pdu.h"

enum { PROTOCOL_AT = 2, LENGTH_AT = 4, UNIT_AT = 6, PDU_AT = 7, LEAST_BYTES = PDU_AT + 1 };
enum { LEAST_LENGTH = 2, MOST_LENGTH = MODBUS_PDU_BYTES + 1 }; /* as the header tells it */
enum { ANY_UNIT = 0, DEVICE_ITSELF = 255 };

#define PATIENCE_US 1000000u /* the rest of a request may be so long on its way */

void modbus_tcp_start(modbus_link_t *link, const brace_hal_t *hal, uint32_t baud)
{
    link->is_fitted =
        hal->serial_setup(hal->context, BRACE_SERIAL_MODBUS_TCP, baud, BRACE_PARITY_NONE) == BRACE_HAL_OK;
}

static uint32_t whole_bytes(const modbus_link_t *link)
{
    return UNIT_AT + get_16(link->bytes + LENGTH_AT);
}

static bool is_modbus(const modbus_link_t *link)
{
    const uint32_t length = get_16(link->bytes + LENGTH_AT);
    return get_16(link->bytes + PROTOCOL_AT) == 0u && length >= LEAST_LENGTH && length <= MOST_LENGTH;
}

/* What is no Modbus tells no length: it is thrown away until nothing more comes. */
static void skip(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick)
{
    link->count = 0;
    if (modbus_link_receive(link, tick, BRACE_SERIAL_MODBUS_TCP, MODBUS_LINK_BYTES) == 0u) {
        modbus_link_break(link, server, tick);
    }
    link->count = 0;
}

/* returns whether a request is whole. Nothing of the next one is read. */
static bool gather(modbus_link_t *link, const wire_tick_t *tick)
{
    if (link->count < LEAST_BYTES) {
        (void)modbus_link_receive(link, tick, BRACE_SERIAL_MODBUS_TCP, LEAST_BYTES - (uint32_t)link->count);
    }
    if (link->count < LEAST_BYTES) {
        return false;
    }
    link->is_skipping = !is_modbus(link);
    if (link->is_skipping) {
        return false;
    }
    const uint32_t whole = whole_bytes(link);
    if (link->count < whole) {
        (void)modbus_link_receive(link, tick, BRACE_SERIAL_MODBUS_TCP, whole - link->count);
    }
    return link->count == whole;
}

/* The first half of a value that this connection may have written. */
static modbus_half_t *own_half(modbus_link_t *link, const brace_hal_t *hal)
{
    const uint32_t peer =
        hal->serial_peer != NULL ? hal->serial_peer(hal->context, BRACE_SERIAL_MODBUS_TCP) : 0u;
    modbus_half_t *half = &link->half[peer % MODBUS_PEERS];
    half->is_known = half->is_known && half->peer == peer;
    half->seal.is_there = half->seal.is_there && half->peer == peer;
    half->peer = peer;
    return half;
}

/* The unit is the controller's address; 0 and 255 mean the device behind the connection. There are no others. */
/* returns whether the request is done with: else it is put again in the next tick */
static bool answer(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick)
{
    const uint8_t unit = link->bytes[UNIT_AT];
    uint8_t *pdu = link->bytes + PDU_AT;
    uint32_t length;
    server->messages = (uint16_t)(server->messages + !link->is_waiting);
    if (unit == server->address || unit == ANY_UNIT || unit == DEVICE_ITSELF) {
        server->served = (uint16_t)(server->served + !link->is_waiting);
        server->asker = BRACE_ASKER_MODBUS_TCP;
        length = modbus_pdu_answer(server, own_half(link, tick->hal), tick, pdu, (uint32_t)link->count - PDU_AT);
    } else {
        length = modbus_pdu_refuse(server, tick, pdu, MODBUS_E_TARGET);
    }
    link->is_waiting = length == 0u;
    if (link->is_waiting) {
        return false;
    }
    put_16(link->bytes + LENGTH_AT, length + 1u);
    modbus_link_answer(link, tick, PDU_AT + length);
    return true;
}

/* returns how much it has done (wire.h) */
static uint32_t take_request(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick)
{
    if (link->is_waiting) {
        const bool is_late =
            !brace_app_k_is_coming(tick->app, BRACE_ASKER_MODBUS_TCP) && answer(link, server, tick);
        return is_late ? WIRE_K_ANSWERED : WIRE_NOTHING;
    }
    if (link->is_skipping) {
        skip(link, server, tick);
    } else if (gather(link, tick)) {
        (void)answer(link, server, tick);
        return WIRE_TAKEN;
    } else if (link->count > 0u && tick->now_us - link->active_us > PATIENCE_US) {
        modbus_link_break(link, server, tick);
    }
    return WIRE_NOTHING;
}

uint32_t modbus_tcp_tick(modbus_link_t *link, modbus_server_t *server, const wire_tick_t *tick)
{
    const uint32_t done = link->is_sending ? WIRE_NOTHING : take_request(link, server, tick);
    if (link->is_sending) {
        modbus_link_send(link, tick, BRACE_SERIAL_MODBUS_TCP);
    }
    return done;
}
