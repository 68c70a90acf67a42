#include "slcan_text.h"

#include <string.h>

static const uint8_t fd_length[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    if (c >= 'A' && c <= 'F') {
        return c - 'A' + 10;
    }
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Value of a hex digit. false: the character is no hex digit. */
static bool hex_number(const char *text, uint32_t digits, uint32_t *number)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < digits; i++) {
        const int digit = hex_digit(text[i]);
        if (digit < 0) {
            return false;
        }
        value = value << 4 | (uint32_t)digit;
    }
    *number = value;
    return true;
}

bool posix_slcan_read(const char *text, uint32_t length, brace_posix_wire_frame_t *frame)
{
    brace_posix_wire_frame_t read = {{0}, false, false};
    const char kind = length > 0u ? text[0] : '\0';
    read.extended = kind == 'T' || kind == 'R';
    read.remote = kind == 'r' || kind == 'R';
    read.frame.fd = kind == 'd' || kind == 'b';
    if (!read.extended && kind != 't' && kind != 'r' && !read.frame.fd) {
        return false;
    }
    const uint32_t id_digits = read.extended ? 8u : 3u;
    uint32_t code;
    if (length < 2u + id_digits || !hex_number(text + 1, id_digits, &read.frame.id) ||
        !hex_number(text + 1 + id_digits, 1, &code) || read.frame.id > (read.extended ? 0x1fffffffu : 0x7ffu) ||
        (!read.frame.fd && code > 8u)) {
        return false;
    }
    read.frame.length = fd_length[code];
    const uint32_t data_bytes = read.remote ? 0u : read.frame.length;
    if (length != 2u + id_digits + 2u * data_bytes) {
        return false;
    }
    for (uint32_t i = 0; i < data_bytes; i++) {
        uint32_t byte;
        if (!hex_number(text + 2 + id_digits + 2u * i, 2, &byte)) {
            return false;
        }
        read.frame.data[i] = (uint8_t)byte;
    }
    *frame = read;
    return true;
}

static char *put_hex(char *to, uint32_t number, uint32_t digits)
{
    for (uint32_t i = 0; i < digits; i++) {
        to[i] = "0123456789ABCDEF"[number >> (4u * (digits - 1u - i)) & 0xfu];
    }
    return to + digits;
}

uint32_t posix_slcan_write(const brace_posix_wire_frame_t *frame, int32_t stamp_ms, char *line)
{
    const brace_can_frame_t *can = &frame->frame;
    char *end = line;
    const char kind = frame->remote ? 'r' : can->fd ? 'b' : 't';
    *end++ = frame->extended && kind != 'b' ? (char)(kind - 'a' + 'A') : kind;
    end = put_hex(end, can->id, frame->extended ? 8u : 3u);
    uint32_t code = 0;
    while (code < 15u && fd_length[code] < can->length) {
        code++;
    }
    end = put_hex(end, code, 1);
    for (uint32_t i = 0; !frame->remote && i < can->length; i++) {
        end = put_hex(end, can->data[i], 2);
    }
    if (stamp_ms >= 0) {
        end = put_hex(end, (uint32_t)stamp_ms, 4);
    }
    *end++ = '\r';
    return (uint32_t)(end - line);
}

uint32_t posix_slcan_bit_rate(char digit)
{
    static const uint32_t rate[] = {10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000, 1000000};
    return digit >= '0' && digit <= '8' ? rate[digit - '0'] : 0u;
}
