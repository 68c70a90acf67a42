/* Pins. A pin whose port is 0 is not connected, and every call for it does nothing. */
#ifndef STM32F405_PINS_H
#define STM32F405_PINS_H

#include "brace_hal_stm32f405.h"

bool pin_is_connected(stm32f405_pin_t pin);

/* Gives the pin to a peripheral: function 0-15, with a weak pull-up so that an open line reads idle. */
void pin_give(stm32f405_pin_t pin, uint32_t function);

/* Makes the pin a low output. */
void pin_drive_low(stm32f405_pin_t pin);

/* An output's address and the values whose store sets or clears it, prepared for interrupt handlers. */
typedef struct {
    volatile uint32_t *place; /* null: not connected */
    uint32_t high, low;
} pin_switch_t;
pin_switch_t pin_switch(stm32f405_pin_t pin);

#endif
