/* A crash record in words, for whoever reads the console. */
#ifndef BRACE_BOARDS_CRASH_WORDS_H
#define BRACE_BOARDS_CRASH_WORDS_H

#include "brace_hal.h"

/* "usage fault", "bus fault", ...: by the exception's number. */
const char *crash_exception(const brace_crash_record_t *record);

/* The processor's account, most telling bit first; stack_limit: lowest address of the stack. */
const char *crash_reason(const brace_crash_record_t *record, uint32_t stack_limit);

#endif
