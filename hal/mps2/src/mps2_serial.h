/* Serial ports of the MPS2 board: entries as in brace_hal.h. */
#ifndef MPS2_SERIAL_H
#define MPS2_SERIAL_H

#include "brace_hal.h"

int32_t mps2_serial_setup(void *context, brace_serial_port_t port, uint32_t baud, brace_parity_t parity);
int32_t mps2_serial_write(void *context, brace_serial_port_t port, const uint8_t *bytes, uint32_t count);
int32_t mps2_serial_read(void *context, brace_serial_port_t port, uint8_t *bytes, uint32_t room);

#endif
