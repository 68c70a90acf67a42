/* Start-up of the emulated Cortex-M boards: the vector table, and the FPU switched on. The C library's _start does
 * the rest; printf and the end of the program reach the emulator by semihosting. A real board has a start-up file
 * already. */
#include <stdint.h>

extern void _start(void);

static void reset(void)
{
#ifdef __ARM_FP
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: full access to the FPU */
    __asm__ volatile("dsb\n\tisb");
#endif
    _start();
}

static void fault(void)
{
    for (;;) {
    }
}

extern void (*const vectors[16])(void);
__attribute__((section(".vectors"))) void (*const vectors[16])(void) = {
    (void (*)(void))0x20400000u, /* stack: the end of RAM, growing down */
    reset,
    fault,
    fault,
    fault,
    fault,
    fault,
};
