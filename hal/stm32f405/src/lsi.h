/* The slow oscillator that the watchdog counts by. */
#ifndef STM32F405_LSI_H
#define STM32F405_LSI_H

#include <stdint.h>

/* Its frequency [Hz], measured over eight of its periods with TIM5 (17-47 kHz over all chips; RM0090 7.2.11), by a
 * timer clock of timer_hz; started if it is not running. 0: it can not be measured (an emulator). At most 5 ms. */
uint32_t lsi_measure_hz(uint32_t timer_hz);

#endif
