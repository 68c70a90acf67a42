/* The supply: at which voltage the chip resets, and whether it is falling. */
#ifndef STM32F405_SUPPLY_H
#define STM32F405_SUPPLY_H

#include <stdbool.h>

/* Sets the brown-out reset to its highest level, about 2.8 V, unless it is set already, and starts the detector at
 * 2.9 V. At 168 MHz with flash words of 32 bits the data sheet asks for 2.7 V: below that the processor shall stand in
 * reset. The level is an option of the flash. It is written once in a chip's life and holds from the next reset on. */
void supply_start(void);

/* Does the supply lie below the detector's 2.9 V? Then nothing is written to flash or erased. false before
 * supply_start. */
bool supply_is_low(void);

#endif
