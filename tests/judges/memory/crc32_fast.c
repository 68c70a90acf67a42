/* The firmware's CRC, eight bytes a step: the enumerations spend half their time in it otherwise. The linker takes this
 * one and leaves the firmware's in its library; tests/unit/interface judges that. */
#include "brace/parameters.h"

enum { SLICES = 8 };

static uint32_t table[SLICES][256];

static void make_table(void)
{
    for (uint32_t byte = 0; byte < 256u; byte++) {
        uint32_t crc = byte;
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
        }
        table[0][byte] = crc;
    }
    for (uint32_t byte = 0; byte < 256u; byte++) {
        for (int slice = 1; slice < SLICES; slice++) {
            const uint32_t before = table[slice - 1][byte];
            table[slice][byte] = (before >> 8) ^ table[0][before & 255u];
        }
    }
}

uint32_t brace_crc32(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    if (table[0][1] == 0) {
        make_table();
    }
    crc = ~crc;
    for (; count >= SLICES; count -= SLICES, bytes += SLICES) {
        uint32_t next = 0;
        for (uint32_t i = 0; i < SLICES; i++) {
            const uint32_t mixed = i < 4u ? bytes[i] ^ (crc >> (8u * i) & 255u) : bytes[i];
            next ^= table[SLICES - 1u - i][mixed];
        }
        crc = next;
    }
    for (; count > 0; count--, bytes++) {
        crc = (crc >> 8) ^ table[0][(crc ^ *bytes) & 255u];
    }
    return ~crc;
}
