/* What a board gives to main: its door, and a count to judge the clock by. */
#ifndef BRACE_BOARDS_BOARD_H
#define BRACE_BOARDS_BOARD_H

#include "brace_hal.h"

/* Starts the board. Once, from main; the door is never null and lives as long as the firmware. */
const brace_hal_t *board_start(void);

/* What the board is made of, for the banner: "2 joints by AS5047 on SPI1", "stand-in joints". Constant. */
const char *board_remark(void);

/* What SysTick counts when it counts the processor's clock [Hz]. */
uint32_t board_core_hz(void);

enum { BOARD_CONSOLE_BAUD = 115200 };

#endif
