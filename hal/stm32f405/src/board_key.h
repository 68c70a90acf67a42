/* The board's key, in the chip's one-time programmable memory: nothing erases it, no image that is flashed and no set of
 * parameters. Entries and answers are those of brace_hal.h. */
#ifndef STM32F405_BOARD_KEY_H
#define STM32F405_BOARD_KEY_H

#include <stdint.h>

#include "brace_hal.h"

int32_t board_key_read(void *context, uint8_t key[BRACE_HAL_KEY_BYTES]);
int32_t board_key_write(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES]);

#endif
