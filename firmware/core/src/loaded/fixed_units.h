/* What a collapsed limb keeps so that no number of loaded_fixed.c leaves its word under any load. The collapse looks
 * for it last, in integers; the proofs of loaded_fixed.c stand on it (tests/judges/proofs/harness/loaded_sizes.h). */
#ifndef BRACE_LOADED_FIXED_UNITS_H
#define BRACE_LOADED_FIXED_UNITS_H

#include <stdbool.h>

#include "brace/loaded_fixed_types.h"
#include "fixed/fixed_word.h"

/* Lengths, and what rounding adds to that of a vector, that of floats too. A link tilted by a quarter turn is the root
 * of two times as far from its beam as it is long. */
#define UNIT_REACH_MOST_Q28 ((1LL << 28) + 16)
#define UNIT_OFF_Q28 64
#define UNIT_ROOT_OF_TWO_Q15 46341LL
#define UNIT_ROOT_MOST_Q31 ((1LL << 31) + 1024)
#define UNIT_WEIGHTS_OFF_Q31 256
#define UNIT_WEIGHT_MOST_Q8 (3u << 29)

/* Exponents: of a float's, and such that K and what moves are floats. */
#define UNIT_LENGTH_EXPONENT_LEAST 1
#define UNIT_LENGTH_EXPONENT_MOST 20
#define UNIT_WEIGHT_EXPONENT_MOST 22
#define UNIT_EXPONENT_MOST 60
#define UNIT_EXPONENT_LEAST (-200)

static inline bool unit_holds(int32_t number, int64_t least, int64_t most)
{
    return number >= least && number <= most;
}

static inline bool unit_is_shorter(brace_fixed_vec_t v, int64_t most)
{
    const uint64_t square = (uint64_t)((int64_t)v.x * v.x) + (uint64_t)((int64_t)v.z * v.z);
    return square <= (uint64_t)most * (uint64_t)most;
}

static inline bool unit_are_roots(const brace_fixed_vec_t roots_q31[2])
{
    return unit_is_shorter(roots_q31[0], UNIT_ROOT_MOST_Q31) && unit_is_shorter(roots_q31[1], UNIT_ROOT_MOST_Q31);
}

static inline bool unit_is_link(const brace_loaded_fixed_link_t *link)
{
    const int64_t length_q28 = link->length_q28, to_beam_q28 = (length_q28 * UNIT_ROOT_OF_TWO_Q15) >> 15;
    return length_q28 >= 0 && unit_is_shorter(link->beam_q28, length_q28 + UNIT_OFF_Q28) &&
           unit_is_shorter(link->to_beam_q28, to_beam_q28 + UNIT_OFF_Q28) && unit_are_roots(link->root_root_q31) &&
           unit_are_roots(link->end_root_q31) && link->bend_q31 >= 0 && link->end_q31 >= 0;
}

/* The unit of force is made from weight_q8, one and a half times the weight. */
static inline bool unit_are_weights(const brace_loaded_fixed_t *fixed)
{
    const int64_t all = fixed->weight_q31, knee = fixed->knee_q31, femur = fixed->femur.weight_q31;
    const int32_t down = 31 - fixed->weight_exponent;
    const uint64_t all_q8 = ((uint64_t)all * 384u) >> (down > 63 ? 63 : down);
    return all >= 0 && femur >= 0 && fixed->tibia.weight_q31 >= 0 && fixed->tibia.weight_q31 <= knee &&
           knee + femur <= all + UNIT_WEIGHTS_OFF_Q31 && fixed->weight_q8 <= UNIT_WEIGHT_MOST_Q8 &&
           all_q8 <= fixed->weight_q8 + 1u &&
           fixed->weight_exponent <= 24 - (int32_t)leading_zeros(fixed->weight_q8 + 2u);
}

static inline bool unit_are_exponents(const brace_loaded_fixed_t *fixed)
{
    return unit_holds(fixed->length_exponent, UNIT_LENGTH_EXPONENT_LEAST, UNIT_LENGTH_EXPONENT_MOST) &&
           unit_holds(fixed->bend_exponent, UNIT_EXPONENT_LEAST, UNIT_EXPONENT_MOST) &&
           unit_holds(fixed->spring_exponent, UNIT_EXPONENT_LEAST, UNIT_EXPONENT_MOST) &&
           unit_holds(fixed->weight_exponent, UNIT_EXPONENT_LEAST, UNIT_WEIGHT_EXPONENT_MOST);
}

static inline bool is_within_units(const brace_loaded_fixed_t *fixed)
{
    return unit_are_exponents(fixed) && unit_are_weights(fixed) && unit_is_link(&fixed->femur) &&
           unit_is_link(&fixed->tibia) &&
           (int64_t)fixed->femur.length_q28 + fixed->tibia.length_q28 <= UNIT_REACH_MOST_Q28 && fixed->base_q31 >= 0 &&
           fixed->base_rotation_q31 >= 0 && unit_are_roots(fixed->base_root_q31);
}

#endif
