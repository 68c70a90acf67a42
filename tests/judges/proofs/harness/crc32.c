/* brace_crc32 is the CRC-32 of IEEE 802.3, bit by bit, going on from any earlier value. */
#include "brace/parameters.h"
#include "proof.h"

enum { MOST = 3 };

/* x^32 + x^26 + ... + 1, reflected; ones before and after, which cancel where one call goes on from another. */
static uint32_t bit_by_bit(uint32_t crc, const uint8_t *bytes, uint32_t count)
{
    crc = ~crc;
    for (uint32_t i = 0; i < 8u * count; i++) {
        const uint32_t bit = (crc ^ (uint32_t)bytes[i / 8u] >> (i % 8u)) & 1u;
        crc = crc >> 1 ^ (bit != 0u ? 0xedb88320u : 0u);
    }
    return ~crc;
}

int main(void)
{
    uint8_t bytes[MOST];
    const uint32_t start = any_u32(), count = any_u32();
    ANY(bytes);
    ASSUME(count <= MOST);
    PROVE(brace_crc32(start, bytes, count) == bit_by_bit(start, bytes, count), "CRC-32 as defined");
    return 0;
}
