#include "wire/modbus/tcp.h"

#include <stddef.h>
#include <string.h>

#include "wire/modbus/bytes.h"
#include "wire/modbus/pdu.h"

enum { PROTOCOL_AT = 2, LENGTH_AT = 4, UNIT_AT = 6, PDU_AT = 7, LEAST_BYTES = PDU_AT + 1 };
enum { LEAST_LENGTH = 2, MOST_LENGTH = MODBUS_PDU_BYTES + 1 }; /* as the header states it */
enum { ANY_UNIT = 0, DEVICE_ITSELF = 255, NOBODY = MODBUS_CONNECTIONS };

#define PATIENCE_US 1000000u /* the rest of a request may be so long on its way */
#define REQUESTS_PER_TICK 8192u /* read, of all connections: more than a host's port holds */

void modbus_tcp_start(modbus_tcp_t *tcp, const brace_hal_t *hal, uint32_t baud)
{
    tcp->link.is_fitted =
        hal->serial_setup(hal->context, BRACE_SERIAL_MODBUS_TCP, baud, BRACE_PARITY_NONE) == BRACE_HAL_OK;
}

/* ------------------------------------------------------------------------------------------- reading -- */

static uint32_t whole_bytes(const modbus_link_t *link)
{
    return UNIT_AT + get_16(link->bytes + LENGTH_AT);
}

static bool is_modbus(const modbus_link_t *link)
{
    const uint32_t length = get_16(link->bytes + LENGTH_AT);
    return get_16(link->bytes + PROTOCOL_AT) == 0u && length >= LEAST_LENGTH && length <= MOST_LENGTH;
}

/* What is no Modbus states no length: it is thrown away until nothing more comes. */
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

/* ----------------------------------------------------------------------------------------- connections -- */

static bool is_open(const brace_hal_t *hal, uint32_t peer)
{
    return hal->serial_peer_is_open == NULL || hal->serial_peer_is_open(hal->context, BRACE_SERIAL_MODBUS_TCP, peer);
}

/* The place of the connection that the bytes read last came from. A new one takes a place that nobody uses, or that of
 * a connection that has closed; else that of the number after it, which a port with more connections than places may
 * have to share. */
static uint32_t place_of(modbus_tcp_t *tcp, const brace_hal_t *hal)
{
    const uint32_t peer = hal->serial_peer != NULL ? hal->serial_peer(hal->context, BRACE_SERIAL_MODBUS_TCP) : 0u;
    uint32_t place = NOBODY;
    for (uint32_t i = 0; i < (uint32_t)MODBUS_CONNECTIONS; i++) {
        const modbus_connection_t *connection = &tcp->connection[i];
        if (connection->is_used && connection->half.peer == peer) {
            return i;
        }
        if (place == (uint32_t)NOBODY && (!connection->is_used || !is_open(hal, connection->half.peer))) {
            place = i;
        }
    }
    place = place == (uint32_t)NOBODY ? peer % (uint32_t)MODBUS_CONNECTIONS : place;
    tcp->waits = tcp->waits && tcp->waiting != place;
    tcp->connection[place] = (modbus_connection_t){.half = {.peer = peer}, .is_used = true};
    return place;
}

/* An answer goes out whole, or is lost: its connection reads too slowly, or has closed. */
static void send(const modbus_tcp_t *tcp, uint32_t place, const wire_tick_t *tick, uint32_t count)
{
    const brace_hal_t *hal = tick->hal;
    const uint32_t peer = tcp->connection[place].half.peer;
    const uint8_t *bytes = tcp->link.bytes;
    const int32_t taken = hal->serial_write_to != NULL
                              ? hal->serial_write_to(hal->context, BRACE_SERIAL_MODBUS_TCP, peer, bytes, count)
                              : hal->serial_write(hal->context, BRACE_SERIAL_MODBUS_TCP, bytes, count);
    if (taken != (int32_t)count) {
        brace_count(&tick->counters->requests_lost);
    }
}

static void refuse(modbus_tcp_t *tcp, uint32_t place, modbus_server_t *server, const wire_tick_t *tick,
                   modbus_exception_t why)
{
    const uint32_t length = modbus_pdu_refuse(server, tick, tcp->link.bytes + PDU_AT, why);
    put_16(tcp->link.bytes + LENGTH_AT, length + 1u);
    send(tcp, place, tick, PDU_AT + length);
}

/* Answers what the link holds, of so many bytes. returns whether that is done with: else it is put again */
static bool answer(modbus_tcp_t *tcp, uint32_t place, modbus_server_t *server, const wire_tick_t *tick, uint32_t count)
{
    uint8_t *bytes = tcp->link.bytes;
    server->asker = BRACE_ASKER_MODBUS_TCP;
    const uint32_t length =
        modbus_pdu_answer(server, &tcp->connection[place].half, tick, bytes + PDU_AT, count - PDU_AT);
    if (length == 0u) {
        return false;
    }
    put_16(bytes + LENGTH_AT, length + 1u);
    send(tcp, place, tick, PDU_AT + length);
    return true;
}

/* Is the request for this controller? The unit is its address; 0 and 255 mean the device behind the connection. There
 * are no others. */
static bool is_for_us(const modbus_link_t *link, const modbus_server_t *server)
{
    const uint8_t unit = link->bytes[UNIT_AT];
    return unit == server->address || unit == ANY_UNIT || unit == DEVICE_ITSELF;
}

static bool put_question(modbus_connection_t *connection, const modbus_link_t *link)
{
    if (connection->count == (uint32_t)MODBUS_QUESTIONS_EACH) {
        return false;
    }
    const uint32_t place = ((uint32_t)connection->first + connection->count) % (uint32_t)MODBUS_QUESTIONS_EACH;
    connection->question[place].length = (uint8_t)link->count;
    memcpy(connection->question[place].bytes, link->bytes, link->count);
    connection->count++;
    return true;
}

/* A whole request has come. returns whether it is a stop */
static bool take(modbus_tcp_t *tcp, modbus_server_t *server, const wire_tick_t *tick, uint32_t *done)
{
    modbus_link_t *link = &tcp->link;
    const uint32_t place = place_of(tcp, tick->hal), count = link->count;
    server->messages++;
    link->count = 0; /* the next one begins anew */
    if (!is_for_us(link, server)) {
        refuse(tcp, place, server, tick, MODBUS_E_TARGET);
        return false;
    }
    server->served++;
    const answer_rank_t rank = modbus_pdu_rank(link->bytes + PDU_AT, count - PDU_AT);
    if (rank == ANSWER_QUESTION && count <= (uint32_t)MODBUS_QUESTION_BYTES) {
        link->count = (uint16_t)count;
        if (!put_question(&tcp->connection[place], link)) {
            brace_count(&tick->counters->questions_busy);
            refuse(tcp, place, server, tick, MODBUS_E_BUSY);
        }
        link->count = 0;
        return false;
    }
    if (rank == ANSWER_STOPS) {
        (void)brace_app_stop(tick->app);
    }
    (void)answer(tcp, place, server, tick, count); /* a question so long is none about K, and needs no second try */
    *done += WIRE_TAKEN;
    return rank == ANSWER_STOPS;
}

bool modbus_tcp_hear(modbus_tcp_t *tcp, modbus_server_t *server, const wire_tick_t *tick, uint32_t *done)
{
    modbus_link_t *link = &tcp->link;
    bool stops = false;
    for (uint32_t i = 0; i < REQUESTS_PER_TICK; i++) {
        if (link->is_skipping) {
            skip(link, server, tick);
            break;
        }
        if (!gather(link, tick)) {
            break;
        }
        stops = take(tcp, server, tick, done) || stops;
    }
    if (link->count > 0u && tick->now_us - link->active_us > PATIENCE_US) {
        modbus_link_break(link, server, tick);
    }
    return stops;
}

/* ----------------------------------------------------------------------------------------- answering -- */

/* The oldest question of a connection. */
static const uint8_t *question_of(const modbus_connection_t *connection)
{
    return connection->question[connection->first].bytes;
}

/* May it be answered now? One question for K is worked out at a time; only a write can be one. */
static bool is_next(const modbus_tcp_t *tcp, uint32_t place)
{
    const modbus_connection_t *connection = &tcp->connection[place];
    return connection->count > 0u &&
           !(tcp->waits && (place == tcp->waiting || question_of(connection)[PDU_AT] == MODBUS_WRITE_BLOCK));
}

static uint32_t next_place(const modbus_tcp_t *tcp)
{
    for (uint32_t i = 1; i <= (uint32_t)MODBUS_CONNECTIONS; i++) {
        const uint32_t place = (tcp->turn + i) % (uint32_t)MODBUS_CONNECTIONS;
        if (is_next(tcp, place)) {
            return place;
        }
    }
    return NOBODY;
}

uint32_t modbus_tcp_answer(modbus_tcp_t *tcp, modbus_server_t *server, const wire_tick_t *tick)
{
    modbus_link_t *link = &tcp->link;
    if (link->count > 0u || link->is_skipping) {
        return WIRE_NOTHING; /* a part of a request is in the buffer: its rest comes in a moment, or it breaks */
    }
    const bool is_late = tcp->waits && !brace_app_k_is_coming(tick->app, BRACE_ASKER_MODBUS_TCP);
    const uint32_t place = is_late ? tcp->waiting : next_place(tcp);
    if (place == (uint32_t)NOBODY) {
        return WIRE_NOTHING;
    }
    modbus_connection_t *connection = &tcp->connection[place];
    const uint32_t count = connection->question[connection->first].length;
    tcp->turn = is_late ? tcp->turn : (uint8_t)place;
    memcpy(link->bytes, question_of(connection), count);
    if (!answer(tcp, place, server, tick, count)) {
        tcp->waits = true;
        tcp->waiting = (uint8_t)place;
        return is_late ? WIRE_NOTHING : WIRE_TAKEN;
    }
    tcp->waits = tcp->waits && !is_late;
    connection->first = (uint8_t)((connection->first + 1u) % (uint32_t)MODBUS_QUESTIONS_EACH);
    connection->count--;
    return is_late ? WIRE_K_ANSWERED : WIRE_TAKEN;
}
