/* The slow oscillator (LSI) that clocks the watchdog. */
#ifndef STM32F405_LSI_H
#define STM32F405_LSI_H

#include <stdint.h>

/* The LSI's frequency [Hz], measured over eight of its periods with TIM5, whose clock is timer_hz (17-47 kHz over all
 * chips; RM0090 7.2.11). Starts the LSI if it does not run. 0: it cannot be measured (an emulator). Takes at most 5
 * ms. */
uint32_t lsi_measure_hz(uint32_t timer_hz);

#endif
