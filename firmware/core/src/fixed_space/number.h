/* Numbers of the loaded limb in space, in fixed point.
 *
 * Units: of length, a power of two above the reach; of force, one above the sum of the loads. Each kind of number has
 * one format, which all files of this path share; _q28 is a number times 2^28 in 32 bits:
 *
 *   lengths                                                      q28   (-8 to 8)
 *   directions, forces, shares                                   q30   (-2 to 2)
 *   angles, ratios of entries                                    q29   (-4 to 4)
 *   compliances per angle                                        q26   (0 to 32)
 *   compliances of axial springs and of the base                 q33   (0 to 1/4)
 *   moments                                                      q27   (-16 to 16)
 *   entries of the matrix, what drives a coordinate              q24   (-128 to 128)
 *   pivots, one over a pivot                                     q27   (0 to 16)
 *   levers: how the tip moves with a coordinate                  q26   (-32 to 32)
 *
 * A sum of products is added up in 64 bits. `coarse` keeps its high word alone, so that a few last bits are zero.
 *
 * All sums wrap. Whatever a load may drive beyond its kind's limit is noted where it is made, before it can wrap, and a
 * limb of which anything was noted is refused. So nothing branches on the way. docs/kernel.md ("In space without FPU")
 * argues that nothing wraps before.
 */
#ifndef BRACE_CORE_FIXED_SPACE_NUMBER_H
#define BRACE_CORE_FIXED_SPACE_NUMBER_H

#include <stdbool.h>

#include "loaded/fixed_vec.h"

/* --- sums ----------------------------------------------------------------------------------------------------- */

INLINE int32_t plus(int32_t a, int32_t b)
{
    return wrapped_plus(a, b);
}

INLINE int32_t less(int32_t a, int32_t b)
{
    return wrapped_less(a, b);
}

INLINE int32_t minus(int32_t a)
{
    return wrapped_less(0, a);
}

INLINE int32_t twice(int32_t a)
{
    return wrapped_plus(a, a);
}

INLINE int32_t high_of(int32_t a, int32_t b)
{
    return brace_high_word((int64_t)a * b);
}

/* a times a direction, a share or a force (q30); in a's format. */
INLINE int32_t by_q30(int32_t a, int32_t by_q30)
{
    return coarse_times(a, by_q30, 30);
}

/* a times an angle or a ratio (q29); in a's format. */
INLINE int32_t by_q29(int32_t a, int32_t by_q29)
{
    return coarse_times(a, by_q29, 29);
}

/* --- what is refused ------------------------------------------------------------------------------------------ */

/* Magnitudes, or-ed. */
typedef uint32_t noted_t;
#define NOTED_BITS 10

/* Notes a word whose magnitude is 2^bits or more. */
INLINE void note(noted_t *noted, int32_t word, int bits)
{
    *noted |= magnitude_of(word) >> (bits - NOTED_BITS);
}

INLINE bool is_refused(noted_t noted)
{
    return noted >> NOTED_BITS != 0u;
}

/* --- division ------------------------------------------------------------------------------------------------- */

/* Number of leading zeros of 64 bits that are not all zero, without a branch. */
INLINE uint32_t zeros_of(uint64_t number)
{
    const uint32_t top = (uint32_t)(number >> 32), is_low = (uint32_t)(top == 0u);
    return 32u * is_low + leading_zeros((is_low != 0u ? (uint32_t)number : top) | is_low);
}

/* A number shifted up until its leading bit is the highest of 32. */
INLINE uint32_t leading_of(uint64_t number, uint32_t zeros)
{
    return (uint32_t)((number << zeros) >> 32);
}

/* 2^61 over a number whose highest bit is set: sixteen bits by division, the rest by a step of Newton's method. */
INLINE uint32_t over_q61(uint32_t leading)
{
    const uint32_t guess = (0x80000000u / (leading >> 16)) << 15;
    return high_unsigned(guess, (0x80000000u - high_unsigned(leading, guess)) << 1);
}

/* --- compliances ---------------------------------------------------------------------------------------------- */

/* Formats of compliances and ratios, and the most of a ratio and of a row's entry as powers of two. For the buckling
 * factor, which takes the load many times, ranges are wider: forces are a 16th, compliances as many times as large. */
typedef struct {
    int yields, ratio, ratio_most, row_most_bits;
} ranges_t;

#define RANGES ((ranges_t){26, 29, 1, 27})
#define OVERLOAD_RANGES ((ranges_t){14, 25, 5, 24})

/* A ratio or an angle from a compliance and an entry (q24). */
INLINE int32_t yielded_to(int32_t yields, int32_t entry_q24, ranges_t ranges, noted_t *noted)
{
    const int64_t product = (int64_t)yields * entry_q24;
    note(noted, brace_high_word(product), ranges.yields + 24 - 32 + ranges.ratio_most);
    return shifted(product, ranges.yields + 24 - ranges.ratio);
}

/* a times a ratio; in a's format. */
INLINE int32_t by_ratio(int32_t a, int32_t ratio, ranges_t ranges)
{
    return ranges.ratio == 29 ? by_q29(a, ratio) : times(a, ratio, ranges.ratio);
}

/* An angle from a compliance and what drives it; at most 2 rad. */
INLINE int32_t angle_of(int32_t yields_q26, int32_t driven_q24, noted_t *noted)
{
    return yielded_to(yields_q26, driven_q24, RANGES, noted);
}

#define PIVOT_LEAST_Q27 (ONE_Q27 / 16 + 1024)

/* 1 + a compliance times an entry; at most 9, at least a sixteenth. */
INLINE int32_t pivot_of(int32_t yields_q26, int32_t entry_q24, noted_t *noted)
{
    const int64_t product = (int64_t)yields_q26 * entry_q24;
    note(noted, brace_high_word(product), 21);
    const int32_t pivot = plus(ONE_Q27, shifted(product, 23));
    *noted |= (uint32_t)(less(pivot, PIVOT_LEAST_Q27) >> 31);
    return pivot < PIVOT_LEAST_Q27 ? PIVOT_LEAST_Q27 : pivot;
}

/* A compliance with its load, at most 16. */
INLINE int32_t softened_of(int32_t yields_q26, int32_t per_pivot_q27, noted_t *noted)
{
    const int64_t product = (int64_t)yields_q26 * per_pivot_q27;
    note(noted, brace_high_word(product), 25);
    return shifted(product, 27);
}

#endif
