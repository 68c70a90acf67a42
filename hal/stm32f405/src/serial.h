/* The serial ports of brace_hal.h on USART1-3. */
#ifndef STM32F405_SERIAL_H
#define STM32F405_SERIAL_H

#include "brace_hal_stm32f405.h"

/* Decides which USART each port is; board lives as long as the firmware. */
void serial_use(const stm32f405_board_t *board);

int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity);
int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);
int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room);

/* Waits until what was written has left and each transmitter is off its line, but no longer than that. For whoever
 * stops the processor: a direction pin falls in an interrupt, and until then nobody else can use the line. */
void serial_finish(uint32_t at_most_us);

#endif
