/* Modbus' numbers: the high byte comes first, and of a 32-bit value the high word. */
#ifndef BRACE_WIRE_MODBUS_BYTES_H
#define BRACE_WIRE_MODBUS_BYTES_H

#include <stdint.h>

static inline uint32_t get_16(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 8 | bytes[1];
}

static inline uint32_t get_32(const uint8_t *bytes)
{
    return get_16(bytes) << 16 | get_16(bytes + 2);
}

static inline void put_16(uint8_t *bytes, uint32_t value)
{
    bytes[0] = (uint8_t)(value >> 8);
    bytes[1] = (uint8_t)value;
}

static inline void put_32(uint8_t *bytes, uint32_t value)
{
    bytes[0] = (uint8_t)(value >> 24);
    bytes[1] = (uint8_t)(value >> 16);
    bytes[2] = (uint8_t)(value >> 8);
    bytes[3] = (uint8_t)value;
}

#endif
