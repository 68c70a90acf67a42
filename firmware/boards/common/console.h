/* Requests on the console, one character each; '?' lists them. The console is served between ticks. */
#ifndef BRACE_BOARDS_CONSOLE_H
#define BRACE_BOARDS_CONSOLE_H

#include "brace/app.h"
#include "text.h"

/* Reads at most one character and does what it asks for. Most answers take a few ms, and the next tick is late by as
 * much. The self-test ends in a restart. */
void console_serve(text_t *text, brace_app_t *app);

#endif
