#include "clock.h"

#include "processor.h"
#include "stm32f405_registers.h"

enum {
    HSI_HZ = 16000000,
    CORE_HZ = 168000000,
    VCO_MHZ = 336, /* the PLL's oscillator; half of it for the core, a seventh for USB */
    FLASH_WAIT_STATES = 5, /* 150-168 MHz at 2.7 V or more */
    CRYSTAL_POLLS = 200000, /* at 16 MHz 0.1 s or more; a crystal takes 2 ms */
    PLL_POLLS = 20000,      /* 10 ms; it locks within 0.3 ms */
    SWITCH_POLLS = 1000,
    CLOCK_HSI = 0, /* values of the fields SW and SWS */
    CLOCK_PLL = 2,
    POLLS_PER_US = 21
};

static stm32f405_clock_report_t report;

const stm32f405_clock_report_t *clock_report(void)
{
    return &report;
}

stm32f405_clock_report_t stm32f405_clock_report(void)
{
    return report;
}

static void change(uint32_t offset, uint32_t mask, uint32_t bits)
{
    REGISTER(RCC_BASE, offset) = (REGISTER(RCC_BASE, offset) & ~mask) | bits;
}

static bool rcc_becomes(uint32_t offset, uint32_t mask, uint32_t wanted, uint32_t polls)
{
    return poll_until(&REGISTER(RCC_BASE, offset), mask, wanted, polls);
}

static bool switch_to(uint32_t source)
{
    change(RCC_CFGR, RCC_CFGR_SW, FIELD(RCC_CFGR_SW, source));
    return rcc_becomes(RCC_CFGR, RCC_CFGR_SWS, FIELD(RCC_CFGR_SWS, source), SWITCH_POLLS);
}

static bool start_crystal(uint32_t hse_hz)
{
    if (hse_hz < 4000000u || hse_hz > 26000000u || hse_hz % 1000000u != 0u) {
        return false;
    }
    change(RCC_CR, RCC_CR_HSEON, RCC_CR_HSEON);
    if (rcc_becomes(RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY, CRYSTAL_POLLS)) {
        return true;
    }
    change(RCC_CR, RCC_CR_HSEON, 0u);
    return false;
}

/* Makes flash slow enough first, then starts the PLL, divides the buses, and switches over to the PLL. */
static bool start_pll(uint32_t source_hz, bool crystal)
{
    const uint32_t source_mhz = source_hz / 1000000u;
    /* With 2 MHz the PLL jitters less than with 1 MHz. */
    const uint32_t divider = source_mhz % 2u == 0u ? source_mhz / 2u : source_mhz;
    const uint32_t multiplier = VCO_MHZ * divider / source_mhz;

    const uint32_t latency = FIELD(FLASH_ACR_LATENCY, FLASH_WAIT_STATES);
    REGISTER(FLASH_BASE, FLASH_ACR) = latency | FLASH_ACR_PRFTEN | FLASH_ACR_ICEN | FLASH_ACR_DCEN;
    if (!poll_until(&REGISTER(FLASH_BASE, FLASH_ACR), FLASH_ACR_LATENCY, latency, SWITCH_POLLS)) {
        return false;
    }
    change(RCC_PLLCFGR, RCC_PLLCFGR_PLLM | RCC_PLLCFGR_PLLN | RCC_PLLCFGR_PLLP | RCC_PLLCFGR_PLLSRC | RCC_PLLCFGR_PLLQ,
           FIELD(RCC_PLLCFGR_PLLM, divider) | FIELD(RCC_PLLCFGR_PLLN, multiplier) | FIELD(RCC_PLLCFGR_PLLP, 0) |
               FIELD(RCC_PLLCFGR_PLLSRC, crystal) | FIELD(RCC_PLLCFGR_PLLQ, 7));
    change(RCC_CR, RCC_CR_PLLON, RCC_CR_PLLON);
    if (!rcc_becomes(RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY, PLL_POLLS)) {
        change(RCC_CR, RCC_CR_PLLON, 0u);
        return false;
    }
    change(RCC_CFGR, RCC_CFGR_HPRE | RCC_CFGR_PPRE1 | RCC_CFGR_PPRE2,
           FIELD(RCC_CFGR_PPRE1, 5) | FIELD(RCC_CFGR_PPRE2, 4)); /* APB1 a quarter, APB2 half */
    if (!switch_to(CLOCK_PLL)) {
        (void)switch_to(CLOCK_HSI);
        change(RCC_CFGR, RCC_CFGR_PPRE1 | RCC_CFGR_PPRE2, 0u);
        change(RCC_CR, RCC_CR_PLLON, 0u);
        return false;
    }
    return true;
}

static void start_counter(uint32_t timer_hz)
{
    change(RCC_APB1ENR, RCC_APB1ENR_TIM2EN, RCC_APB1ENR_TIM2EN);
    (void)REGISTER(RCC_BASE, RCC_APB1ENR); /* the clock runs two cycles after the write */
    REGISTER(TIM2_BASE, TIM2_PSC) = timer_hz / 1000000u - 1u;
    REGISTER(TIM2_BASE, TIM2_ARR) = UINT32_MAX;
    REGISTER(TIM2_BASE, TIM2_EGR) = TIM2_EGR_UG; /* takes the prescaler over, and starts from 0 */
    REGISTER(TIM2_BASE, TIM2_CR1) = TIM2_CR1_CEN;
}

void clock_start(uint32_t hse_hz, const stm32f405_clocks_t *given)
{
    if (given != 0) {
        report.clocks = *given;
        report.crystal = true;
        report.pll = true;
    } else {
        change(RCC_CR, RCC_CR_HSION, RCC_CR_HSION); /* a boot loader may have left other clocks */
        (void)rcc_becomes(RCC_CR, RCC_CR_HSIRDY, RCC_CR_HSIRDY, SWITCH_POLLS);
        (void)switch_to(CLOCK_HSI);
        change(RCC_CR, RCC_CR_PLLON, 0u);
        (void)rcc_becomes(RCC_CR, RCC_CR_PLLRDY, 0u, SWITCH_POLLS);

        report.crystal = start_crystal(hse_hz);
        report.pll = report.crystal && start_pll(hse_hz, true);
        if (report.pll) {
            change(RCC_CR, RCC_CR_CSSON, RCC_CR_CSSON); /* a crystal that stops calls nmi_handler */
        }
        if (!report.pll) {
            report.crystal = false;
            report.pll = start_pll(HSI_HZ, false);
        }
        const uint32_t core_hz = report.pll ? CORE_HZ : HSI_HZ;
        report.clocks.core_hz = core_hz;
        report.clocks.apb1_hz = report.pll ? core_hz / 4u : core_hz;
        report.clocks.apb2_hz = report.pll ? core_hz / 2u : core_hz;
        report.clocks.timer_hz = report.pll ? core_hz / 2u : core_hz;
    }
    start_counter(report.clocks.timer_hz);
}

bool clock_goes_on_without_crystal(void)
{
    report.crystal = false;
    report.crystal_was_lost = true;
    change(RCC_CR, RCC_CR_PLLON, 0u); /* its source is gone; its settings may change only while it is off */
    report.pll = rcc_becomes(RCC_CR, RCC_CR_PLLRDY, 0u, SWITCH_POLLS) && start_pll(HSI_HZ, false);
    return report.pll;
}

uint32_t clock_now_us(void)
{
    return REGISTER(TIM2_BASE, TIM2_CNT);
}

bool clock_poll_until(volatile const uint32_t *place, uint32_t mask, uint32_t wanted, uint32_t timeout_us)
{
    const uint32_t start_us = clock_now_us();
    for (uint32_t poll = 0; poll < timeout_us * POLLS_PER_US; poll++) {
        if ((*place & mask) == wanted) {
            return true;
        }
        if (clock_now_us() - start_us > timeout_us) {
            return (*place & mask) == wanted; /* the processor may have stood still between the two reads */
        }
    }
    return false;
}
