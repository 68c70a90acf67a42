/* A crash record in words, for the person who reads the console. */
#ifndef BRACE_BOARDS_CRASH_WORDS_H
#define BRACE_BOARDS_CRASH_WORDS_H

#include "brace_hal.h"

/* "usage fault", "bus fault", ...: the name of an exception, from its number. */
const char *crash_exception(const brace_crash_record_t *record);

/* The processor's reason: the bit that says most comes first. stack_limit: lowest address of the stack. */
const char *crash_reason(const brace_crash_record_t *record, uint32_t stack_limit);

#endif
