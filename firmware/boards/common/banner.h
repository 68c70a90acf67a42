/* What a controller says when it starts: lines `key: value`, so that people and scripts read the same. */
#ifndef BRACE_BOARDS_BANNER_H
#define BRACE_BOARDS_BANNER_H

#include "brace/app.h"
#include "text.h"

/* Board, version, why it started, the last crash: needs nothing but the door. */
void banner_image(text_t *text);

/* What the application came to: parameters in force, stack. */
void banner_application(text_t *text, const brace_app_t *app, brace_status_t started);

#endif
