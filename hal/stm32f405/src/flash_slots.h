/* The two slots of non-volatile memory: flash sectors, or RAM that stands in for them. */
#ifndef STM32F405_FLASH_SLOTS_H
#define STM32F405_FLASH_SLOTS_H

#include "brace_hal_stm32f405.h"

void flash_slots_use(const stm32f405_board_t *board);
brace_nvm_shape_t flash_slots_shape(void);

int32_t flash_slots_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count);
int32_t flash_slots_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count);
int32_t flash_slots_erase(void *context, uint32_t slot);

#endif
