/* The flash interface: unlocking it, programming words, erasing a sector. */
#ifndef STM32F405_FLASH_PROGRAM_H
#define STM32F405_FLASH_PROGRAM_H

#include <stdbool.h>
#include <stdint.h>

enum { FLASH_WORD_BYTES = 4 };

/* Does the flash interface answer? It is locked at rest. An emulator that lacks it lacks the one-time programmable
 * memory too, and a read of that memory would be a bus fault there. */
bool flash_answers(void);

/* Programs whole words, in rising order; a word takes 16 us, at most 100 us.
 *   address: of erased memory, a multiple of FLASH_WORD_BYTES; count: of bytes, too
 * returns OK; E_DEVICE: the supply is low, the interface stays locked, or a word was not programmed */
int32_t flash_program(uintptr_t address, const uint8_t *bytes, uint32_t count);

/* The same for one byte at any address, as the lock bytes of the one-time programmable memory need it. */
int32_t flash_program_byte(uintptr_t address, uint8_t byte);

/* Erases a sector; the processor stands still until it is done. timeout_us: at least twice what the sector takes
 * returns OK or E_DEVICE */
int32_t flash_erase_sector(uint8_t sector, uint32_t timeout_us);

#endif
