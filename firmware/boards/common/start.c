#include "start.h"

#include "cortex_m.h"
#include "kept.h"
#include "stack.h"

extern uint32_t _stack_limit[], _data_load[], _data_start[], _data_end[], _bss_start[], _bss_end[];
extern const uint32_t _vectors[];

extern int main(void);

__attribute__((used, noreturn)) void start(void);

/* Paints the whole stack, which is still empty, and then calls C. */
__attribute__((naked, noreturn)) void reset_handler(void)
{
    __asm__ volatile("cpsid i\n"
                     "ldr r0, =_stack_limit\n"
                     "ldr r1, =_stack_top\n"
                     "msr msp, r1\n"
                     "ldr r2, =%c0\n"
                     "1: str r2, [r0], #4\n"
                     "cmp r0, r1\n"
                     "blo 1b\n"
                     "b start\n"
                     ".ltorg\n" ::"i"(STACK_PAINT));
}

/* Forbids the 4 KiB below the stack. No RAM is there, but some boards answer all the same; now an access is a fault. */
static void guard_stack(void)
{
    enum { GUARD_BYTES = 4096 };
    MPU_REGION_BASE = ((uint32_t)(uintptr_t)_stack_limit - GUARD_BYTES) | MPU_BASE_OF_REGION_0;
    MPU_REGION_SIZE = MPU_NO_ACCESS_4_KIB;
    MPU_CONTROL = MPU_ON_WITH_DEFAULT_MAP;
}

void start(void)
{
    SCB_VTOR = (uint32_t)(uintptr_t)_vectors; /* a boot loader may have set its own table */
    SCB_CCR |= CCR_DIV_0_TRAP;
    SCB_SHCSR |= SHCSR_FAULTS_ENABLED;
    guard_stack();
#if defined(__ARM_FP)
    SCB_CPACR |= CPACR_FPU;
#endif
    __asm__ volatile("dsb\n\tisb" ::: "memory");
    const uint32_t *from = _data_load;
    for (uint32_t *to = _data_start; to < _data_end; to++) {
        *to = *from++;
    }
    for (uint32_t *to = _bss_start; to < _bss_end; to++) {
        *to = 0u;
    }
    kept_start();
    __asm__ volatile("cpsie i" ::: "memory");
    (void)main();
    kept_announce(BRACE_RESET_FAULT); /* main never returns */
    cortex_m_reset();
}
