/* This file never trusts the stack that faulted: the handler changes to a stack of its own before it calls C, and reads
 * the interrupted state only if it lies in RAM. It uses no floating point, no library, and no loop but the record's
 * checksum. */
#include "fault.h"

#include "cortex_m.h"
#include "kept.h"
#include "start.h"

extern uint32_t _ram_start[], _ram_end[];

enum { FAULT_STACK_WORDS = 128, EXCEPTION_NMI = 2, FRAME_WORDS = 8, EXTENDED_FRAME_WORDS = 26 };
enum { EXC_RETURN_NO_FP_FRAME = 1u << 4, PSR_STACK_WAS_ALIGNED = 1u << 9 };

__attribute__((used, section(".kept"), aligned(8))) uint32_t fault_stack[FAULT_STACK_WORDS];
__attribute__((used, noreturn)) void fault_record(const uint32_t *frame, uint32_t exc_return);

/* The registers that the processor pushed: r0-r3, r12, lr, pc, psr. */
enum { FRAME_LR = 5, FRAME_PC = 6, FRAME_PSR = 7 };

__attribute__((naked)) void fault_handler(void)
{
    __asm__ volatile("cpsid i\n"
                     "tst lr, #4\n"
                     "ite eq\n"
                     "mrseq r0, msp\n"
                     "mrsne r0, psp\n"
                     "mov r1, lr\n"
                     "ldr r2, =fault_stack + %c0\n"
                     "msr msp, r2\n"
                     "b fault_record\n"
                     ".ltorg\n" ::"i"(FAULT_STACK_WORDS * sizeof(uint32_t)));
}

static bool lies_in_ram(const uint32_t *frame)
{
    return frame >= _ram_start && frame + FRAME_WORDS <= _ram_end && ((uintptr_t)frame & 3u) == 0u;
}

/* The stack pointer as it was before the exception. */
static uint32_t before(const uint32_t *frame, uint32_t exc_return)
{
    const bool has_fp = (exc_return & EXC_RETURN_NO_FP_FRAME) == 0u;
    uint32_t sp = (uint32_t)(uintptr_t)frame +
                  (uint32_t)sizeof(uint32_t) * (has_fp ? (uint32_t)EXTENDED_FRAME_WORDS : (uint32_t)FRAME_WORDS);
    if (lies_in_ram(frame) && (frame[FRAME_PSR] & PSR_STACK_WAS_ALIGNED) != 0u) {
        sp += (uint32_t)sizeof(uint32_t);
    }
    return sp;
}

void fault_record(const uint32_t *frame, uint32_t exc_return)
{
    uint32_t exception;
    __asm__ volatile("mrs %0, ipsr" : "=r"(exception));
    brace_crash_record_t record = {
        .exception = exception,
        .sp = before(frame, exc_return),
        .cfsr = SCB_CFSR,
        .hfsr = SCB_HFSR,
        .mmfar = SCB_MMFAR,
        .bfar = SCB_BFAR,
        .uptime_us = board_now_us(),
    };
    if (lies_in_ram(frame)) { /* else the stack has left RAM, and the place of the fault is not known */
        record.pc = frame[FRAME_PC];
        record.lr = frame[FRAME_LR];
        record.psr = frame[FRAME_PSR];
    }
    kept_crash_store(&record);
    kept_announce(exception == (uint32_t)EXCEPTION_NMI ? BRACE_RESET_WATCHDOG : BRACE_RESET_FAULT);
    cortex_m_reset();
}
