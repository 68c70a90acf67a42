#include "random.h"

#include <stdbool.h>

#include "brace_hal.h"
#include "clock.h"
#include "stm32f405_registers.h"

enum { WORD_US = 10 }; /* 40 cycles of 48 MHz are 1 us */

static uint32_t last_word;
static bool has_last;

static volatile uint32_t *generator(uint32_t offset)
{
    return &REGISTER(RNG_BASE, offset);
}

static void begin_anew(void)
{
    *generator(RNG_SR) = 0u; /* clears the errors that it reported of its clock and its seed */
    *generator(RNG_CR) = 0u;
    *generator(RNG_CR) = RNG_CR_RNGEN;
    has_last = false;
}

void random_start(void)
{
    REGISTER(RCC_BASE, RCC_AHB2ENR) |= RCC_AHB2ENR_RNGEN;
    (void)REGISTER(RCC_BASE, RCC_AHB2ENR); /* the clock runs two cycles after the write */
    begin_anew();
}

/* returns false: none came, or it reported a fault */
static bool take_word(uint32_t *word)
{
    const bool is_ready = clock_poll_until(generator(RNG_SR), RNG_SR_DRDY, RNG_SR_DRDY, WORD_US);
    if (!is_ready || (*generator(RNG_SR) & (RNG_SR_SEIS | RNG_SR_CEIS | RNG_SR_SECS | RNG_SR_CECS)) != 0u) {
        return false;
    }
    *word = *generator(RNG_DR);
    return true;
}

int32_t random_read(void *context, uint32_t *word)
{
    (void)context;
    uint32_t next = 0u;
    /* The manual asks to keep the first word for comparison only, and that no word is the one before it. */
    if (!has_last) {
        has_last = take_word(&last_word);
    }
    if (!has_last || !take_word(&next) || next == last_word) {
        begin_anew();
        return BRACE_HAL_E_DEVICE;
    }
    last_word = next;
    *word = next;
    return BRACE_HAL_OK;
}
