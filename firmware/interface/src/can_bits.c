#include "can_bits.h"

#include <math.h>
#include <string.h>

void brace_bits_store(uint64_t bits, uint8_t data[8])
{
    for (uint32_t i = 0u; i < 8u; i++) {
        data[i] = (uint8_t)(bits >> (8u * i));
    }
}

uint64_t brace_bits_load(const uint8_t data[8])
{
    uint64_t bits = 0u;
    for (uint32_t i = 0u; i < 8u; i++) {
        bits |= (uint64_t)data[i] << (8u * i);
    }
    return bits;
}

static uint32_t mask_of(uint32_t count)
{
    return 0xffffffffu >> (32u - count);
}

static uint64_t placed(uint32_t code, uint32_t start, uint32_t count)
{
    return (uint64_t)(code & mask_of(count)) << start;
}

/* Nearest whole number within [low, high], halves away from zero. At 24 bits a float rounds by up to a step: only more
 * than that beyond the range counts as limited. */
static int32_t nearest(float steps, int32_t low, int32_t high, uint32_t *limited)
{
    if (steps >= (float)high) {
        *limited += steps - (float)high > 1.0f;
        return high;
    }
    if (steps <= (float)low) {
        *limited += (float)low - steps > 1.0f;
        return low;
    }
    const float half = steps < -0x1p22f || steps > 0x1p22f ? 0.0f : 0.5f; /* beyond, a float knows no finer */
    return (int32_t)(steps < 0.0f ? steps - half : steps + half);
}

uint64_t brace_bits_signed(float value, float per_step, uint32_t start, uint32_t count, uint32_t *limited)
{
    const int32_t high = (int32_t)(mask_of(count) >> 1);
    const int32_t code = isnan(value) ? -high - 1 : nearest(value * per_step, -high, high, limited);
    return placed((uint32_t)code, start, count);
}

uint64_t brace_bits_unsigned(float value, float per_step, uint32_t start, uint32_t count, uint32_t *limited)
{
    const int32_t high = (int32_t)(mask_of(count) - 1u);
    const int32_t code = isnan(value) ? high + 1 : nearest(value * per_step, 0, high, limited);
    return placed((uint32_t)code, start, count);
}

uint64_t brace_bits_number(uint32_t value, uint32_t start, uint32_t count, uint32_t *limited)
{
    const uint32_t high = mask_of(count);
    *limited += value > high;
    return placed(value > high ? high : value, start, count);
}

uint64_t brace_bits_whole(int32_t value, uint32_t start, uint32_t count, uint32_t *limited)
{
    const int32_t high = (int32_t)(mask_of(count) >> 1);
    const int32_t kept = value > high ? high : value < -high - 1 ? -high - 1 : value;
    *limited += kept != value;
    return placed((uint32_t)kept, start, count);
}

uint64_t brace_bits_float(float value, uint32_t start)
{
    uint32_t code;
    memcpy(&code, &value, sizeof code);
    return (uint64_t)code << start;
}

float brace_value_signed(uint64_t bits, uint32_t start, uint32_t count, float step)
{
    const int32_t code = brace_value_whole(bits, start, count);
    return code == -(int32_t)(mask_of(count) >> 1) - 1 ? NAN : (float)code * step;
}

float brace_value_unsigned(uint64_t bits, uint32_t start, uint32_t count, float step)
{
    const uint32_t code = brace_value_number(bits, start, count);
    return code == mask_of(count) ? NAN : (float)code * step;
}

uint32_t brace_value_number(uint64_t bits, uint32_t start, uint32_t count)
{
    return (uint32_t)(bits >> start) & mask_of(count);
}

int32_t brace_value_whole(uint64_t bits, uint32_t start, uint32_t count)
{
    const uint32_t code = brace_value_number(bits, start, count);
    const uint32_t sign = 1u << (count - 1u);
    return (int32_t)((code ^ sign) - sign);
}

float brace_value_float(uint64_t bits, uint32_t start)
{
    const uint32_t code = (uint32_t)(bits >> start);
    float value;
    memcpy(&value, &code, sizeof value);
    return value;
}
