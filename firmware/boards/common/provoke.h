/* Crashes on purpose, for the crash-test images: one word a fault. */
#ifndef BRACE_BOARDS_PROVOKE_H
#define BRACE_BOARDS_PROVOKE_H

#include "text.h"
#include "typed.h"

void provoke_help(text_t *text);

/* How many such words there are. */
uint32_t provoke_count(void);

/* The number of a typed word; provoke_count(): it is none of them. */
uint32_t provoke_find(const typed_t *typed);

/* Crashes; an impossible number does nothing. */
void provoke(uint32_t crash);

#endif
