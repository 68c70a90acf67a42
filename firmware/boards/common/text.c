#include "text.h"

enum { PATIENCE_US = 100000, ROUNDS_MAX = 1000000 };

static void write_out(text_t *text, const uint8_t *bytes, uint32_t count)
{
    const brace_hal_t *const hal = text->hal;
    const uint32_t began_us = hal->now_us(hal->context);
    uint32_t rounds = 0u;
    while (count > 0u && !text->gone) { /* at most count + ROUNDS_MAX turns */
        const int32_t taken = hal->serial_write(hal->context, BRACE_SERIAL_CONSOLE, bytes, count);
        if (taken > 0) {
            bytes += taken;
            count -= (uint32_t)taken;
            continue;
        }
        rounds++; /* ends the wait when the clock stands */
        if (taken < 0 || rounds > ROUNDS_MAX || hal->now_us(hal->context) - began_us > PATIENCE_US) {
            text->gone = true;
        }
    }
}

static void keep_or_write(text_t *text, const char *characters, uint32_t count)
{
    const uint8_t *const bytes = (const uint8_t *)characters;
    if (!text->keeps) {
        write_out(text, bytes, count);
        return;
    }
    text->gone = text->gone || count > TEXT_BYTES - text->count;
    for (uint32_t i = 0u; i < count && !text->gone; i++) {
        text->bytes[text->count] = bytes[i];
        text->count++;
    }
}

static void put(text_t *text, const char *characters, uint32_t count)
{
    if (!text->is_within_line) {
        text->is_within_line = true;
        keep_or_write(text, TEXT_PREFIX, (uint32_t)sizeof TEXT_PREFIX - 1u);
    }
    keep_or_write(text, characters, count);
}

void text_again(text_t *text)
{
    if (text->gone) {
        text->gone = false;
        text_line(text); /* behind the line that was cut */
    }
}

void text_keep(text_t *text)
{
    text->keeps = true;
    text->count = text->sent = 0u;
}

bool text_serve(text_t *text)
{
    if (text->sent < text->count) {
        const int32_t taken = text->hal->serial_write(text->hal->context, BRACE_SERIAL_CONSOLE,
                                                      &text->bytes[text->sent], text->count - text->sent);
        text->sent = taken >= 0 ? text->sent + (uint32_t)taken : text->count; /* a line that fails takes nothing */
    }
    if (text->sent == text->count) {
        text->count = text->sent = 0u;
    }
    return text->count == 0u;
}

void text_wait(text_t *text)
{
    text->keeps = false;
    write_out(text, &text->bytes[text->sent], text->count - text->sent);
    text->count = text->sent = 0u;
}

void text_string(text_t *text, const char *string)
{
    uint32_t length = 0u;
    while (string[length] != '\0') { /* at most a line of text, written here */
        length++;
    }
    put(text, string, length);
}

void text_unsigned(text_t *text, uint32_t value)
{
    enum { DIGITS = 10 };
    char digits[DIGITS];
    uint32_t at = DIGITS;
    do {
        at--;
        digits[at] = (char)('0' + value % 10u);
        value /= 10u;
    } while (value != 0u);
    put(text, digits + at, DIGITS - at);
}

void text_signed(text_t *text, int32_t value)
{
    if (value < 0) {
        put(text, "-", 1u);
    }
    text_unsigned(text, value < 0 ? 0u - (uint32_t)value : (uint32_t)value);
}

void text_hex(text_t *text, uint32_t value)
{
    enum { NIBBLES = 8 };
    char digits[NIBBLES];
    for (uint32_t i = 0u; i < NIBBLES; i++) {
        digits[i] = "0123456789abcdef"[(value >> (4u * (NIBBLES - 1u - i))) & 0xfu];
    }
    put(text, "0x", 2u);
    put(text, digits, NIBBLES);
}

void text_line(text_t *text)
{
    text->is_within_line = false;
    keep_or_write(text, "\r\n", 2u);
}
