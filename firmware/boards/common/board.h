/* What a board gives to main: its door, and a second clock by which the self-test judges the door's clock. */
#ifndef BRACE_BOARDS_BOARD_H
#define BRACE_BOARDS_BOARD_H

#include "brace_hal.h"

/* Starts the board. Once, from main; the door is never null and lives as long as the firmware. */
const brace_hal_t *board_start(void);

/* The parts of the board, for the banner: "2 joints by AS5047 on SPI1", "stand-in joints". Constant. */
const char *board_remark(void);

/* The rate of SysTick when it counts the processor's clock [Hz]. */
uint32_t board_core_hz(void);

/* What a board's own drivers have to do between ticks: bytes of a servo line. Called as often as there is time, and at
 * least once after each tick; bounded, and does not wait. */
void board_serve(void);

/* Sleeps until something may be to do: an interrupt came, or that much time is over. Returns at once on a board that
 * does not sleep. */
void board_rest(uint32_t at_most_us);

enum { BOARD_CONSOLE_BAUD = 115200 };

#endif
