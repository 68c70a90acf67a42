#include "board_key.h"

#include <stdbool.h>

#include "flash_program.h"

/* RM0090, 3.8: 16 blocks of 32 bytes, which are programmed as flash is. A block holds the key and its complement, so that
 * a block which was being written when the power failed, or has lost a bit, is no key. */
enum { BLOCK_COUNT = 16, BLOCK_BYTES = 2 * BRACE_HAL_KEY_BYTES };

#define BLOCKS_START 0x1fff7800u

static const volatile uint8_t *block(uint32_t number)
{
    return (const volatile uint8_t *)(uintptr_t)(BLOCKS_START + number * BLOCK_BYTES);
}

static bool holds_key(uint32_t number)
{
    const volatile uint8_t *bytes = block(number);
    bool is_key = true;
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        const uint8_t byte = bytes[i], complement = bytes[BRACE_HAL_KEY_BYTES + i];
        is_key = is_key && (byte ^ complement) == UINT8_MAX;
    }
    return is_key;
}

static bool is_blank(uint32_t number)
{
    const volatile uint8_t *bytes = block(number);
    bool blank = true;
    for (uint32_t i = 0; i < (uint32_t)BLOCK_BYTES; i++) {
        blank = blank && bytes[i] == UINT8_MAX;
    }
    return blank;
}

/* Each returns the number of the first such block; BLOCK_COUNT: there is none. */
static uint32_t first_with_key(void)
{
    uint32_t number = 0;
    while (number < (uint32_t)BLOCK_COUNT && !holds_key(number)) {
        number++;
    }
    return number;
}

static uint32_t first_blank(void)
{
    uint32_t number = 0;
    while (number < (uint32_t)BLOCK_COUNT && !is_blank(number)) {
        number++;
    }
    return number;
}

int32_t board_key_read(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    if (!flash_answers()) {
        return BRACE_HAL_E_DEVICE;
    }
    const uint32_t number = first_with_key();
    if (number == (uint32_t)BLOCK_COUNT) {
        return 0;
    }
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        key[i] = block(number)[i];
    }
    return 1;
}

int32_t board_key_write(void *context, const uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    if (!flash_answers()) {
        return BRACE_HAL_E_DEVICE;
    }
    if (first_with_key() < (uint32_t)BLOCK_COUNT) {
        return BRACE_HAL_E_RANGE;
    }
    const uint32_t number = first_blank();
    if (number == (uint32_t)BLOCK_COUNT) {
        return BRACE_HAL_E_DEVICE;
    }
    uint8_t content[BLOCK_BYTES];
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        content[i] = key[i];
        content[BRACE_HAL_KEY_BYTES + i] = (uint8_t)~key[i];
    }
    const int32_t written = flash_program((uintptr_t)block(number), content, BLOCK_BYTES);
    return written != BRACE_HAL_OK || holds_key(number) ? written : BRACE_HAL_E_DEVICE;
}
