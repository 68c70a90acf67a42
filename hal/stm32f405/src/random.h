/* Random words of the chip's own generator (RM0090, 24), for challenges that nobody can predict. */
#ifndef STM32F405_RANDOM_H
#define STM32F405_RANDOM_H

#include <stdint.h>

void random_start(void);

/* As random_read of brace_hal.h. Blocks for at most 20 us; a word takes 1 us.
 * returns OK; E_DEVICE: no word came (its clock is the PLL's), or the generator reported a fault and starts anew */
int32_t random_read(void *context, uint32_t *word);

#endif
