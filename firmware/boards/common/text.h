/* Text on the console without a C library: strings, numbers, names. It waits for room, but not for ever. */
#ifndef BRACE_BOARDS_TEXT_H
#define BRACE_BOARDS_TEXT_H

#include "brace_hal.h"

typedef struct {
    const brace_hal_t *hal;
    bool gone; /* the console took nothing for 0.1 s: later text is dropped without waiting */
} text_t;

void text_string(text_t *text, const char *string);
void text_unsigned(text_t *text, uint32_t value);
void text_signed(text_t *text, int32_t value);
void text_hex(text_t *text, uint32_t value);  /* 0x and eight digits */
void text_line(text_t *text); /* end of line */

#endif
