/* Barriers and bounded waiting. */
#ifndef STM32F405_PROCESSOR_H
#define STM32F405_PROCESSOR_H

#include <stdbool.h>
#include <stdint.h>

/* Completes every memory access before it, before any access after it begins. */
static inline void processor_barrier(void)
{
    __asm__ volatile("dsb" ::: "memory");
}

/* Keeps the compiler from moving accesses across. On one processor this is enough between an interrupt and its
 * thread. */
static inline void compiler_barrier(void)
{
    __asm__ volatile("" ::: "memory");
}

/* Polls until (register & mask) == wanted. false: not within that many polls of at least 8 processor cycles each. */
static inline bool poll_until(volatile const uint32_t *place, uint32_t mask, uint32_t wanted, uint32_t polls)
{
    for (uint32_t poll = 0; poll < polls; poll++) {
        if ((*place & mask) == wanted) {
            return true;
        }
    }
    return false;
}

#endif
