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
    entry->lines = 0u;
    entry->is_open = false;
}

static int32_t look_for_key(const brace_hal_t *hal)
{
    key_entry_t kept = {0};
    const int32_t found = hal->key_read(hal->context, kept.key[0]);
    forget(&kept);
    return found;
}

const char *key_entry_words(const brace_hal_t *hal)
{
    if (hal->key_read == NULL) {
        return "";
    }
    switch (look_for_key(hal)) {
    case BRACE_HAL_KEY_NONE: return "none yet; motion is refused until the board has one (word: key)";
    case BRACE_HAL_KEY_LOCKED: return "kept, and its memory is locked";
    case BRACE_HAL_KEY_OPEN:
        return "kept, but its memory is not locked: another image can replace it; a restart tries again";
    case BRACE_HAL_E_DAMAGED:
        return "none: its memory holds a piece of one, or is locked without one; motion is refused";
    default: return "its memory does not answer";
    }
}

bool key_entry_is_possible(text_t *text)
{
    const brace_hal_t *const hal = text->hal;
    if (hal->key_read == NULL || hal->key_write == NULL) {
        say(text, "this board keeps none; it is a bench");
        return false;
    }
    const int32_t found = look_for_key(hal);
    if (found == BRACE_HAL_KEY_LOCKED || found == BRACE_HAL_KEY_OPEN) {
        say(text, "this board has one, and keeps it");
    } else if (found != BRACE_HAL_KEY_NONE && found != BRACE_HAL_E_DAMAGED) {
        say(text, "its memory does not answer");
    }
    return found == BRACE_HAL_KEY_NONE || found == BRACE_HAL_E_DAMAGED;
}

static void await_line(key_entry_t *entry, text_t *text, const char *words)
{
    entry->asked_us = text->hal->now_us(text->hal->context);
    say(text, words);
}

void key_entry_begin(key_entry_t *entry, text_t *text)
{
    forget(entry);
    entry->is_open = true;
    await_line(entry, text, "type its 32 hexadecimal digits and Enter; they are not shown");
}

static int32_t digit_value(char typed)
{
    if (typed >= '0' && typed <= '9') {
        return typed - '0';
    }
    const char lower = (char)(typed | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : NO_DIGIT;
}

/* Reads a line of digits; false: it is no key. */
static bool read_key(const char *line, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    uint32_t digits = 0u;
    for (; *line != '\0'; line++) { /* at most a typed line */
        if (*line == ' ') {
            continue;
        }
        const int32_t value = digit_value(*line);
        if (value == NO_DIGIT || digits == (uint32_t)DIGITS) {
            return false;
        }
        key[digits / 2u] = (uint8_t)((uint32_t)key[digits / 2u] << 4 | (uint32_t)value);
        digits++;
    }
    return digits == (uint32_t)DIGITS;
}

static bool is_same(const key_entry_t *entry)
{
    bool same = true;
    for (uint32_t i = 0u; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        same = same && entry->key[0][i] == entry->key[1][i];
    }
    return same;
}

static void keep(key_entry_t *entry, text_t *text)
{
    if (!is_same(entry)) {
        say(text, "the two lines differ; nothing was kept. The word key begins again");
        return;
    }
    switch (text->hal->key_write(text->hal->context, entry->key[0])) {
    case BRACE_HAL_OK: say(text, "kept, and its memory is locked. The board is guarded from its next start on"); break;
    case BRACE_HAL_AGAIN:
        say(text,
            "kept, but its memory is not locked yet; the next start tries again. The board is guarded from then on");
        break;
    default: say(text, "the memory did not take it. The word key tries again"); break;
    }
}

void key_entry_take(key_entry_t *entry, text_t *text, const char *line)
{
    if (!read_key(line, entry->key[entry->lines])) {
        forget(entry);
        say(text, "those are not 32 hexadecimal digits; nothing was kept. The word key begins again");
        return;
    }
    entry->lines++;
    if (entry->lines == 1u) {
        await_line(entry, text, "and the same once more");
        return;
    }
    keep(entry, text);
    forget(entry);
}

void key_entry_refuse_echo(key_entry_t *entry, text_t *text)
{
    if (entry->is_open) {
        forget(entry);
        say(text, "this terminal echoes, so a key is not taken from it; nothing was kept");
    }
}

void key_entry_serve(key_entry_t *entry, text_t *text)
{
    const uint32_t now_us = text->hal->now_us(text->hal->context);
    if (entry->is_open && now_us - entry->asked_us >= (uint32_t)KEY_ENTRY_PATIENCE_US) {
        forget(entry);
        say(text, "nobody typed it for 120 s; nothing was kept");
    }
}
