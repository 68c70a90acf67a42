/* One value of a frame, at any place, of any width that the dictionary has. A step of 1: the value is multiplied by the
 * steps in one, once, and nothing else is made of either, so any number of steps is one of these. */
#include "can_bits.h"
#include "proof.h"

static void of_signed(float steps, uint32_t start, uint32_t count)
{
    const bool none = steps != steps;
    const int32_t most = (int32_t)(brace_bits_mask(count) >> 1);
    uint32_t limited = 0;
    const uint64_t bits = brace_bits_signed(steps, 1.0f, start, count, &limited);
    const int32_t code = brace_value_whole(bits, start, count);
    const float back = brace_value_signed(bits, start, count, 1.0f);
    PROVE((bits & ~((uint64_t)brace_bits_mask(count) << start)) == 0u, "no bit outside its place");
    PROVE((code == -most - 1) == none, "the reserved code says 'no number', and nothing else does");
    PROVE((back != back) == none, "read back: a number where there was one, and only there");
    PROVE(none || (code >= -most && code <= most), "limited, never wrapped");
    PROVE(code == 0 || none || (steps > 0.0f) == (code > 0), "the sign stays");
    PROVE(!(steps >= (float)most) || code == most, "beyond the top is the top");
    PROVE(!(steps <= (float)-most) || code == -most, "beyond the bottom is the bottom");
}

static void of_unsigned(float steps, uint32_t start, uint32_t count)
{
    const bool none = steps != steps;
    const uint32_t most = brace_bits_mask(count) - 1u;
    uint32_t limited = 0;
    const uint64_t bits = brace_bits_unsigned(steps, 1.0f, start, count, &limited);
    const uint32_t code = brace_value_number(bits, start, count);
    const float back = brace_value_unsigned(bits, start, count, 1.0f);
    PROVE((bits & ~((uint64_t)brace_bits_mask(count) << start)) == 0u, "unsigned: no bit outside its place");
    PROVE((code == most + 1u) == none, "unsigned: the reserved code says 'no number', and nothing else does");
    PROVE((back != back) == none, "unsigned, read back: a number where there was one, and only there");
    PROVE(none || steps > 0.0f || code == 0u, "unsigned: below 0 is 0");
    PROVE(!(steps >= (float)most) || code == most, "unsigned: beyond the top is the top");
}

int main(void)
{
    const float steps = any_float();
    const uint32_t start = any_u32();
    ASSUME(start <= 40u);
    switch (any_u8() % 8u) {
    case 0: of_signed(steps, start, 8); break;
    case 1: of_signed(steps, start, 16); break;
    case 2: of_signed(steps, start, 20); break;
    case 3: of_signed(steps, start, 24); break;
    case 4: of_unsigned(steps, start, 8); break;
    case 5: of_unsigned(steps, start, 16); break;
    case 6: of_unsigned(steps, start, 20); break;
    default: of_unsigned(steps, start, 24); break;
    }
    return 0;
}
