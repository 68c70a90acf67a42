#include "can/slcan.h"

#define CR '\r'
#define BEL '\a'

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

static void put(brace_app_slcan_t *slcan, char byte)
{
    slcan->out[slcan->out_count++] = (uint8_t)byte;
}

static void put_hex(brace_app_slcan_t *slcan, uint32_t value, uint32_t digits)
{
    static const char digit[] = "0123456789ABCDEF";
    for (uint32_t i = digits; i > 0u; i--) {
        put(slcan, digit[value >> (4u * (i - 1u)) & 15u]);
    }
}

bool slcan_port_send(brace_app_t *app, const brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    if (!slcan->open || frame->length > 8u) {
        return true;
    }
    if (!flush(app)) {
        return false;
    }
    slcan->out_first = 0;
    put(slcan, 't');
    put_hex(slcan, frame->id, 3);
    put_hex(slcan, frame->length, 1);
    for (uint32_t i = 0; i < frame->length; i++) {
        put_hex(slcan, frame->data[i], 2);
    }
    put(slcan, CR);
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
        put(slcan, text[i]);
    }
    (void)flush(app);
}

/* ------------------------------------------------------------------------------------------ in -- */

static int32_t hex_digit(uint8_t byte)
{
    if (byte >= '0' && byte <= '9') {
        return byte - '0';
    }
    const uint8_t upper = byte & (uint8_t)~0x20u;
    return upper >= 'A' && upper <= 'F' ? upper - 'A' + 10 : -1;
}

/* Digits of a line as a number; false: another character. */
static bool hex_number(const uint8_t *digits, uint32_t count, uint32_t *number)
{
    *number = 0;
    for (uint32_t i = 0; i < count; i++) {
        const int32_t digit = hex_digit(digits[i]);
        if (digit < 0) {
            return false;
        }
        *number = *number << 4 | (uint32_t)digit;
    }
    return true;
}

/* tiiildd... or Tiiiiiiiildd..., r and R without data. */
static bool parse(const brace_app_slcan_t *slcan, brace_can_frame_t *frame)
{
    const uint8_t kind = slcan->line[0];
    const uint32_t id_digits = kind == 'T' || kind == 'R' ? 8u : 3u;
    uint32_t length, byte;
    if (slcan->line_count < 2u + id_digits || !hex_number(&slcan->line[1], id_digits, &frame->id) ||
        !hex_number(&slcan->line[1u + id_digits], 1, &length) || length > 8u) {
        return false;
    }
    const uint32_t bytes = kind == 't' || kind == 'T' ? length : 0u;
    if (slcan->line_count != 2u + id_digits + 2u * bytes || (id_digits == 3u && frame->id > 0x7ffu)) {
        return false;
    }
    for (uint32_t i = 0; i < bytes; i++) {
        if (!hex_number(&slcan->line[2u + id_digits + 2u * i], 2, &byte)) {
            return false;
        }
        frame->data[i] = (uint8_t)byte;
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

static bool take_byte(brace_app_t *app, uint8_t byte, brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    if (byte == '\n') {
        return false;
    }
    if (byte != CR) {
        slcan->too_long = slcan->too_long || slcan->line_count == BRACE_APP_LINE_BYTES;
        if (!slcan->too_long) {
            slcan->line[slcan->line_count++] = byte;
        }
        return false;
    }
    bool is_frame = false;
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

bool slcan_port_receive(brace_app_t *app, brace_can_frame_t *frame)
{
    brace_app_slcan_t *slcan = &app->bus.slcan;
    if (slcan->in_count == 0u) {
        const int32_t read =
            app->hal->serial_read(app->hal->context, BRACE_SERIAL_SLCAN, slcan->in, BRACE_APP_IN_BYTES);
        slcan->in_first = 0;
        slcan->in_count = read > 0 && read <= BRACE_APP_IN_BYTES ? (uint8_t)read : 0u;
    }
    (void)flush(app);
    while (slcan->in_count > 0u) { /* at most BRACE_APP_IN_BYTES */
        slcan->in_count--;
        if (take_byte(app, slcan->in[slcan->in_first++], frame)) {
            return true;
        }
    }
    return false;
}
