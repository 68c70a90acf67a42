#include "provoke.h"

typedef enum { UNDEFINED, MEMORY, DIVIDE, OVERFLOW, JUMP, HANG, INTERRUPT, CRASHES } crash_t;

static const char *const names[CRASHES] = {"crash undefined", "crash memory", "crash divide",   "crash overflow",
                                           "crash jump",      "crash hang",   "crash interrupt"};

uint32_t provoke_count(void)
{
    return CRASHES;
}

uint32_t provoke_find(const typed_t *typed)
{
    uint32_t at = 0u;
    while (at < (uint32_t)CRASHES && !typed_is(typed, names[at])) {
        at++;
    }
    return at;
}

void provoke_help(text_t *text)
{
    text_string(text, "crash undefined, memory, divide, overflow, jump, hang, interrupt: crashes on purpose");
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

void provoke(uint32_t crash)
{
    volatile uint32_t zero = 0u;
    switch (crash) {
    case UNDEFINED: provoke_undefined(); break;
    case MEMORY: provoke_missing_memory(); break;
    case DIVIDE: (void)provoke_division(&zero); break;
    case OVERFLOW: (void)provoke_overflow(0u); break;
    case JUMP: provoke_jump(); break;
    case HANG: provoke_hang(); break;
    case INTERRUPT: provoke_interrupt(); break;
    default: break;
    }
}
