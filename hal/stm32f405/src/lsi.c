#include "lsi.h"

#include "clock.h"
#include "stm32f405_registers.h"

enum {
    START_US = 1000,   /* it takes 40 us */
    CAPTURE_US = 2000, /* eight periods of 17 kHz take 0.5 ms */
    PERIODS = 8,
    EVERY_EIGHTH = 3, /* value of IC4PSC */
    ITS_OWN_INPUT = 1, /* value of CC4S */
    LSI_TO_CHANNEL_4 = 1, /* value of IT4_RMP */
    SLOWEST_HZ = 15000, /* a lower result is no valid measurement */
    FASTEST_HZ = 50000
};

static volatile uint32_t *tim5(uint32_t offset)
{
    return &REGISTER(TIM5_BASE, offset);
}

static bool capture(uint32_t *count)
{
    const bool done = clock_poll_until(tim5(TIM5_SR), TIM5_SR_CC4IF, TIM5_SR_CC4IF, CAPTURE_US);
    *count = *tim5(TIM5_CCR4); /* the read makes room for the next */
    return done;
}

uint32_t lsi_measure_hz(uint32_t timer_hz)
{
    REGISTER(RCC_BASE, RCC_CSR) |= RCC_CSR_LSION;
    if (!clock_poll_until(&REGISTER(RCC_BASE, RCC_CSR), RCC_CSR_LSIRDY, RCC_CSR_LSIRDY, START_US)) {
        return 0u;
    }
    REGISTER(RCC_BASE, RCC_APB1ENR) |= RCC_APB1ENR_TIM5EN;
    (void)REGISTER(RCC_BASE, RCC_APB1ENR);
    *tim5(TIM5_PSC) = 0u;
    *tim5(TIM5_ARR) = UINT32_MAX;
    *tim5(TIM5_OR) = FIELD(TIM5_OR_IT4_RMP, LSI_TO_CHANNEL_4);
    *tim5(TIM5_CCMR2_Input) =
        FIELD(TIM5_CCMR2_Input_CC4S, ITS_OWN_INPUT) | FIELD(TIM5_CCMR2_Input_IC4PSC, EVERY_EIGHTH);
    *tim5(TIM5_CCER) = TIM5_CCER_CC4E;
    *tim5(TIM5_EGR) = TIM5_EGR_UG;
    *tim5(TIM5_CR1) = TIM5_CR1_CEN;

    uint32_t first = 0, second = 0;
    const bool measured = capture(&first) && capture(&second) && second != first;
    *tim5(TIM5_CR1) = 0u;
    REGISTER(RCC_BASE, RCC_APB1ENR) &= ~RCC_APB1ENR_TIM5EN;
    if (!measured) {
        return 0u;
    }
    const uint32_t lsi_hz = PERIODS * timer_hz / (second - first);
    return lsi_hz >= SLOWEST_HZ && lsi_hz <= FASTEST_HZ ? lsi_hz : 0u;
}
