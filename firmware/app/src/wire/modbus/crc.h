/* The check of a Modbus RTU frame: CRC-16, x^16 + x^15 + x^2 + 1, reflected, from 0xffff; low byte first on the line
 * (Modbus over serial line 1.02, 6.2.2). Over a frame together with its check it comes to 0. */
#ifndef BRACE_WIRE_MODBUS_CRC_H
#define BRACE_WIRE_MODBUS_CRC_H

#include <stdint.h>

#define MODBUS_CRC_START 0xffffu

/* Goes on from `crc` over `count` bytes. Cost: 7 instructions a byte. */
uint16_t modbus_crc(uint16_t crc, const uint8_t *bytes, uint32_t count);

#endif
