/* The board's key, in the chip's one-time programmable memory: nothing erases it, and its block is locked, so that no
 * image that is flashed and no set of parameters replaces it. An image that runs can still read it, and need not ask
 * for it. Entries and answers are those of brace_hal.h. */
#ifndef STM32F405_BOARD_KEY_H
#define STM32F405_BOARD_KEY_H

#include <stdint.h>

#include "brace_hal.h"

/* Locks the block of a key that is not locked yet: the power failed, or the supply was low. Once, before the other
 * two; it blocks for at most 20 ms, and only then. */
void board_key_start(void);

int32_t board_key_read(void *context, uint8_t key[BRACE_HAL_KEY_BYTES]);
int32_t board_key_write(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES]);

#endif
