#include "board_key.h"

#include <stdbool.h>

#include "flash_program.h"

/* RM0090, 3.8: 16 blocks of 32 bytes, which are programmed as flash is, and 16 bytes behind them, one for each block:
 * 0xff, or 0x00 and the block is locked for ever. Bits are only ever cleared.
 *
 * A block holds the key and its complement. So a block that was being written when the power failed, or has lost a
 * bit, is no key, and no cleared bit makes another key of a whole one. The first block with a key counts. Such a
 * block is locked. A block before it that another program could still make a key of (a write that the power cut) is
 * spoilt: its bytes 15 and 31 become zero.
 *
 * The order is safe for any power cut: the key is written and read back, blocks before it are spoilt, and then its
 * block is locked. board_key_start does what is left of that. */
enum { BLOCK_COUNT = 16, BLOCK_BYTES = 2 * BRACE_HAL_KEY_BYTES };

#define BLOCKS_START 0x1fff7800u
#define LOCKS_START 0x1fff7a00u

enum { LOCKED = 0x00 };

static const volatile uint8_t *block(uint32_t number)
{
    return (const volatile uint8_t *)(uintptr_t)(BLOCKS_START + number * BLOCK_BYTES);
}

static bool is_locked(uint32_t number)
{
    return *(const volatile uint8_t *)(uintptr_t)(LOCKS_START + number) == (uint8_t)LOCKED;
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

/* Could cleared bits make a key of it? Of each bit and its complement, one must still be set. */
static bool could_become_key(uint32_t number)
{
    const volatile uint8_t *bytes = block(number);
    bool could = !is_locked(number);
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        const uint8_t byte = bytes[i], complement = bytes[BRACE_HAL_KEY_BYTES + i];
        could = could && (byte | complement) == UINT8_MAX;
    }
    return could;
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

/* What is locked was a whole key once: one that has lost bits is not replaced by what a block behind it holds. */
static bool was_key(uint32_t number)
{
    return is_locked(number) && !holds_key(number) && !is_blank(number);
}

/* The number of the first block with a key; BLOCK_COUNT: there is none. */
static uint32_t first_with_key(void)
{
    uint32_t number = 0;
    while (number < (uint32_t)BLOCK_COUNT && !holds_key(number) && !was_key(number)) {
        number++;
    }
    return number < (uint32_t)BLOCK_COUNT && holds_key(number) ? number : (uint32_t)BLOCK_COUNT;
}

/* The number of the first block that takes a key; BLOCK_COUNT: there is none. */
static uint32_t first_usable(void)
{
    uint32_t number = 0;
    while (number < (uint32_t)BLOCK_COUNT && !was_key(number) && (is_locked(number) || !is_blank(number))) {
        number++;
    }
    return number < (uint32_t)BLOCK_COUNT && !was_key(number) ? number : (uint32_t)BLOCK_COUNT;
}

static bool is_new(void)
{
    bool all_new = true;
    for (uint32_t number = 0; number < (uint32_t)BLOCK_COUNT; number++) {
        all_new = all_new && is_blank(number) && !is_locked(number);
    }
    return all_new;
}

static bool spoil(uint32_t number)
{
    if (!could_become_key(number)) {
        return true;
    }
    const uintptr_t last = (uintptr_t)block(number) + (uintptr_t)BRACE_HAL_KEY_BYTES - 1u;
    return flash_program_byte(last, 0u) == BRACE_HAL_OK &&
           flash_program_byte(last + (uintptr_t)BRACE_HAL_KEY_BYTES, 0u) == BRACE_HAL_OK && !could_become_key(number);
}

/* false: something of it is left for the next start */
static bool lock_key(uint32_t number)
{
    bool is_safe = true;
    for (uint32_t before = 0; before < number; before++) { /* at most BLOCK_COUNT */
        is_safe = is_safe && spoil(before);
    }
    if (is_safe && !is_locked(number)) {
        is_safe = flash_program_byte(LOCKS_START + number, LOCKED) == BRACE_HAL_OK;
    }
    return is_safe && is_locked(number);
}

void board_key_start(void)
{
    const uint32_t number = flash_answers() ? first_with_key() : (uint32_t)BLOCK_COUNT;
    if (number < (uint32_t)BLOCK_COUNT && !is_locked(number)) {
        (void)lock_key(number);
    }
}

int32_t board_key_read(void *context, uint8_t key[BRACE_HAL_KEY_BYTES])
{
    (void)context;
    if (!flash_answers()) {
        return BRACE_HAL_E_DEVICE;
    }
    const uint32_t number = first_with_key();
    if (number == (uint32_t)BLOCK_COUNT) {
        return is_new() ? BRACE_HAL_KEY_NONE : BRACE_HAL_E_DAMAGED;
    }
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        key[i] = block(number)[i];
    }
    return is_locked(number) ? BRACE_HAL_KEY_LOCKED : BRACE_HAL_KEY_OPEN;
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
    const uint32_t number = first_usable();
    if (number == (uint32_t)BLOCK_COUNT) {
        return BRACE_HAL_E_DEVICE;
    }
    uint8_t content[BLOCK_BYTES];
    for (uint32_t i = 0; i < (uint32_t)BRACE_HAL_KEY_BYTES; i++) {
        content[i] = key[i];
        content[BRACE_HAL_KEY_BYTES + i] = (uint8_t)~key[i];
    }
    const int32_t written = flash_program((uintptr_t)block(number), content, BLOCK_BYTES);
    if (written != BRACE_HAL_OK || !holds_key(number)) {
        return BRACE_HAL_E_DEVICE;
    }
    return lock_key(number) ? BRACE_HAL_OK : BRACE_HAL_AGAIN;
}
