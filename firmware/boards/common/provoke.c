#include "provoke.h"

void provoke_help(text_t *text)
{
    text_string(text, "crash test: u undefined instruction  m missing memory  z division by zero  o stack overflow  ");
    text_string(text, "j jump to data  h hang  i interrupt nobody expects");
    text_line(text);
}

/* Each fault has a function of its own, so that the record's pc can be looked up by name. */

__attribute__((noinline)) static void provoke_undefined(void)
{
    __asm__ volatile("udf #0");
}

__attribute__((noinline)) static void provoke_missing_memory(void)
{
    (void)*(volatile uint32_t *)0x60000000u; /* external memory, which these boards do not have */
}

__attribute__((noinline)) static uint32_t provoke_division(volatile uint32_t *zero)
{
    uint32_t quotient;
    __asm__ volatile("udiv %0, %1, %2" : "=r"(quotient) : "r"(1u), "r"(*zero));
    return quotient;
}

/* Recurses without end, on purpose. */
__attribute__((noinline)) static uint32_t provoke_overflow(uint32_t depth)
{
    volatile uint32_t frame[16];
    frame[depth % 16u] = depth;
    return depth == UINT32_MAX ? 0u : provoke_overflow(depth + 1u) + frame[depth % 16u];
}

__attribute__((noinline)) static void provoke_jump(void)
{
    void (*const nowhere)(void) = (void (*)(void))(uintptr_t)0x60000001u;
    nowhere();
}

__attribute__((noinline)) static void provoke_hang(void)
{
    for (;;) { /* for ever: the watchdog has to end it */
        __asm__ volatile("nop");
    }
}

__attribute__((noinline)) static void provoke_interrupt(void)
{
    enum { NOBODYS_INTERRUPT = 30 };
    *(volatile uint32_t *)0xE000E100u = 1u << NOBODYS_INTERRUPT; /* NVIC: enable, then make pending */
    *(volatile uint32_t *)0xE000E200u = 1u << NOBODYS_INTERRUPT;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}

void provoke(uint8_t request)
{
    volatile uint32_t zero = 0u;
    switch (request) {
    case 'u': provoke_undefined(); break;
    case 'm': provoke_missing_memory(); break;
    case 'z': (void)provoke_division(&zero); break;
    case 'o': (void)provoke_overflow(0u); break;
    case 'j': provoke_jump(); break;
    case 'h': provoke_hang(); break;
    case 'i': provoke_interrupt(); break;
    default: break;
    }
}
