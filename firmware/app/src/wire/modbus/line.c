#include "wire/modbus/line.h"

#include "wire/modbus/bytes.h"
#include "wire/modbus/crc.h"
#include "wire/modbus/pdu.h"

enum { ADDRESS_BYTES = 1, CRC_BYTES = 2, FRAME_LEAST = ADDRESS_BYTES + 1 + CRC_BYTES, FRAME_MOST = 256, EVERYBODY = 0 };

/* A whole frame may come at once, from an adapter. Its check is worked out in three ticks, mostly before silence ends
 * it. */
#define CHECKED_PER_TICK ((FRAME_MOST + 2u) / 3u)

/* The check of an answer is worked out so many bytes ahead of what the line carries in a tick: no gap tears it, also
 * where a tick comes late. */
#define BYTES_AHEAD 48u

#define CHARACTER_BITS 11u
#define LEAST_SILENCE_US 1750u /* above 19200 bit/s the standard has it whatever the rate */

/* The rest of a frame for us may be so long on its way: adapters hold bytes back, the commonest ones for 16 ms. */
#define PATIENCE_US 20000u

void modbus_line_start(modbus_line_t *line, const brace_hal_t *hal, uint32_t baud)
{
    line->bytes_per_ms = baud / (1000u * CHARACTER_BITS) + 1u;
    line->silence_us = baud > 19200u ? LEAST_SILENCE_US : 3500000u * CHARACTER_BITS / baud;
    line->link.is_fitted =
        hal->serial_setup(hal->context, BRACE_SERIAL_MODBUS, baud, BRACE_PARITY_EVEN) == BRACE_HAL_OK;
}

/* returns whether bytes have come */
static bool gather(modbus_line_t *line, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    const uint32_t before = link->count;
    const uint32_t came = modbus_link_receive(link, tick, BRACE_SERIAL_MODBUS, MODBUS_LINK_BYTES - before);
    if (link->is_skipping || link->count > FRAME_MOST) {
        /* What is longer than any frame is thrown away until the line is silent. */
        link->is_skipping = true;
        link->count = 0;
    }
    if (before == 0u) {
        line->crc = MODBUS_CRC_START;
        line->checked = 0;
    }
    return came > 0u;
}

/* Goes on with the check of the first `length` bytes, over at most so many of them. */
static void check_on(modbus_line_t *line, uint32_t length, uint32_t most)
{
    const uint32_t left = length > line->checked ? length - line->checked : 0u;
    const uint32_t count = left < most ? left : most;
    line->crc = modbus_crc(line->crc, line->link.bytes + line->checked, count);
    line->checked = (uint16_t)(line->checked + count);
}

/* Can what has come be the beginning of a request for us? */
static bool may_go_on(const modbus_link_t *link, const modbus_server_t *server)
{
    if (link->is_skipping || (link->bytes[0] != server->address && link->bytes[0] != EVERYBODY)) {
        return false;
    }
    const uint32_t length = (uint32_t)link->count - ADDRESS_BYTES;
    return length == 0u || length < modbus_pdu_least_length(link->bytes + ADDRESS_BYTES, length) + CRC_BYTES;
}

/* A sound frame: is it a request for us? Counts it. */
static bool is_for_us(const modbus_link_t *link, modbus_server_t *server)
{
    const uint8_t address = link->bytes[0], function = link->bytes[ADDRESS_BYTES];
    const bool writes = function == MODBUS_WRITE_ONE || function == MODBUS_WRITE_BLOCK;
    server->messages++;
    if ((address != server->address && address != EVERYBODY) || (function & MODBUS_REFUSED) != 0u) {
        return false; /* another's; or an exception, perhaps our own come back over a line of two wires */
    }
    server->served++;
    if (address == EVERYBODY) { /* nobody answers such a request, so only a write has a sense */
        server->unanswered++;
        return writes;
    }
    return true;
}

/* What tells a frame from others of its length: its check, its function and the byte behind that. The check alone is the
 * same for one request in 65,536. */
static uint32_t mark_of(const modbus_link_t *link)
{
    return get_16(link->bytes + ADDRESS_BYTES) << 16 | get_16(link->bytes + link->count - CRC_BYTES);
}

/* Is a sound frame the answer that left before it, come back? */
static bool is_own_answer(modbus_line_t *line)
{
    const modbus_link_t *link = &line->link;
    const uint8_t function = link->bytes[ADDRESS_BYTES];
    const bool may_be_a_request = function == MODBUS_WRITE_ONE || function == MODBUS_DIAGNOSE;
    const bool is_equal = link->count == line->answer_bytes && mark_of(link) == line->answer_mark;
    const bool shows_echo = line->answer_bytes != 0u && !(is_equal && may_be_a_request);
    if (shows_echo) {
        line->echo = is_equal ? MODBUS_ECHO : MODBUS_NO_ECHO;
    }
    line->answer_bytes = 0;
    return is_equal && line->echo != MODBUS_NO_ECHO;
}

/* returns whether the request is done with: else it is put again in the next tick */
static bool answer(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    const uint32_t request = (uint32_t)link->count - ADDRESS_BYTES - CRC_BYTES;
    server->asker = BRACE_ASKER_MODBUS_LINE;
    const uint32_t answered = modbus_pdu_answer(server, link->half, tick, link->bytes + ADDRESS_BYTES, request);
    const uint32_t length = ADDRESS_BYTES + answered;
    link->is_waiting = answered == 0u;
    if (link->is_waiting) {
        return false;
    }
    if (link->bytes[0] == EVERYBODY) {
        modbus_link_rest(link);
        return true;
    }
    line->crc = MODBUS_CRC_START;
    line->checked = 0;
    modbus_link_answer(link, tick, length + CRC_BYTES);
    link->ready = 0;
    return true;
}

/* Makes the next part of an answer ready, and its check at the end. */
static void seal(modbus_line_t *line, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    const uint32_t tick_us = brace_app_parameters(tick->app)->controller.tick_us;
    const uint32_t length = (uint32_t)link->count - CRC_BYTES;
    if (link->ready == link->count) {
        return;
    }
    check_on(line, length, BYTES_AHEAD + line->bytes_per_ms * tick_us / 1000u);
    link->ready = line->checked;
    if (line->checked == length) {
        link->bytes[length] = (uint8_t)line->crc;
        link->bytes[length + 1u] = (uint8_t)(line->crc >> 8);
        link->ready = link->count;
        line->answer_bytes = link->count;
        line->answer_mark = mark_of(link);
    }
}

/* The line is silent: what has come is a frame, or broken, or a part whose rest is held back.
 * returns how much it has done (wire.h) */
static uint32_t end_frame(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, uint32_t silent_us)
{
    modbus_link_t *link = &line->link;
    check_on(line, link->count, MODBUS_LINK_BYTES);
    if (link->is_skipping || link->count < FRAME_LEAST || line->crc != 0u) {
        if (silent_us >= PATIENCE_US || !may_go_on(link, server)) {
            modbus_link_break(link, server, tick);
        }
    } else if (!is_own_answer(line) && is_for_us(link, server)) {
        (void)answer(line, server, tick);
        return WIRE_TAKEN;
    } else {
        modbus_link_rest(link);
    }
    return WIRE_NOTHING;
}

uint32_t modbus_line_tick(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    uint32_t done = WIRE_NOTHING;
    if (link->is_waiting) {
        const bool is_late =
            !brace_app_k_is_coming(tick->app, BRACE_ASKER_MODBUS_LINE) && answer(line, server, tick);
        done = is_late ? WIRE_K_ANSWERED : WIRE_NOTHING;
    } else if (!link->is_sending) { /* else what comes waits in the port */
        const bool bytes_came = gather(line, tick);
        const uint32_t silent_us = tick->now_us - link->active_us;
        const bool is_behind = link->count > line->checked + CHECKED_PER_TICK; /* with the check */
        if (bytes_came || silent_us < line->silence_us || is_behind) {
            check_on(line, link->count, CHECKED_PER_TICK);
        } else if (link->count > 0u || link->is_skipping) {
            done = end_frame(line, server, tick, silent_us);
        }
    }
    if (link->is_sending) {
        seal(line, tick);
        modbus_link_send(link, tick, BRACE_SERIAL_MODBUS);
    }
    return done;
}
