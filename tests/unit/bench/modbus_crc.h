/* The CRC of Modbus over serial line 1.02, appendix B, bit by bit: what tests and fuzzers judge the controller's by. */
#ifndef MODBUS_CRC_H
#define MODBUS_CRC_H

#include <stdint.h>

/* Shift right, exclusive or with 0xa001 when a one falls out. 0 over a whole sound frame. */
static inline uint32_t crc_by_bits(const uint8_t *bytes, uint32_t count)
{
    uint32_t crc = 0xffff;
    for (uint32_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 1u) != 0u ? crc >> 1 ^ 0xa001u : crc >> 1;
        }
    }
    return crc;
}

#endif
