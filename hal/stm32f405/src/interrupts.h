/* The interrupt controller. */
#ifndef STM32F405_INTERRUPTS_H
#define STM32F405_INTERRUPTS_H

#include "stm32f405_registers.h"

/* Lets interrupt 0-63 through. All stay at one priority: none interrupts another. */
static inline void interrupt_enable(uint32_t number)
{
    REGISTER(NVIC_BASE, NVIC_ISER0 + (NVIC_ISER1 - NVIC_ISER0) * (number / 32u)) = 1u << (number % 32u);
}

/* Has the handler called as soon as can be, whatever the device says. */
static inline void interrupt_request(uint32_t number)
{
    REGISTER(NVIC_BASE, NVIC_ISPR0 + (NVIC_ISPR1 - NVIC_ISPR0) * (number / 32u)) = 1u << (number % 32u);
}

#endif
