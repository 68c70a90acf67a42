/* The way from reset to main on an emulated Cortex-M, and from main's result to the emulator's exit code.
 *
 * Test images only: output and exit go through semihosting (newlib's librdimon). A fault ends the run with
 * exit code 125 instead of hanging it.
 */
#include <stdint.h>
#include <stdlib.h>

extern uint32_t _stack_top, _data_load, _data_start, _data_end, _bss_start, _bss_end;

extern int main(void);
extern void initialise_monitor_handles(void);
extern void __libc_init_array(void);

void reset_handler(void);
void _init(void);
void _fini(void);
_Noreturn void _exit(int code);

/* newlib's constructor and destructor arrays call these; crti.o is not linked. */
void _init(void) {}
void _fini(void) {}

enum { FAULT_EXIT_CODE = 125 };

static void semihosting_exit(uint32_t code)
{
    /* SYS_EXIT_EXTENDED with ADP_Stopped_ApplicationExit and the code itself. */
    const uint32_t block[2] = {0x20026u, code};
    register uint32_t operation __asm__("r0") = 0x20u;
    register const uint32_t *argument __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
}

void _exit(int code)
{
    for (;;) { /* for ever: the emulator ends it */
        semihosting_exit((uint32_t)code);
    }
}

static void fault_handler(void)
{
    _exit(FAULT_EXIT_CODE);
}

#if defined(__ARM_FP)
static void enable_fpu(void)
{
    volatile uint32_t *const cpacr = (volatile uint32_t *)0xE000ED88u;
    *cpacr |= 0xFu << 20; /* full access to CP10 and CP11 */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}
#endif

#if defined(__ARM_ARCH_6M__)
static void forbid_unaligned_access(void)
{
    volatile uint32_t *const ccr = (volatile uint32_t *)0xE000ED14u;
    *ccr |= 1u << 3; /* UNALIGN_TRP: the emulated Cortex-M3 faults where a Cortex-M0+ would */
}
#endif

void reset_handler(void)
{
#if defined(__ARM_FP)
    enable_fpu();
#endif
#if defined(__ARM_ARCH_6M__)
    forbid_unaligned_access();
#endif
    const uint32_t *from = &_data_load;
    for (uint32_t *to = &_data_start; to < &_data_end; to++) { /* at most the RAM */
        *to = *from++;
    }
    for (uint32_t *to = &_bss_start; to < &_bss_end; to++) { /* at most the RAM */
        *to = 0u;
    }
    initialise_monitor_handles();
    __libc_init_array();
    exit(main());
}

typedef void (*handler_t)(void);

typedef struct {
    uint32_t *stack_top;
    handler_t handler[15]; /* reset, then exceptions 2 to 15 */
} vectors_t;

__attribute__((section(".vectors"), used)) static const vectors_t vectors = {
    &_stack_top,
    {reset_handler, fault_handler, fault_handler, fault_handler, fault_handler, fault_handler, 0, 0, 0, 0,
     fault_handler, fault_handler, 0, fault_handler, fault_handler},
};
