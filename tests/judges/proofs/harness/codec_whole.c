/* Whole numbers and floats of a frame, and the 64 bits as bytes. */
#include "can_bits.h"
#include "proof.h"

int main(void)
{
    const uint32_t value = any_u32(), count = any_u32(), start = any_u32();
    const int32_t whole = any_i32();
    const uint64_t bits = any_u64();
    const float real = any_float();
    uint32_t limited = 0, limited_whole = 0;
    uint8_t data[8];
    ASSUME(count >= 1u && count <= 32u && start <= 64u - count);
    const uint32_t mask = brace_bits_mask(count);

    const uint64_t n = brace_bits_number(value, start, count, &limited);
    PROVE((n & ~((uint64_t)mask << start)) == 0u, "no bit outside its place");
    PROVE(brace_value_number(n, start, count) == (value > mask ? mask : value), "limited, never wrapped");
    PROVE(limited == (value > mask), "limiting is counted");

    const uint64_t w = brace_bits_whole(whole, start, count, &limited_whole);
    const int32_t high = (int32_t)(mask >> 1), back = brace_value_whole(w, start, count);
    PROVE((w & ~((uint64_t)mask << start)) == 0u, "no bit outside its place, signed");
    PROVE(back == (whole > high ? high : whole < -high - 1 ? -high - 1 : whole), "limited, never wrapped, signed");
    PROVE((limited_whole != 0u) == (back != whole), "limiting is counted, signed");

    const uint64_t f = brace_bits_float(real, start <= 32u ? start : 32u);
    const float real_back = brace_value_float(f, start <= 32u ? start : 32u);
    PROVE(memcmp(&real_back, &real, 4) == 0, "a float comes back bit for bit");

    brace_bits_store(bits, data);
    PROVE(brace_bits_load(data) == bits, "eight bytes are the 64 bits");
    return 0;
}
