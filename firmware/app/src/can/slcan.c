#include "can/slcan.h"

#include <string.h>

#define CR '\r'
#define BEL '\a'
#define LINES_MOST 4u /* in a tick */

void slcan_port_start(brace_app_t *app)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    const brace_hal_t *hal = app->hal;
    *slcan = (brace_app_slcan_t){0};
    slcan->fitted =
        hal->serial_setup != NULL && hal->serial_read != NULL && hal->serial_write != NULL &&
        hal->serial_setup(hal->context, BRACE_SERIAL_SLCAN, SLCAN_BAUD, BRACE_PARITY_NONE) == BRACE_HAL_OK;
}

/* ----------------------------------------------------------------------------------------- out -- */

/* false: part of a line still waits. */
static bool flush(brace_app_t *app)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    if (slcan->out_count > 0u) {
        const int32_t written = app->hal->serial_write(app->hal->context, BRACE_SERIAL_SLCAN,
                                                       &slcan->out[slcan->out_first], slcan->out_count);
        if (written > 0 && written <= slcan->out_count) {
            slcan->out_first = (uint8_t)(slcan->out_first + written);
            slcan->out_count = (uint8_t)(slcan->out_count - written);
        }
    }
    return slcan->out_count == 0u;
}

/* Two bytes as four digits, all at once: a byte of the word is a digit, the first one lowest. */
static inline void put_four(uint8_t *to, uint32_t first, uint32_t second)
{
    const uint32_t pair = first | second << 16;
    const uint32_t nibbles = (pair >> 4 & 0x000f000fu) | (pair & 0x000f000fu) << 8;
    const uint32_t letters = (nibbles + 0x06060606u) >> 4 & 0x01010101u;
    const uint32_t digits = nibbles + 0x30303030u + 7u * letters;
    memcpy(to, &digits, 4);
}

bool slcan_port_send(brace_app_t *app, const brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    if (!slcan->open || frame->length > 8u) {
        return true;
    }
    if (slcan->out_count > 0u && !flush(app)) {
        return false;
    }
    const uint32_t count = frame->length;
    uint8_t *out = slcan->out;
    put_four(out, frame->id >> 8, frame->id & 0xffu);
    out[0] = 't';
    out[4] = (uint8_t)('0' + count);
    for (uint32_t i = 0; i < count; i += 2u) {
        put_four(out + 5u + 2u * i, frame->data[i], frame->data[i + 1u]);
    }
    out[5u + 2u * count] = CR;
    slcan->out_first = 0;
    slcan->out_count = (uint8_t)(6u + 2u * count);
    (void)flush(app);
    return true;
}

/* An answer to a command: a few bytes. What finds no room is lost, as an adapter's is. */
static void answer(brace_app_t *app, const char *text, uint32_t count)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    if (!flush(app)) {
        return;
    }
    slcan->out_first = 0;
    for (uint32_t i = 0; i < count; i++) {
        slcan->out[slcan->out_count++] = (uint8_t)text[i];
    }
    (void)flush(app);
}

/* ------------------------------------------------------------------------------------------ in -- */

/* Four digits at once; a byte of the result is a digit's number. Anything else sets a bit of *wrong. */
static inline uint32_t four_digits(const uint8_t *text, uint32_t *wrong)
{
    uint32_t digits;
    memcpy(&digits, text, 4);
    const uint32_t small = digits | 0x20202020u;
    const uint32_t numbers = (small & 0x0f0f0f0fu) + 9u * (small >> 6 & 0x01010101u);
    const uint32_t nibbles = numbers & 0x0f0f0f0fu, letters = (nibbles + 0x06060606u) >> 4 & 0x01010101u;
    *wrong |= (nibbles + 0x30303030u + 39u * letters) ^ small; /* it must be what these digits are written as */
    *wrong |= ~(digits | digits >> 1) & 0x20202020u;           /* and have been a character, not a control code */
    return nibbles;
}

static inline uint32_t number_of(uint32_t nibbles) /* the first digit is the highest */
{
    const uint32_t pairs = (nibbles & 0x000f000fu) << 4 | (nibbles >> 8 & 0x000f000fu);
    return (pairs & 0xffu) << 8 | pairs >> 16;
}

/* tiiildd... or Tiiiiiiiildd..., r and R without data. */
static bool parse(brace_app_slcan_t *slcan, brace_can_frame_t *frame)
{
    const uint8_t kind = slcan->line[0], *line = slcan->line;
    const uint32_t id_digits = kind == 'T' || kind == 'R' ? 8u : 3u;
    const uint32_t length = (uint32_t)line[1u + id_digits] - '0', count = slcan->line_count;
    const uint32_t bytes = kind == 't' || kind == 'T' ? length : 0u;
    uint32_t wrong = 0;
    if (count < 2u + id_digits || length > 8u || count != 2u + id_digits + 2u * bytes) {
        return false;
    }
    if (id_digits == 3u) {
        const uint8_t id[4] = {'0', line[1], line[2], line[3]};
        frame->id = number_of(four_digits(id, &wrong));
        wrong |= frame->id & ~0x7ffu;
    } else {
        frame->id = number_of(four_digits(line + 1, &wrong)) << 16 | number_of(four_digits(line + 5, &wrong));
    }
    if ((bytes & 1u) != 0u) { /* an even number goes through */
        slcan->line[count] = slcan->line[count + 1u] = '0';
    }
    const uint8_t *digits = &line[2u + id_digits];
    for (uint32_t i = 0; i < bytes; i += 2u) {
        const uint32_t pair = number_of(four_digits(digits + 2u * i, &wrong));
        frame->data[i] = (uint8_t)(pair >> 8);
        frame->data[i + 1u] = (uint8_t)pair;
    }
    if (wrong != 0u) {
        return false;
    }
    frame->length = (uint8_t)length;
    frame->fd = false;
    return true;
}

static bool digit_up_to(const brace_app_slcan_t *slcan, uint8_t highest)
{
    return slcan->line_count == 2u && slcan->line[1] >= '0' && slcan->line[1] <= highest;
}

/* A line is whole. true: it is a frame for the node. */
static bool obey(brace_app_t *app, brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    const uint8_t kind = slcan->line_count > 0u ? slcan->line[0] : (uint8_t)CR;
    const bool alone = slcan->line_count == 1u;
    bool good = false;
    switch (kind) {
    case CR: good = true; break; /* whoever connects clears the line with a few of them */
    case 'S': good = !slcan->open && digit_up_to(slcan, '8'); break;
    case 's': good = !slcan->open; break;
    case 'Z': good = !slcan->open && digit_up_to(slcan, '0'); break;
    case 'O':
    case 'L':
        good = alone && !slcan->open;
        slcan->open = slcan->open || good;
        slcan->listen_only = good ? kind == 'L' : slcan->listen_only;
        break;
    case 'C':
        good = alone;
        slcan->open = slcan->open && !good;
        break;
    case 'V': answer(app, "V1013\r", 6); return false;
    case 'v': answer(app, "v0100\r", 6); return false;
    case 'N': answer(app, "NBRC1\r", 6); return false;
    case 'F': answer(app, slcan->open ? "F00\r" : "\a", slcan->open ? 4u : 1u); return false;
    case 't':
    case 'T':
    case 'r':
    case 'R':
        if (slcan->open && !slcan->listen_only && parse(slcan, frame)) {
            answer(app, kind == 't' || kind == 'r' ? "z\r" : "Z\r", 2);
            return kind == 't';
        }
        break;
    default: break;
    }
    const char word = good ? CR : BEL;
    answer(app, &word, 1);
    return false;
}

/* A line has come to its end. true: it is a frame for the node. */
static bool take_line(brace_app_t *app, brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    bool is_frame = false;
    if (slcan->line_count > 0u && slcan->line[0] == '\n') { /* of whoever ends lines with both */
        slcan->line_count--;
        memmove(slcan->line, slcan->line + 1, slcan->line_count);
    }
    if (slcan->too_long) {
        const char bell = BEL;
        answer(app, &bell, 1);
    } else {
        is_frame = obey(app, frame);
    }
    slcan->line_count = 0;
    slcan->too_long = false;
    return is_frame;
}

/* What was read, up to the end of a line. returns whether there was one */
static bool gather(brace_app_slcan_t *slcan)
{
    const uint8_t *from = &slcan->in[slcan->in_first];
    uint8_t *to = &slcan->line[slcan->line_count];
    const uint32_t here = slcan->in_count, room = (uint32_t)BRACE_APP_LINE_BYTES - slcan->line_count;
    uint32_t count = 0;
    for (; count < here && from[count] != CR && count < room; count++) { /* at most BRACE_APP_IN_BYTES */
        to[count] = from[count];
    }
    slcan->line_count = (uint8_t)(slcan->line_count + count);
    slcan->too_long = slcan->too_long || (count < here && from[count] != CR);
    while (count < here && from[count] != CR) { /* what is too long goes by */
        count++;
    }
    const bool whole = count < here;
    count += whole;
    slcan->in_first = (uint8_t)(slcan->in_first + count);
    slcan->in_count = (uint8_t)(slcan->in_count - count);
    return whole;
}

bool slcan_port_receive(brace_app_t *app, brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    bool is_frame = false;
    slcan->heard = false;
    if (!slcan->fitted) {
        return false;
    }
    if (slcan->in_count == 0u) {
        const int32_t read =
            app->hal->serial_read(app->hal->context, BRACE_SERIAL_SLCAN, slcan->in, BRACE_APP_IN_BYTES);
        slcan->in_first = 0;
        slcan->in_count = read > 0 && read <= BRACE_APP_IN_BYTES ? (uint8_t)read : 0u;
    }
    if (slcan->out_count > 0u) {
        (void)flush(app);
    }
    for (uint32_t i = 0; i < LINES_MOST && !is_frame && slcan->in_count > 0u; i++) {
        slcan->heard = true;
        is_frame = gather(slcan) && take_line(app, frame);
    }
    return is_frame;
}
