#include "flash_slots.h"

#include "flash_program.h"
#include "serial.h"
#include "servo_line.h"

enum {
    SECTOR_COUNT = 12,
    ERASE_SMALL_US = 1000000, /* 16 KiB take at most 0.5 s */
    ERASE_LARGE_US = 4000000, /* 128 KiB take at most 2 s */
    FINISH_US = 300000        /* an answer of 256 bytes at 9600 baud */
};

#define FLASH_START 0x08000000u

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
    brace_nvm_shape_t shape = {STM32F405_NVM_RAM_SLOT_BYTES, FLASH_WORD_BYTES};
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

int32_t flash_slots_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (!is_within(slot, offset, count) || offset % FLASH_WORD_BYTES != 0u || count % FLASH_WORD_BYTES != 0u) {
        return BRACE_HAL_E_RANGE;
    }
    if (layout->nvm_ram == 0) {
        return flash_program(slot_address(slot) + offset, bytes, count);
    }
    volatile uint8_t *place = (volatile uint8_t *)(slot_address(slot) + offset);
    for (uint32_t i = 0; i < count; i++) {
        place[i] = bytes[i];
    }
    return BRACE_HAL_OK;
}

int32_t flash_slots_erase(void *context, uint32_t slot)
{
    (void)context;
    const uint32_t slot_bytes = flash_slots_shape().slot_bytes;
    if (!is_within(slot, 0u, slot_bytes)) {
        return BRACE_HAL_E_RANGE;
    }
    if (layout->nvm_ram == 0) {
        /* The processor stands still meanwhile, and a transmitter that it leaves on its line keeps all others off. */
        serial_finish(FINISH_US);
        servo_line_finish(FINISH_US);
        return slot_bytes == 0u ? BRACE_HAL_E_DEVICE
                                : flash_erase_sector(layout->nvm_sector[slot],
                                                     slot_bytes > 0x4000u ? ERASE_LARGE_US : ERASE_SMALL_US);
    }
    volatile uint8_t *place = (volatile uint8_t *)slot_address(slot);
    for (uint32_t i = 0; i < (uint32_t)STM32F405_NVM_RAM_SLOT_BYTES; i++) {
        place[i] = UINT8_MAX;
    }
    return BRACE_HAL_OK;
}
