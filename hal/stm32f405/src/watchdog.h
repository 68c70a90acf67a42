/* The independent watchdog, the cause of the last reset, and the restart. */
#ifndef STM32F405_WATCHDOG_H
#define STM32F405_WATCHDOG_H

#include "brace_hal_stm32f405.h"

/* Call once, first of all. Reads the reset flags, and clears them for the next start. */
void reset_cause_take(bool by_fault);
brace_reset_cause_t reset_cause_read(void *context);

/* Starts the watchdog. It waits 3.5 s by the LSI, which is measured with a timer clock of timer_hz. It cannot be
 * stopped, but halts with the processor under a debugger. */
void watchdog_start(uint32_t timer_hz);
void watchdog_feed(void *context);

/* On the chip this does not return. */
void processor_restart(void *context);

#endif
