/* Text on the console without a C library: strings, numbers, names. Before the first tick it waits for room on the
 * line, but not for ever. From then on it is kept, and goes out between ticks as the line has room: no tick waits for
 * a person who reads.
 *
 * Every line begins with TEXT_PREFIX. By it the console knows its own lines when something sends them back (typed.h).
 */
#ifndef BRACE_BOARDS_TEXT_H
#define BRACE_BOARDS_TEXT_H

#include "brace_hal.h"

#define TEXT_PREFIX "# "

enum { TEXT_BYTES = 2048 }; /* the longest answer to one request */

typedef struct {
    const brace_hal_t *hal;
    bool gone; /* the console took nothing for 0.1 s, or what is kept is full: later text is dropped */
    bool keeps;
    bool is_within_line; /* the line has its prefix */
    uint32_t count, sent; /* of bytes */
    uint8_t bytes[TEXT_BYTES];
} text_t;

/* Somebody listens again: later text is no longer dropped. */
void text_again(text_t *text);

/* From here on text is kept. */
void text_keep(text_t *text);

/* Sends what the line has room for, and does not wait. true: nothing is left. */
bool text_serve(text_t *text);

/* Sends what is kept and waits for it, and no longer keeps text. For what stops the ticks anyway. */
void text_wait(text_t *text);

void text_string(text_t *text, const char *string);
void text_unsigned(text_t *text, uint32_t value);
void text_signed(text_t *text, int32_t value);
void text_hex(text_t *text, uint32_t value);  /* 0x and eight digits */
void text_line(text_t *text); /* end of line */

#endif
