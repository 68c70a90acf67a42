#include "wire/modbus/line.h"

#include <stddef.h>
#include <string.h>

#include "wire/modbus/bytes.h"
#include "wire/modbus/crc.h"
#include "wire/modbus/pdu.h"

enum { ADDRESS_BYTES = 1, CRC_BYTES = 2, FRAME_LEAST = ADDRESS_BYTES + 1 + CRC_BYTES, FRAME_MOST = 256, EVERYBODY = 0 };

/* Bytes of a request to stop, by function 06 and by function 16; and where its register stands in it. */
enum { STOP_LEAST = ADDRESS_BYTES + 5 + CRC_BYTES, STOP_MOST = ADDRESS_BYTES + 10 + CRC_BYTES, REGISTER_AT = 2 };
#define STOP_REGISTER_HIGH ((BRACE_REGISTER_COMMANDS + offsetof(brace_commands_t, stop) / 2u) >> 8)

/* A whole frame may come at once, from an adapter. Its check is worked out in three ticks, mostly before silence ends
 * it. */
#define CHECKED_PER_TICK ((FRAME_MOST + 2u) / 3u)

/* The check of an answer is worked out so many bytes ahead of what the line carries in a tick: no gap tears it, also
 * where a tick comes late. */
#define BYTES_AHEAD 48u

#define BURST_BYTES 64u /* in a tick: three times what 230,400 baud carry in a millisecond */

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

/* The next byte begins a frame. */
static void begin_frame(modbus_line_t *line)
{
    line->crc = MODBUS_CRC_START;
    line->checked = line->sound = line->looked = 0;
}

/* What came while an answer left begins the next frame. */
static void take_ahead(modbus_line_t *line, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    memcpy(link->bytes, line->ahead, line->ahead_count);
    link->count = line->ahead_count;
    link->active_us = link->count > 0u ? tick->now_us : link->active_us;
    line->ahead_count = 0;
}

/* What is longer than any frame is thrown away until the line is silent, but for the last bytes, which may begin a
 * stop. */
static void keep_tail(modbus_line_t *line)
{
    modbus_link_t *link = &line->link;
    const uint32_t kept = link->count < (uint32_t)STOP_MOST - 1u ? link->count : (uint32_t)STOP_MOST - 1u;
    memmove(link->bytes, link->bytes + link->count - kept, kept);
    link->count = (uint16_t)kept;
    line->looked = 0;
}

/* returns whether bytes have come */
static bool gather(modbus_line_t *line, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    if (link->is_skipping) {
        keep_tail(line);
    }
    const uint32_t before = link->count;
    if (before == 0u) {
        begin_frame(line);
        take_ahead(line, tick);
    }
    line->came =
        (uint16_t)modbus_link_receive(link, tick, BRACE_SERIAL_MODBUS, MODBUS_LINK_BYTES - (uint32_t)link->count);
    if (link->is_skipping || link->count > FRAME_MOST) {
        link->is_skipping = true;
        line->checked = link->count;
    }
    return link->count > before;
}

/* While an answer leaves, what comes waits here. */
static void gather_ahead(modbus_line_t *line, const wire_tick_t *tick)
{
    const uint32_t room = MODBUS_AHEAD_BYTES - (uint32_t)line->ahead_count;
    const int32_t count =
        tick->hal->serial_read(tick->hal->context, BRACE_SERIAL_MODBUS, line->ahead + line->ahead_count, room);
    line->came = count > 0 ? (uint16_t)count : (uint16_t)0u;
    line->ahead_count = (uint8_t)(line->ahead_count + line->came);
}

/* Do these bytes, at least STOP_LEAST, begin with a whole request to stop, to this controller or to everybody? */
static bool begins_with_stop(const modbus_server_t *server, const uint8_t *bytes, uint32_t count)
{
    const bool writes = bytes[ADDRESS_BYTES] == MODBUS_WRITE_ONE || bytes[ADDRESS_BYTES] == MODBUS_WRITE_BLOCK;
    if (!writes || (bytes[0] != server->address && bytes[0] != EVERYBODY)) {
        return false;
    }
    const uint32_t length = modbus_pdu_least_length(bytes + ADDRESS_BYTES, count - ADDRESS_BYTES);
    const uint32_t whole = ADDRESS_BYTES + length + CRC_BYTES;
    return whole <= (uint32_t)STOP_MOST && count >= whole &&
           modbus_pdu_rank(bytes + ADDRESS_BYTES, length) == ANSWER_STOPS &&
           modbus_crc(MODBUS_CRC_START, bytes, whole) == 0u;
}

/* Has one of these four bytes the value? It is zero after the exclusive or, and a subtraction borrows at the lowest
 * zero byte first: so none is missed, and none is found where there is none. */
static bool has_byte(const uint8_t *bytes, uint8_t value)
{
    uint32_t word;
    memcpy(&word, bytes, sizeof word);
    word ^= 0x01010101u * value;
    return ((word - 0x01010101u) & ~word & 0x80808080u) != 0u;
}

/* Looks for a stop in bytes that have come, from the first one on that may still begin one. Up to 260 bytes come at
 * once, so one byte of a request's register decides whether more is looked at, and for four places together:
 * 10 instructions.
 *   looked (in, out): bytes that can begin none any more
 * returns whether there is one: it is obeyed */
static bool obey_stop(const modbus_server_t *server, const wire_tick_t *tick, const uint8_t *bytes, uint32_t count,
                      uint16_t *looked)
{
    const uint32_t end = count < (uint32_t)STOP_LEAST ? 0u : count - (uint32_t)STOP_LEAST + 1u;
    for (uint32_t from = *looked; from < end; from += 4u) { /* at most 64 times */
        const uint32_t to = !has_byte(bytes + from + REGISTER_AT, STOP_REGISTER_HIGH) ? from
                            : end - from < 4u                                         ? end
                                                                                      : from + 4u;
        for (uint32_t at = from; at < to; at++) { /* at most 4 times */
            if (bytes[at + REGISTER_AT] == STOP_REGISTER_HIGH && begins_with_stop(server, bytes + at, count - at)) {
                (void)brace_app_stop(tick->app);
                *looked = (uint16_t)(at + 1u);
                return true;
            }
        }
    }
    const uint32_t past = count > (uint32_t)STOP_MOST - 1u ? count - ((uint32_t)STOP_MOST - 1u) : 0u;
    *looked = past > *looked ? (uint16_t)past : *looked;
    return false;
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

/* What distinguishes a frame from others of its length: its check, its function and the byte behind that. The check
 * alone is the same for one request in 65,536. */
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

/* What waits for its K is forgotten: its master has asked something else. */
static void forget_question(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick)
{
    if (line->asked_count > 0u) {
        line->asked_count = 0;
        server->unanswered++;
        brace_count(&tick->counters->requests_lost);
    }
}

/* Answers the request that the link holds, of so many bytes without its check. returns whether that is done with */
static bool answer(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, uint32_t count)
{
    modbus_link_t *link = &line->link;
    server->asker = BRACE_ASKER_MODBUS_LINE;
    const uint32_t answered =
        modbus_pdu_answer(server, &line->half, tick, link->bytes + ADDRESS_BYTES, count - ADDRESS_BYTES);
    if (answered == 0u) {
        return false;
    }
    if (link->bytes[0] == EVERYBODY) {
        modbus_link_rest(link);
        return true;
    }
    line->crc = MODBUS_CRC_START;
    line->checked = 0;
    modbus_link_answer(link, tick, ADDRESS_BYTES + answered + CRC_BYTES);
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

/* A sound frame of so many bytes, which is no echo, is for us: a command is obeyed and answered, a question has its
 * turn at the end of the tick. returns how much it has done (wire.h) */
static uint32_t take_request(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, uint32_t bytes)
{
    const uint32_t count = bytes - CRC_BYTES;
    forget_question(line, server, tick);
    line->has_question = modbus_pdu_rank(line->link.bytes + ADDRESS_BYTES, count - ADDRESS_BYTES) == ANSWER_QUESTION;
    if (line->has_question) {
        return WIRE_NOTHING;
    }
    (void)answer(line, server, tick, count);
    return WIRE_TAKEN;
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
        return take_request(line, server, tick, link->count);
    } else {
        modbus_link_rest(link);
    }
    return WIRE_NOTHING;
}

/* The master did not wait for an answer: bytes come right behind a frame that was sound while none came. The frame is
 * obeyed if it commands. To answer it now would disturb what is coming, so that is counted.
 * returns how much it has done (wire.h) */
static uint32_t close_unanswered(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    const uint32_t frame = line->sound, more = link->count - frame;
    uint32_t done = WIRE_NOTHING;
    if (more > (uint32_t)MODBUS_AHEAD_BYTES) {
        return done;
    }
    memcpy(line->ahead, link->bytes + frame, more);
    link->count = (uint16_t)frame;
    if (!is_own_answer(line) && is_for_us(link, server)) {
        done = take_request(line, server, tick, frame);
        server->unanswered++;
        brace_count(&tick->counters->requests_lost);
        line->has_question = false;
    }
    modbus_link_rest(link);
    line->ahead_count = (uint8_t)more;
    begin_frame(line);
    take_ahead(line, tick);
    return done;
}

bool modbus_line_has_burst(const modbus_line_t *line)
{
    return line->came > BURST_BYTES;
}

bool modbus_line_hear(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, uint32_t *done)
{
    modbus_link_t *link = &line->link;
    if (link->is_sending || line->has_question) {
        uint16_t looked = 0;
        gather_ahead(line, tick);
        return obey_stop(server, tick, line->ahead, line->ahead_count, &looked);
    }
    const bool bytes_came = gather(line, tick);
    if (bytes_came && line->sound > 0u) {
        *done += close_unanswered(line, server, tick);
    }
    const bool stops = obey_stop(server, tick, link->bytes, link->count, &line->looked);
    const uint32_t silent_us = tick->now_us - link->active_us;
    const bool is_behind = link->count > line->checked + CHECKED_PER_TICK; /* with the check */
    if (bytes_came || silent_us < line->silence_us || is_behind) {
        check_on(line, link->count, CHECKED_PER_TICK);
        const bool is_sound = !bytes_came && !link->is_skipping && line->checked == link->count && line->crc == 0u;
        line->sound = is_sound && link->count >= FRAME_LEAST ? link->count : (uint16_t)0u;
    } else if (link->count > 0u || link->is_skipping) {
        *done += end_frame(line, server, tick, silent_us);
    }
    return stops;
}

/* The question that has just come, or whose K is there. returns how much it has done (wire.h) */
static uint32_t answer_question(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick)
{
    modbus_link_t *link = &line->link;
    const bool waited = !line->has_question;
    if (waited) {
        if (line->asked_count == 0u || link->count > 0u || link->is_sending ||
            brace_app_k_is_coming(tick->app, BRACE_ASKER_MODBUS_LINE)) {
            return WIRE_NOTHING;
        }
        memcpy(link->bytes, line->asked, line->asked_count);
        link->count = (uint16_t)(line->asked_count + CRC_BYTES);
    }
    const uint32_t count = (uint32_t)link->count - CRC_BYTES;
    line->has_question = false;
    if (answer(line, server, tick, count)) {
        line->asked_count = 0;
        return waited ? WIRE_K_ANSWERED : WIRE_TAKEN;
    }
    line->asked_count = count <= sizeof line->asked ? (uint8_t)count : (uint8_t)0u;
    memcpy(line->asked, link->bytes, line->asked_count);
    modbus_link_rest(link);
    return waited ? WIRE_NOTHING : WIRE_TAKEN;
}

uint32_t modbus_line_answer(modbus_line_t *line, modbus_server_t *server, const wire_tick_t *tick, bool has_room)
{
    const uint32_t done = has_room ? answer_question(line, server, tick) : (uint32_t)WIRE_NOTHING;
    if (line->link.is_sending) {
        seal(line, tick);
        modbus_link_send(&line->link, tick, BRACE_SERIAL_MODBUS);
    }
    return done;
}
