/* This board's door (brace_hal.h). */
#ifndef BOARD_H
#define BOARD_H

#include "brace_hal.h"

/* Starts clock and memory; the door, constant. Call it once, first of all. */
const brace_hal_t *board_start(void);

#endif
