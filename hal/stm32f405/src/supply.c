#include "supply.h"

#include "processor.h"
#include "stm32f405_registers.h"

enum {
    BROWN_OUT_LEVEL_3 = 0,  /* value of BOR_LEV */
    DETECTOR_2_9_V = 7,     /* value of PLS */
    OPTION_POLLS = 20000000 /* at least 0.9 s; options take as long as the erase of a small sector, at most 0.5 s */
};

static bool is_watched;

static volatile uint32_t *flash(uint32_t offset)
{
    return &REGISTER(FLASH_BASE, offset);
}

static bool flash_rests(void)
{
    return poll_until(flash(FLASH_SR), FLASH_SR_BSY, 0u, OPTION_POLLS);
}

/* RM0090, 3.7.2. */
static void set_brown_out(void)
{
    const uint32_t level = *flash(FLASH_OPTCR) & FLASH_OPTCR_BOR_LEV;
    if (level == FIELD(FLASH_OPTCR_BOR_LEV, BROWN_OUT_LEVEL_3) || !flash_rests()) {
        return;
    }
    *flash(FLASH_OPTKEYR) = FLASH_OPTKEYR_KEY1;
    *flash(FLASH_OPTKEYR) = FLASH_OPTKEYR_KEY2;
    const uint32_t options = *flash(FLASH_OPTCR);
    if ((options & FLASH_OPTCR_OPTLOCK) != 0u) {
        return;
    }
    const uint32_t wanted = (options & ~FLASH_OPTCR_BOR_LEV) | FIELD(FLASH_OPTCR_BOR_LEV, BROWN_OUT_LEVEL_3);
    *flash(FLASH_OPTCR) = wanted;
    *flash(FLASH_OPTCR) = wanted | FLASH_OPTCR_OPTSTRT;
    (void)flash_rests();
    *flash(FLASH_OPTCR) |= FLASH_OPTCR_OPTLOCK;
}

void supply_start(void)
{
    REGISTER(RCC_BASE, RCC_APB1ENR) |= RCC_APB1ENR_PWREN;
    (void)REGISTER(RCC_BASE, RCC_APB1ENR); /* the clock runs two cycles after the write */
    const uint32_t others = REGISTER(PWR_BASE, PWR_CR) & ~PWR_CR_PLS;
    REGISTER(PWR_BASE, PWR_CR) = others | FIELD(PWR_CR_PLS, DETECTOR_2_9_V);
    REGISTER(PWR_BASE, PWR_CR) = others | FIELD(PWR_CR_PLS, DETECTOR_2_9_V) | PWR_CR_PVDE;
    is_watched = true;
    if (!supply_is_low()) { /* options are flash, too */
        set_brown_out();
    }
}

bool supply_is_low(void)
{
    return is_watched && (REGISTER(PWR_BASE, PWR_CSR) & PWR_CSR_PVDO) != 0u;
}
