/* Faults on request, in the crash-test images only: a test provokes each kind and checks its record. */
#ifndef BRACE_BOARDS_PROVOKE_H
#define BRACE_BOARDS_PROVOKE_H

#include "text.h"

void provoke_help(text_t *text);

/* Causes the fault that the character asks for. It returns only for a character that it does not know. */
void provoke(uint8_t request);

#endif
