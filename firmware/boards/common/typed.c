#include "typed.h"

#include "text.h"

enum { CTRL_C = 0x03, BACKSPACE = 0x08, CTRL_U = 0x15, DELETE = 0x7f };

static bool is_blank(char character)
{
    return character == ' ' || character == '\t';
}

static void begin_line(typed_t *typed)
{
    typed->count = 0u;
    typed->is_spoilt = false;
}

/* A terminal that shows control characters sends an end of line back as "^M". */
static bool is_echoed_end(const typed_t *typed)
{
    return typed->count == 2u && typed->line[0] == '^' && typed->line[1] == 'M';
}

static typed_event_t end_line(typed_t *typed)
{
    while (typed->count > 0u && is_blank(typed->line[typed->count - 1u])) { /* at most TYPED_MOST */
        typed->count--;
    }
    const bool is_empty = typed->count == 0u || is_echoed_end(typed);
    typed->line[typed->is_spoilt ? 0u : typed->count] = '\0';
    const typed_event_t event = is_empty && !typed->is_spoilt ? TYPED_NOTHING : TYPED_LINE;
    begin_line(typed);
    return event;
}

static void add(typed_t *typed, uint8_t byte)
{
    const bool is_printable = byte >= (uint8_t)' ' && byte < (uint8_t)DELETE;
    if (typed->count == (uint32_t)TYPED_MOST || (!is_printable && byte != (uint8_t)'\t')) {
        typed->is_spoilt = true;
    } else if (typed->count > 0u || !is_blank((char)byte)) {
        typed->line[typed->count] = (char)byte;
        typed->count++;
    }
}

typed_event_t typed_take(typed_t *typed, uint8_t byte, uint32_t now_us)
{
    typed_serve(typed, now_us);
    if (typed->is_deaf) {
        typed->heard_us = now_us;
        return TYPED_NOTHING;
    }
    if (typed->count == 0u && byte == (uint8_t)TEXT_PREFIX[0]) {
        typed->is_deaf = true;
        typed->heard_us = now_us;
        return TYPED_ECHO;
    }
    switch (byte) {
    case '\r':
    case '\n': return end_line(typed);
    case BACKSPACE:
    case DELETE: typed->count -= typed->count > 0u; break;
    case CTRL_C:
    case CTRL_U: begin_line(typed); break;
    default: add(typed, byte); break;
    }
    return TYPED_NOTHING;
}

void typed_serve(typed_t *typed, uint32_t now_us)
{
    if (typed->is_deaf && now_us - typed->heard_us >= (uint32_t)TYPED_QUIET_US) {
        typed->is_deaf = false;
        begin_line(typed);
    }
}

bool typed_is(const typed_t *typed, const char *word)
{
    uint32_t at = 0u;
    while (word[at] != '\0' && typed->line[at] == word[at]) { /* at most a word of the console's */
        at++;
    }
    return word[at] == '\0' && typed->line[at] == '\0';
}

void typed_forget(typed_t *typed)
{
    volatile char *characters = typed->line; /* volatile: the compiler must not leave this out */
    for (uint32_t i = 0u; i < (uint32_t)sizeof typed->line; i++) {
        characters[i] = '\0';
    }
    begin_line(typed);
}
