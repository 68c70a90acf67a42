/* The serial ports of brace_hal.h on USART1-3. */
#ifndef STM32F405_SERIAL_H
#define STM32F405_SERIAL_H

#include "brace_hal_stm32f405.h"

/* Decides which USART each port is; board lives as long as the firmware. */
void serial_use(const stm32f405_board_t *board);

int32_t serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity);
int32_t serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);
int32_t serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room);

#endif
