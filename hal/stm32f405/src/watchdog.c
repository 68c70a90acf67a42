#include "watchdog.h"

#include "lsi.h"
#include "processor.h"
#include "stm32f405_registers.h"

enum {
    DIVIDE_32 = 3,       /* value of PR */
    LSI_NOMINAL_HZ = 32000,
    RELOAD_MAX = 0xfff,
    UPDATE_POLLS = 20000 /* at most 5 LSI cycles, 0.3 ms */
};

static brace_reset_cause_t cause;
static bool running;

void reset_cause_take(bool by_fault)
{
    const uint32_t flags = REGISTER(RCC_BASE, RCC_CSR);
    if (by_fault) {
        cause = BRACE_RESET_FAULT;
    } else if ((flags & (RCC_CSR_WDGRSTF | RCC_CSR_WWDGRSTF)) != 0u) {
        cause = BRACE_RESET_WATCHDOG;
    } else if ((flags & RCC_CSR_SFTRSTF) != 0u) {
        cause = BRACE_RESET_REQUESTED;
    } else if ((flags & (RCC_CSR_PORRSTF | RCC_CSR_BORRSTF)) != 0u) {
        cause = BRACE_RESET_POWER;
    } else if ((flags & RCC_CSR_PADRSTF) != 0u) { /* tested last, because every other reset pulls the pin too */
        cause = BRACE_RESET_PIN;
    } else {
        cause = BRACE_RESET_POWER;
    }
    REGISTER(RCC_BASE, RCC_CSR) = flags | RCC_CSR_RMVF;
}

brace_reset_cause_t reset_cause_read(void *context)
{
    (void)context;
    return cause;
}

/* 3.5 s, or the counter's limit: 2.8 s with the fastest possible LSI, 47 kHz. */
static uint32_t reload_for(uint32_t lsi_hz)
{
    const uint32_t reload = (lsi_hz != 0u ? lsi_hz : (uint32_t)LSI_NOMINAL_HZ) / 32u * 7u / 2u;
    return reload < RELOAD_MAX ? reload : RELOAD_MAX;
}

void watchdog_start(uint32_t timer_hz)
{
    const uint32_t reload = reload_for(lsi_measure_hz(timer_hz));
    REGISTER(DBG_BASE, DBG_DBGMCU_APB1_FZ) |= DBG_DBGMCU_APB1_FZ_DBG_IWDEG_STOP;
    REGISTER(IWDG_BASE, IWDG_KR) = IWDG_KR_START_KEY; /* also starts the LSI, which the registers below need */
    REGISTER(IWDG_BASE, IWDG_KR) = IWDG_KR_ACCESS_KEY;
    REGISTER(IWDG_BASE, IWDG_PR) = FIELD(IWDG_PR_PR, DIVIDE_32);
    REGISTER(IWDG_BASE, IWDG_RLR) = FIELD(IWDG_RLR_RL, reload);
    (void)poll_until(&REGISTER(IWDG_BASE, IWDG_SR), IWDG_SR_PVU | IWDG_SR_RVU, 0u, UPDATE_POLLS);
    running = true;
    watchdog_feed(0);
}

void watchdog_feed(void *context)
{
    (void)context;
    if (running) {
        REGISTER(IWDG_BASE, IWDG_KR) = IWDG_KR_RELOAD_KEY; /* also locks the other registers again */
    }
}

void processor_restart(void *context)
{
    (void)context;
    processor_barrier();
    REGISTER(SCB_BASE, SCB_AIRCR) = FIELD(SCB_AIRCR_VECTKEY, SCB_AIRCR_VECTKEY_KEY) | SCB_AIRCR_SYSRESETREQ;
    processor_barrier();
    /* The reset takes a few cycles. If it never comes, the watchdog resets. */
    (void)poll_until(&REGISTER(SCB_BASE, SCB_AIRCR), SCB_AIRCR_VECTKEY, 0u, UPDATE_POLLS);
}
