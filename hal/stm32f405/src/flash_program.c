#include "flash_program.h"

#include "brace_hal.h"
#include "clock.h"
#include "processor.h"
#include "stm32f405_registers.h"
#include "supply.h"
#include "watchdog.h"

enum {
    PARALLEL_8 = 0,   /* PSIZE: a byte at a time */
    PARALLEL_32 = 2,  /* PSIZE: 32 bits at a time */
    PROGRAM_US = 200, /* a word takes 16 us, at most 100 */
    REST_US = 4000000 /* an erase that still runs takes at most 2 s */
};

#define ERRORS (FLASH_SR_OPERR | FLASH_SR_WRPERR | FLASH_SR_PGAERR | FLASH_SR_PGPERR | FLASH_SR_PGSERR)

static volatile uint32_t *flash(uint32_t offset)
{
    return &REGISTER(FLASH_BASE, offset);
}

static bool finishes_within(uint32_t timeout_us)
{
    return clock_poll_until(flash(FLASH_SR), FLASH_SR_BSY, 0u, timeout_us);
}

static void lock(void)
{
    *flash(FLASH_CR) = FLASH_CR_LOCK;
}

/* Unlocks the flash. false: the supply is falling, an operation is still running, or the controller stays locked. One
 * wrong key locks it until a reset. */
static bool unlock(void)
{
    if (supply_is_low() || !finishes_within(REST_US)) {
        return false;
    }
    if ((*flash(FLASH_CR) & FLASH_CR_LOCK) != 0u) {
        *flash(FLASH_KEYR) = FLASH_KEYR_KEY1;
        *flash(FLASH_KEYR) = FLASH_KEYR_KEY2;
    }
    *flash(FLASH_SR) = ERRORS | FLASH_SR_EOP; /* an old error would stop the next operation */
    *flash(FLASH_CR) = FIELD(FLASH_CR_PSIZE, PARALLEL_32);
    return (*flash(FLASH_CR) & (FLASH_CR_LOCK | FLASH_CR_PSIZE)) == FIELD(FLASH_CR_PSIZE, PARALLEL_32);
}

/* The caches may hold the old content. They can be reset only while they are off. */
static void forget_caches(void)
{
    const uint32_t access = *flash(FLASH_ACR);
    const uint32_t off = access & ~(FLASH_ACR_DCEN | FLASH_ACR_ICEN);
    *flash(FLASH_ACR) = off;
    *flash(FLASH_ACR) = off | FLASH_ACR_DCRST | FLASH_ACR_ICRST;
    *flash(FLASH_ACR) = off;
    *flash(FLASH_ACR) = access;
    processor_barrier();
}

/* Ends an operation, whatever its result: locks the controller and empties the caches. */
static int32_t close_up(bool finished)
{
    const bool sound = finished && (*flash(FLASH_SR) & ERRORS) == 0u;
    *flash(FLASH_SR) = ERRORS | FLASH_SR_EOP;
    lock();
    forget_caches();
    return sound ? BRACE_HAL_OK : BRACE_HAL_E_DEVICE;
}

static uint32_t word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

bool flash_answers(void)
{
    return (*flash(FLASH_CR) & FLASH_CR_LOCK) != 0u;
}

int32_t flash_program(uintptr_t address, const uint8_t *bytes, uint32_t count)
{
    if (!unlock()) {
        lock();
        return BRACE_HAL_E_DEVICE;
    }
    volatile uint32_t *place = (volatile uint32_t *)address;
    bool sound = true;
    for (uint32_t i = 0; i < count && sound; i += FLASH_WORD_BYTES) { /* at most a slot's words */
        *flash(FLASH_CR) = FLASH_CR_PG | FIELD(FLASH_CR_PSIZE, PARALLEL_32);
        *place++ = word(&bytes[i]);
        processor_barrier();
        sound = finishes_within(PROGRAM_US) && (*flash(FLASH_SR) & ERRORS) == 0u;
    }
    return close_up(sound);
}

int32_t flash_program_byte(uintptr_t address, uint8_t byte)
{
    if (!unlock()) {
        lock();
        return BRACE_HAL_E_DEVICE;
    }
    *flash(FLASH_CR) = FLASH_CR_PG | FIELD(FLASH_CR_PSIZE, PARALLEL_8);
    *(volatile uint8_t *)address = byte;
    processor_barrier();
    return close_up(finishes_within(PROGRAM_US));
}

int32_t flash_erase_sector(uint8_t sector, uint32_t timeout_us)
{
    if (!unlock()) {
        lock();
        return BRACE_HAL_E_DEVICE;
    }
    watchdog_feed(0); /* the processor stands still from here until the sector is erased */
    const uint32_t what = FLASH_CR_SER | FIELD(FLASH_CR_SNB, sector) | FIELD(FLASH_CR_PSIZE, PARALLEL_32);
    *flash(FLASH_CR) = what;
    *flash(FLASH_CR) = what | FLASH_CR_STRT;
    processor_barrier();
    const bool finished = finishes_within(timeout_us);
    watchdog_feed(0);
    return close_up(finished);
}
