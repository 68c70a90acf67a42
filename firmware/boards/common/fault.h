/* A processor fault, an interrupt nobody asked for, or the watchdog's warning: a record in kept memory, and a reset. */
#ifndef BRACE_BOARDS_FAULT_H
#define BRACE_BOARDS_FAULT_H

#include <stdint.h>

/* The board's clock [us], for the record: a register read that needs nothing to work. */
uint32_t board_now_us(void);

#endif
