/* Faults on request: in the crash-test images only, so that the record of each kind can be seen to be right. */
#ifndef BRACE_BOARDS_PROVOKE_H
#define BRACE_BOARDS_PROVOKE_H

#include "text.h"

void provoke_help(text_t *text);

/* Does not return for a request it knows. */
void provoke(uint8_t request);

#endif
