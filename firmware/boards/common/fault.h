/* After a processor fault, an unexpected interrupt or the watchdog's warning: writes a record to kept memory and
 * resets. */
#ifndef BRACE_BOARDS_FAULT_H
#define BRACE_BOARDS_FAULT_H

#include <stdint.h>

/* The board's clock [us], for the record. It must only read a register, so that it works in any state. */
uint32_t board_now_us(void);

#endif
