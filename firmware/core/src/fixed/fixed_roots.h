/* Roots, quotients and angles from tables, each of one number: tests/judges/proofs goes through all of them. */
#ifndef BRACE_CORE_FIXED_ROOTS_H
#define BRACE_CORE_FIXED_ROOTS_H

#include "fixed/fixed_table.h"
#include "fixed/fixed_word.h"

/* One over the root of a number from a quarter to 1, given by its 32 bits (q32). A table guesses it, and one step of
 * Newton's method makes it exact. */
static inline uint32_t fixed_per_root_q27(uint32_t number_q32)
{
    const brace_fixed_seed_t seed = brace_fixed_seed[number_q32 >> 26];
    const uint32_t across_cell = (number_q32 >> 10) & 0xffffu;
    const uint32_t guess_q29 = ((uint32_t)seed.at_q13 << 16) - (uint32_t)seed.slope_q13 * across_cell;
    const uint32_t excess_q26 = high_unsigned(high_unsigned(guess_q29, guess_q29), number_q32);
    return high_unsigned(guess_q29, (RSQRT_THREE_Q26 - excess_q26) << 3);
}

/* 2^59 over a number that is at least 2^29: sixteen bits by division, the rest by one step of Newton's method. */
static inline uint32_t fixed_per_product(uint32_t number)
{
    const uint32_t quotient = (0x80000000u / (number >> 16)) << 13;
    return high_unsigned(quotient, (0x20000000u - high_unsigned(number, quotient)) << 3);
}

/* The entry of the sine table nearest to a unit vector, and the sine of the angle from there. */
static inline int32_t fixed_off_entry_q32(int32_t cosine_q26, int32_t sine_q26, uint32_t *entry)
{
    *entry = brace_fixed_cell[((uint32_t)sine_q26 >> 23) & 15u][((uint32_t)cosine_q26 >> 23) & 15u];
    const brace_sincos_t opposite = brace_fixed_sincos[*entry];
    return (int32_t)((uint32_t)high_sum(sine_q26, opposite.cos_q31, cosine_q26, opposite.sin_q31) << 7);
}

#endif
