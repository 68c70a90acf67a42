#include "modbus/crc.h"

uint16_t modbus_crc(uint16_t crc, const uint8_t *bytes, uint32_t count)
{
    uint32_t sum = crc;
    for (uint32_t i = 0; i < count; i++) { /* at most 256: no frame is longer */
        /* The eight steps at once: a set bit pushes the polynomial's low terms 6 and 7 places up, its high ones when
         * an odd number of bits is set; 0x6996 holds the parity of every nibble. */
        const uint32_t low = (sum ^ bytes[i]) & 0xffu;
        const uint32_t odd = 0x6996u >> ((low ^ low >> 4) & 0xfu) & 1u;
        sum = sum >> 8 ^ low << 6 ^ low << 7 ^ (odd != 0u ? 0xc001u : 0u);
    }
    return (uint16_t)sum;
}
