/* The console: words that end with Enter; `help` lists them. It is served between ticks.
 *
 * A word that changes something is asked about first (question.h). A terminal that echoes, or another machine on the
 * line, starts nothing: the console knows its own lines (typed.h), and answers CONSOLE_STRANGE_LINES lines that it
 * does not know, until it hears a word that it knows. */
#ifndef BRACE_BOARDS_CONSOLE_H
#define BRACE_BOARDS_CONSOLE_H

#include "brace/app.h"
#include "key_entry.h"
#include "question.h"
#include "text.h"
#include "typed.h"

enum { CONSOLE_STRANGE_LINES = 3 };

typedef struct {
    text_t text;
    typed_t typed;
    question_t question;
    uint32_t asked;          /* about which word; its place in the table */
    key_entry_t key_entry;
    bool has_reported_echo;   /* since the last word that it knows */
    uint32_t strange_lines;  /* since then; saturates */
    bool has_line;           /* typed.line waits for room on the line */
} console_t;

/* Takes what has been typed, at most 32 characters, and does what at most one line asks for. Most answers take a few
 * ms, and the next tick is late by as much. The self-test ends in a restart. */
void console_serve(console_t *console, brace_app_t *app);

#endif
