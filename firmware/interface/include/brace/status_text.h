/* Statuses for people to read. No controller calls this: on a wire a status is its number. */
#ifndef BRACE_STATUS_TEXT_H
#define BRACE_STATUS_TEXT_H

#include "brace/status.h"

/* One line of English for a status, never null; constant storage. */
const char *brace_status_text(brace_status_t status);

#endif
