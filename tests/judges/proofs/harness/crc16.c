/* modbus_crc is the CRC-16 of Modbus over serial line 1.02, 6.2.2, bit by bit, going on from any earlier value. */
#include "wire/modbus/crc.h"
#include "proof.h"

enum { MOST = 6 };

static uint16_t bit_by_bit(uint16_t crc, const uint8_t *bytes, uint32_t count)
{
    uint32_t sum = crc;
    for (uint32_t i = 0; i < 8u * count; i++) {
        const uint32_t bit = (sum ^ (uint32_t)bytes[i / 8u] >> (i % 8u)) & 1u;
        sum = sum >> 1 ^ (bit != 0u ? 0xa001u : 0u);
    }
    return (uint16_t)sum;
}

int main(void)
{
    uint8_t bytes[MOST];
    const uint16_t start = any_u16();
    const uint32_t count = any_u32();
    ANY(bytes);
    ASSUME(count <= MOST);
    PROVE(modbus_crc(start, bytes, count) == bit_by_bit(start, bytes, count), "CRC-16 as defined");
    return 0;
}
