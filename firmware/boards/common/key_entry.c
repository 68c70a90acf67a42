#include "key_entry.h"

#include <stddef.h>

enum { DIGITS = 2 * BRACE_HAL_KEY_BYTES, NO_DIGIT = -1 };

static void say(text_t *text, const char *words)
{
    text_string(text, "key: ");
    text_string(text, words);
    text_line(text);
}

static void forget(key_entry_t *entry)
{
    volatile uint8_t *bytes = &entry->key[0][0]; /* volatile: the compiler must not leave this out */
    for (uint32_t i = 0u; i < (uint32_t)sizeof entry->key; i++) {
        bytes[i] = 0u;
    }
    entry->digits = 0u;
    entry->is_open = false;
}

/* returns 1: there is a key; 0: none yet; negative: its memory does not answer */
static int32_t look_for_key(const brace_hal_t *hal)
{
    key_entry_t kept = {0};
    const int32_t found = hal->key_read(hal->context, kept.key[0]);
    forget(&kept);
    return found;
}

void key_entry_begin(key_entry_t *entry, text_t *text)
{
    const brace_hal_t *const hal = text->hal;
    forget(entry);
    if (hal->key_read == NULL || hal->key_write == NULL) {
        say(text, "this board keeps none; it is a bench");
        return;
    }
    const int32_t found = look_for_key(hal);
    entry->is_open = found == 0;
    say(text, found == 0  ? "type its 32 hexadecimal digits, twice; this board keeps them for ever"
              : found > 0 ? "this board has one, and keeps it"
                          : "its memory does not answer");
}

static int32_t digit_value(uint8_t typed)
{
    if (typed >= (uint8_t)'0' && typed <= (uint8_t)'9') {
        return typed - '0';
    }
    const uint8_t lower = typed | 0x20u;
    return lower >= (uint8_t)'a' && lower <= (uint8_t)'f' ? lower - 'a' + 10 : NO_DIGIT;
}

static void keep(key_entry_t *entry, text_t *text)
{
    bool is_same = true;
    for (uint32_t i = 0u; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        is_same = is_same && entry->key[0][i] == entry->key[1][i];
    }
    if (!is_same) {
        say(text, "the two differ; nothing was kept. K begins again");
    } else if (text->hal->key_write(text->hal->context, entry->key[0]) == BRACE_HAL_OK) {
        say(text, "kept. The board is guarded from its next start on: r restarts it");
    } else {
        say(text, "the memory did not take it. K tries again");
    }
    forget(entry);
}

void key_entry_take(key_entry_t *entry, text_t *text, uint8_t typed)
{
    if (typed == (uint8_t)' ' || typed == (uint8_t)'\r' || typed == (uint8_t)'\n') {
        return;
    }
    const int32_t value = digit_value(typed);
    if (value == NO_DIGIT) {
        forget(entry);
        say(text, "that is no hexadecimal digit; nothing was kept. K begins again");
        return;
    }
    uint8_t *const byte = &entry->key[entry->digits / (uint32_t)DIGITS][entry->digits % (uint32_t)DIGITS / 2u];
    *byte = (uint8_t)((uint32_t)*byte << 4 | (uint32_t)value);
    entry->digits++;
    if (entry->digits == (uint32_t)DIGITS) {
        say(text, "and again");
    }
    if (entry->digits == 2u * (uint32_t)DIGITS) {
        keep(entry, text);
    }
}
