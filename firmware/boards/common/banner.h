/* What a controller prints when it starts: lines `key: value`, so that people and scripts read the same. */
#ifndef BRACE_BOARDS_BANNER_H
#define BRACE_BOARDS_BANNER_H

#include "brace/app.h"
#include "text.h"

/* Prints board, version, cause of the start and the last crash. It uses only the door. */
void banner_image(text_t *text);

/* Prints what the application has found: parameters in force, stack. */
void banner_application(text_t *text, const brace_app_t *app, brace_status_t started);

#endif
