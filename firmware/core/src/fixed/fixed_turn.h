/* Angles as 32-bit fractions of a turn, 2^32 to the turn. They add, subtract and wrap as integers, without loss. */
#ifndef BRACE_CORE_FIXED_TURN_H
#define BRACE_CORE_FIXED_TURN_H

#include <stdint.h>

/* The high word of a 64-bit sum or product. */
static inline int32_t brace_high_word(int64_t sum)
{
    return (int32_t)(uint32_t)((uint64_t)sum >> 32);
}

/* An angle in turns, from radians q28, |theta| < 8 rad. The factor 16 * 2^32 / (2 pi), as q32, is 3 * 2^32 -
 * 1947857479. */
static inline uint32_t brace_turn_from_q28(int32_t theta_rad_q28)
{
    return 3u * (uint32_t)theta_rad_q28 + (uint32_t)brace_high_word((int64_t)theta_rad_q28 * -1947857479);
}

#endif
