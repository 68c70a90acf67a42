/* The independent watchdog, why the processor started, and starting it anew. */
#ifndef STM32F405_WATCHDOG_H
#define STM32F405_WATCHDOG_H

#include "brace_hal_stm32f405.h"

/* Once, first thing: reads the reset flags and clears them for the next time. */
void reset_cause_take(bool by_fault);
brace_reset_cause_t reset_cause_read(void *context);

/* Starts it, with a patience of 3.5 s by the LSI as measured with a timer clock of timer_hz; it can not be stopped.
 * Halts with the processor under a debugger. */
void watchdog_start(uint32_t timer_hz);
void watchdog_feed(void *context);

/* Does not return, on the chip. */
void processor_restart(void *context);

#endif
