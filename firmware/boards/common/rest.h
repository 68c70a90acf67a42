/* Rest between ticks for emulated boards: a processor that spins takes one of the host's.
 *
 * It does not rest within a Modbus frame. An emulator that counts instructions lets its clock follow the host's while
 * the processor sleeps; then a pause of the host would look like the silence that ends a frame. */
#ifndef BRACE_BOARDS_REST_H
#define BRACE_BOARDS_REST_H

#include "brace_hal.h"

/* Watches the door's Modbus port. Once, before rest_sleep; core_hz: what SysTick counts, at least 1 MHz. */
void rest_start(brace_hal_t *door, uint32_t core_hz);

/* Sleeps until an interrupt, at most so long. It takes SysTick for that time. */
void rest_sleep(uint32_t at_most_us);

#endif
