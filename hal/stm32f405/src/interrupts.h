/* The interrupt controller. */
#ifndef STM32F405_INTERRUPTS_H
#define STM32F405_INTERRUPTS_H

#include "stm32f405_registers.h"

/* Enables interrupt 0-95. All have one priority, so none interrupts another. */
static inline void interrupt_enable(uint32_t number)
{
    REGISTER(NVIC_BASE, NVIC_ISER0 + (NVIC_ISER1 - NVIC_ISER0) * (number / 32u)) = 1u << (number % 32u);
}

/* Makes the processor call the handler as soon as it can, whatever the device says. */
static inline void interrupt_request(uint32_t number)
{
    REGISTER(NVIC_BASE, NVIC_ISPR0 + (NVIC_ISPR1 - NVIC_ISPR0) * (number / 32u)) = 1u << (number % 32u);
}

#endif
