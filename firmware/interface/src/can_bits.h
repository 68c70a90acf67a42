/* Bits of a CAN frame as one number, first byte lowest, and values to and from a run of bits. Everything is inline:
 * start, count and step are constants at every call, so half of the instructions fall away. */
#ifndef BRACE_CAN_BITS_H
#define BRACE_CAN_BITS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static inline void brace_bits_store(uint64_t bits, uint8_t data[8])
{
    const uint32_t low = (uint32_t)bits, high = (uint32_t)(bits >> 32);
    data[0] = (uint8_t)low;
    data[1] = (uint8_t)(low >> 8);
    data[2] = (uint8_t)(low >> 16);
    data[3] = (uint8_t)(low >> 24);
    data[4] = (uint8_t)high;
    data[5] = (uint8_t)(high >> 8);
    data[6] = (uint8_t)(high >> 16);
    data[7] = (uint8_t)(high >> 24);
}

static inline uint64_t brace_bits_load(const uint8_t data[8])
{
    const uint32_t low = (uint32_t)data[0] | (uint32_t)data[1] << 8 | (uint32_t)data[2] << 16 | (uint32_t)data[3] << 24;
    const uint32_t high =
        (uint32_t)data[4] | (uint32_t)data[5] << 8 | (uint32_t)data[6] << 16 | (uint32_t)data[7] << 24;
    return (uint64_t)high << 32 | low;
}

static inline uint32_t brace_bits_mask(uint32_t count)
{
    return 0xffffffffu >> (32u - count);
}

static inline uint64_t brace_bits_placed(uint32_t code, uint32_t start, uint32_t count)
{
    return (uint64_t)(code & brace_bits_mask(count)) << start;
}

/* Is a value beyond [low, high]? At 24 bits a float rounds by up to a step, so only a value that is more than one step
 * beyond counts as limited. */
static inline int32_t brace_bits_beyond(float steps, int32_t low, int32_t high, int32_t unknown, uint32_t *limited)
{
    if (isnan(steps)) {
        return unknown;
    }
    const bool above = steps >= (float)high;
    *limited += (above ? steps - (float)high : (float)low - steps) > 1.0f;
    return above ? high : low;
}

/* A value in steps. NaN becomes the code of 'not known'. A value beyond the range is limited and counted. */
static inline uint64_t brace_bits_signed(float value, float per_step, uint32_t start, uint32_t count, uint32_t *limited)
{
    const int32_t high = (int32_t)(brace_bits_mask(count) >> 1);
    const float steps = value * per_step;
    const int32_t code = __builtin_fabsf(steps) < (float)high
                             ? (int32_t)(steps + __builtin_copysignf(0.5f, steps)) /* nearest, halves up in size */
                             : brace_bits_beyond(steps, -high, high, -high - 1, limited);
    return brace_bits_placed((uint32_t)code, start, count);
}

static inline uint64_t brace_bits_unsigned(float value, float per_step, uint32_t start, uint32_t count,
                                           uint32_t *limited)
{
    const int32_t high = (int32_t)(brace_bits_mask(count) - 1u);
    const float steps = value * per_step;
    const float half = steps > 0x1p22f ? 0.0f : 0.5f; /* beyond this size a float has no halves */
    const int32_t code = steps > 0.0f && steps < (float)high ? (int32_t)(steps + half)
                                                             : brace_bits_beyond(steps, 0, high, high + 1, limited);
    return brace_bits_placed((uint32_t)code, start, count);
}

static inline uint64_t brace_bits_number(uint32_t value, uint32_t start, uint32_t count, uint32_t *limited)
{
    const uint32_t high = brace_bits_mask(count);
    *limited += value > high;
    return brace_bits_placed(value > high ? high : value, start, count);
}

static inline uint64_t brace_bits_whole(int32_t value, uint32_t start, uint32_t count, uint32_t *limited)
{
    const int32_t high = (int32_t)(brace_bits_mask(count) >> 1);
    const int32_t kept = value > high ? high : value < -high - 1 ? -high - 1 : value;
    *limited += kept != value;
    return brace_bits_placed((uint32_t)kept, start, count);
}

static inline uint64_t brace_bits_float(float value, uint32_t start)
{
    uint32_t code;
    memcpy(&code, &value, sizeof code);
    return (uint64_t)code << start;
}

static inline uint32_t brace_value_number(uint64_t bits, uint32_t start, uint32_t count);
static inline int32_t brace_value_whole(uint64_t bits, uint32_t start, uint32_t count);

static inline float brace_value_signed(uint64_t bits, uint32_t start, uint32_t count, float step)
{
    const int32_t code = brace_value_whole(bits, start, count);
    return code == -(int32_t)(brace_bits_mask(count) >> 1) - 1 ? NAN : (float)code * step;
}

static inline float brace_value_unsigned(uint64_t bits, uint32_t start, uint32_t count, float step)
{
    const uint32_t code = brace_value_number(bits, start, count);
    return code == brace_bits_mask(count) ? NAN : (float)code * step;
}

static inline uint32_t brace_value_number(uint64_t bits, uint32_t start, uint32_t count)
{
    return (uint32_t)(bits >> start) & brace_bits_mask(count);
}

static inline int32_t brace_value_whole(uint64_t bits, uint32_t start, uint32_t count)
{
    const uint32_t code = brace_value_number(bits, start, count);
    const uint32_t sign = 1u << (count - 1u);
    return (int32_t)((code ^ sign) - sign);
}

static inline float brace_value_float(uint64_t bits, uint32_t start)
{
    const uint32_t code = (uint32_t)(bits >> start);
    float value;
    memcpy(&value, &code, sizeof value);
    return value;
}

#endif
