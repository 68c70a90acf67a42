/* Requests on the console, a character each; '?' lists them. Served between ticks. */
#ifndef BRACE_BOARDS_CONSOLE_H
#define BRACE_BOARDS_CONSOLE_H

#include "brace/app.h"
#include "text.h"

/* Reads at most one character and does what it asks. Most answers take a few ms, which a tick then comes late by; the
 * self-test ends in a restart. */
void console_serve(text_t *text, const brace_app_t *app);

#endif
