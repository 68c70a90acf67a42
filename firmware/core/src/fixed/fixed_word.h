/* 32-bit words: their products, and floats from and to them.
 *
 * Formats of names: _q31 is a number times 2^31 in 32 bits. A product of two words keeps only its high word: q31 times
 * q31 gives q30.
 */
#ifndef BRACE_CORE_FIXED_WORD_H
#define BRACE_CORE_FIXED_WORD_H

#include <stdint.h>
#include <string.h>

#include "fixed/fixed_turn.h"

/* The whole product. */
static inline int64_t whole_product(int32_t a, int32_t b)
{
    return (int64_t)a * b;
}

static inline int32_t high(int32_t a, int32_t b)
{
    return brace_high_word(whole_product(a, b));
}

static inline uint32_t high_unsigned(uint32_t a, uint32_t b)
{
    return (uint32_t)(((uint64_t)a * b) >> 32);
}

/* a b + c d, whole. */
static inline int64_t whole_sum(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return whole_product(a, b) + whole_product(c, d);
}

/* Its high word. */
static inline int32_t high_sum(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return brace_high_word(whole_sum(a, b, c, d));
}

/* Number of leading zeros of a word that is not zero. */
static inline uint32_t leading_zeros(uint32_t word)
{
    return (uint32_t)__builtin_clz(word);
}

/* An IEEE float's bits from magnitude 2^(exponent field - 157), truncated. The magnitude is not zero. The shift brings
 * the magnitude's highest bit to bit 23, where it adds one to the exponent field; so the field here is one less. */
static inline uint32_t float_bits(uint32_t magnitude, uint32_t exponent_field)
{
    const uint32_t zeros = leading_zeros(magnitude);
    return exponent_field - (zeros << 23) + ((magnitude << zeros) >> 8);
}

static inline float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* |value|; one unit of the last place too small for a negative value. */
static inline uint32_t magnitude_of(int32_t value)
{
    return (uint32_t)(value ^ (value >> 31));
}

/* The sign bit of a float. */
static inline uint32_t sign_of(int32_t value)
{
    return (uint32_t)value & 0x80000000u;
}

/* A float's bits. */
static inline uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

#endif
