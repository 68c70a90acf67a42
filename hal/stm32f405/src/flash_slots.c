#include "flash_slots.h"

#include "clock.h"
#include "processor.h"
#include "stm32f405_registers.h"
#include "supply.h"
#include "watchdog.h"

enum {
    SECTOR_COUNT = 12,
    WORD_BYTES = 4,
    PARALLEL_32 = 2,      /* PSIZE: 32 bits at a time */
    PROGRAM_US = 200,     /* a word takes 16 us, at most 100 */
    ERASE_SMALL_US = 1000000, /* 16 KiB take at most 0.5 s */
    ERASE_LARGE_US = 4000000  /* 128 KiB take at most 2 s */
};

#define FLASH_START 0x08000000u
#define ERRORS (FLASH_SR_OPERR | FLASH_SR_WRPERR | FLASH_SR_PGAERR | FLASH_SR_PGPERR | FLASH_SR_PGSERR)

static const stm32f405_board_t *layout;

/* The chip's sectors: four of 16 KiB, one of 64, seven of 128. */
uint32_t stm32f405_sector_bytes(uint8_t sector)
{
    if (sector >= SECTOR_COUNT) {
        return 0u;
    }
    return sector < 4u ? 0x4000u : sector == 4u ? 0x10000u : 0x20000u;
}

uint32_t stm32f405_sector_address(uint8_t sector)
{
    if (sector >= SECTOR_COUNT) {
        return 0u;
    }
    const uint32_t offset = sector < 4u ? sector * 0x4000u : sector == 4u ? 0x10000u : (sector - 4u) * 0x20000u;
    return FLASH_START + offset;
}

void flash_slots_use(const stm32f405_board_t *board)
{
    layout = board;
}

static bool slots_are_sound(void)
{
    const uint8_t a = layout->nvm_sector[0], b = layout->nvm_sector[1];
    return a != 0u && b != 0u && a != b && stm32f405_sector_bytes(a) != 0u &&
           stm32f405_sector_bytes(a) == stm32f405_sector_bytes(b);
}

brace_nvm_shape_t flash_slots_shape(void)
{
    brace_nvm_shape_t shape = {STM32F405_NVM_RAM_SLOT_BYTES, WORD_BYTES};
    if (layout->nvm_ram == 0) {
        shape.slot_bytes = slots_are_sound() ? stm32f405_sector_bytes(layout->nvm_sector[0]) : 0u;
    }
    return shape;
}

static bool is_within(uint32_t slot, uint32_t offset, uint32_t count)
{
    const uint32_t slot_bytes = flash_slots_shape().slot_bytes;
    return slot < BRACE_NVM_SLOT_COUNT && offset <= slot_bytes && count <= slot_bytes - offset;
}

static uintptr_t slot_address(uint32_t slot)
{
    return layout->nvm_ram != 0 ? (uintptr_t)&layout->nvm_ram[slot * STM32F405_NVM_RAM_SLOT_BYTES]
                                : stm32f405_sector_address(layout->nvm_sector[slot]);
}

int32_t flash_slots_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!is_within(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    const volatile uint8_t *place = (const volatile uint8_t *)(slot_address(slot) + offset);
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = place[i];
    }
    return BRACE_HAL_OK;
}

/* ------------------------------------------------------------------------------------- flash interface -- */

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
    if (supply_is_low() || !finishes_within(ERASE_LARGE_US)) {
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

int32_t flash_slots_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!is_within(slot, offset, count) || offset % WORD_BYTES != 0u || count % WORD_BYTES != 0u) {
        return BRACE_HAL_E_RANGE;
    }
    const bool in_flash = layout->nvm_ram == 0;
    if (in_flash && !unlock()) {
        lock();
        return BRACE_HAL_E_DEVICE;
    }
    volatile uint32_t *place = (volatile uint32_t *)(slot_address(slot) + offset);
    bool sound = true;
    for (uint32_t i = 0; i < count && sound; i += WORD_BYTES) {
        if (in_flash) {
            *flash(FLASH_CR) = FLASH_CR_PG | FIELD(FLASH_CR_PSIZE, PARALLEL_32);
            *place++ = word(&bytes[i]);
            processor_barrier();
            sound = finishes_within(PROGRAM_US) && (*flash(FLASH_SR) & ERRORS) == 0u;
        } else {
            *place++ = word(&bytes[i]);
        }
    }
    return in_flash ? close_up(sound) : BRACE_HAL_OK;
}

int32_t flash_slots_erase(void *context, uint32_t slot)
{
    (void)context;
    const uint32_t slot_bytes = flash_slots_shape().slot_bytes;
    if (!is_within(slot, 0u, slot_bytes)) {
        return BRACE_HAL_E_RANGE;
    }
    if (layout->nvm_ram != 0) {
        volatile uint32_t *place = (volatile uint32_t *)slot_address(slot);
        for (uint32_t i = 0; i < STM32F405_NVM_RAM_SLOT_BYTES / WORD_BYTES; i++) {
            place[i] = UINT32_MAX;
        }
        return BRACE_HAL_OK;
    }
    if (slot_bytes == 0u || !unlock()) {
        lock();
        return BRACE_HAL_E_DEVICE;
    }
    watchdog_feed(0); /* the processor stands still from here until the sector is erased */
    const uint32_t what =
        FLASH_CR_SER | FIELD(FLASH_CR_SNB, layout->nvm_sector[slot]) | FIELD(FLASH_CR_PSIZE, PARALLEL_32);
    *flash(FLASH_CR) = what;
    *flash(FLASH_CR) = what | FLASH_CR_STRT;
    processor_barrier();
    const bool finished = finishes_within(slot_bytes > 0x4000u ? ERASE_LARGE_US : ERASE_SMALL_US);
    watchdog_feed(0);
    return close_up(finished);
}
