/* SysTick as a second clock, by which the self-test judges the door's clock. */
#ifndef BRACE_BOARDS_SECOND_CLOCK_H
#define BRACE_BOARDS_SECOND_CLOCK_H

#include <stdint.h>

enum { SECOND_CLOCK_BITS = 24 };

/* Starts it at the processor's rate. It falls, and wraps. Nobody else uses SysTick until the next start. */
void second_clock_start(void);

/* Its count. The context is not used. */
uint32_t second_clock_count(void *context);

#endif
