/* Clocks and time. */
#ifndef STM32F405_CLOCK_H
#define STM32F405_CLOCK_H

#include "brace_hal_stm32f405.h"

/* Brings the processor to 168 MHz, starts the microsecond counter, and fills in stm32f405_clock_report. */
void clock_start(uint32_t hse_hz, const stm32f405_clocks_t *given);

const stm32f405_clock_report_t *clock_report(void);

/* The crystal has stopped while it fed the clocks: starts the PLL again from the chip's own oscillator, with the same
 * rates. At most 11 ms; typically 0.5 ms, in which time counts slowly.
 * returns false: the PLL does not start, and the processor runs at 16 MHz with the dividers of 168 */
bool clock_goes_on_without_crystal(void);

/* Time since clock_start [us]. */
uint32_t clock_now_us(void);

/* As poll_until, with the clock: false after timeout_us [us, below 1e7], or after timeout_us * 21 polls. A poll takes 8
 * cycles at 168 MHz, so the count ends the wait even when the counter stands still. */
bool clock_poll_until(volatile const uint32_t *place, uint32_t mask, uint32_t wanted, uint32_t timeout_us);

#endif
