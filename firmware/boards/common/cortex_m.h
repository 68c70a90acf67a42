/* The registers of a Cortex-M4 that start-up code and fault handlers use (Arm DDI 0403E, B3.2). */
#ifndef BRACE_BOARDS_CORTEX_M_H
#define BRACE_BOARDS_CORTEX_M_H

#include <stdint.h>

#define SCB_ICSR (*(volatile uint32_t *)0xE000ED04u)
#define SCB_VTOR (*(volatile uint32_t *)0xE000ED08u)
#define SCB_AIRCR (*(volatile uint32_t *)0xE000ED0Cu)
#define SCB_CCR (*(volatile uint32_t *)0xE000ED14u)
#define SCB_SHCSR (*(volatile uint32_t *)0xE000ED24u)
#define SCB_CFSR (*(volatile uint32_t *)0xE000ED28u)
#define SCB_HFSR (*(volatile uint32_t *)0xE000ED2Cu)
#define SCB_MMFAR (*(volatile uint32_t *)0xE000ED34u)
#define SCB_BFAR (*(volatile uint32_t *)0xE000ED38u)
#define SCB_CPACR (*(volatile uint32_t *)0xE000ED88u)

#define MPU_CONTROL (*(volatile uint32_t *)0xE000ED94u)
#define MPU_REGION_BASE (*(volatile uint32_t *)0xE000ED9Cu)
#define MPU_REGION_SIZE (*(volatile uint32_t *)0xE000EDA0u)

#define SYSTICK_CONTROL (*(volatile uint32_t *)0xE000E010u)
#define SYSTICK_LOAD (*(volatile uint32_t *)0xE000E014u)
#define SYSTICK_VALUE (*(volatile uint32_t *)0xE000E018u)

enum {
    CCR_DIV_0_TRAP = 1u << 4,
    SHCSR_FAULTS_ENABLED = 7u << 16, /* memory, bus and usage faults each with its own exception */
    CPACR_FPU = 0xFu << 20,
    MPU_ON_WITH_DEFAULT_MAP = 5u,
    MPU_BASE_OF_REGION_0 = 1u << 4,
    MPU_NO_ACCESS_4_KIB = 1u << 28 | 11u << 1 | 1u, /* never executed, no access, 2^(11 + 1) bytes, on */
    ICSR_FORGET_SYSTICK = 1u << 25,
    SYSTICK_ON_CORE_CLOCK = 5u,
    SYSTICK_ON_CORE_CLOCK_WITH_INTERRUPT = 7u
};

__attribute__((noreturn)) static inline void cortex_m_reset(void)
{
    __asm__ volatile("dsb" ::: "memory");
    SCB_AIRCR = 0x05FA0004u; /* key, SYSRESETREQ */
    __asm__ volatile("dsb" ::: "memory");
    for (;;) {
    }
}

#endif
