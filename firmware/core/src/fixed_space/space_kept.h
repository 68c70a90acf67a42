/* What a collapsed limb keeps so that no number of K under a load in space leaves its word. The collapse looks for it
 * last, in integers; the proof stands on it (tests/proofs/harness/loaded_space.cpp). */
#ifndef BRACE_CORE_FIXED_SPACE_SPACE_KEPT_H
#define BRACE_CORE_FIXED_SPACE_SPACE_KEPT_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/loaded_space_fixed_types.h"
#include "loaded/fixed_units.h"

/* The unit of length is above the links' lengths; beside it what three floats' sum and their rounding may add. */
#define LENGTHS_MOST_Q28 ((1 << 28) + 32)
/* A unit vector of floats, rounded. */
#define ALONG_MOST_Q30 ((1 << 30) + 256)
/* Of a length, for a link tilted by a quarter turn: the root of a half; an eighth of the root of 2 and a 24th. */
#define TILT_MOST_Q30 759356000
#define BOW_MOST_Q30 234612000
/* The collapse leaves a fifth of the word; a spread is a twelfth of the bending that it is of, at most. */
#define TWIST_MOST_Q31 1718202000
#define SPREAD_MOST_Q31 179100000
/* A share of a half, short of one unit; 0.6 of a curl that is at most 1. */
#define SHARE_MOST_Q30 ((1 << 29) - 1)
#define SHORTENS_MOST_Q30 644245100
#define ARM_SHIFT_MOST 20u
/* Weights add up but for their rounding. */
#define WEIGHTS_APART_Q31 512

static inline bool is_from_0(int32_t number, int32_t most)
{
    return number >= 0 && number <= most;
}

/* Is a vector at most so long? Its parts' squares may be beyond 63 bits, so that unsigned words add them. */
static inline bool is_no_longer(brace_fixed_vec_t v, int64_t most)
{
    const uint64_t square = (uint64_t)((int64_t)v.x * v.x) + (uint64_t)((int64_t)v.z * v.z);
    return square <= (uint64_t)(most * most);
}

/* part_q30 of the length, and two units for the rounding. */
static inline int64_t part_of_length(const brace_space_fixed_link_t *link, int64_t part_q30)
{
    return (link->length_q28 * part_q30) / (1 << 30) + 2;
}

static inline bool is_link_kept(const brace_space_fixed_link_t *link)
{
    return is_from_0(link->length_q28, LENGTHS_MOST_Q28) && is_from_0(link->twelfth_q28, link->length_q28 / 12 + 2) &&
           is_no_longer(link->along_q30, ALONG_MOST_Q30) &&
           is_no_longer(link->tilt_q28, part_of_length(link, TILT_MOST_Q30)) &&
           is_no_longer(link->bow_q28, part_of_length(link, BOW_MOST_Q30)) &&
           is_from_0(link->twist_q31, TWIST_MOST_Q31) && link->sideways_q31 >= 0 && link->bend_q31 >= 0 &&
           link->across_arm_q31 >= 0 && link->sideways_arm_q31 >= 0 &&
           is_from_0(link->across_spread_q31, SPREAD_MOST_Q31) &&
           is_from_0(link->sideways_spread_q31, SPREAD_MOST_Q31) && link->stretch_q31 >= 0 &&
           is_from_0(link->end_share_q30, SHARE_MOST_Q30) && link->stretch_end_share_q30 >= -(1 << 29) &&
           link->stretch_end_share_q30 <= 1 << 29 && is_from_0(link->own_share_q30, 1 << 29) &&
           is_from_0(link->curl_q30, 1 << 30) && is_from_0(link->shortens_q30, SHORTENS_MOST_Q30) &&
           link->weight_q31 >= 0 && link->arm_shift <= ARM_SHIFT_MOST;
}

/* Do weight_q8 and the weights' words tell the same? weight_q8 decides on the unit of force and counts 384 a newton.
 * The weight is at least half of its power of two, so weight_q8 is at least 192 times that power. But for the rounding
 * of floats, weight_q8 is no less than what the words add up to. */
static inline bool is_weight_kept(const brace_loaded_space_fixed_t *fixed)
{
    const uint32_t weight_q8 = fixed->weight_q8, most_q8 = weight_q8 + (weight_q8 >> 20);
    if (weight_q8 > 1u << 31 || fixed->weight_exponent > 24 - (int32_t)leading_zeros(weight_q8 + 2u)) {
        return false;
    }
    const int32_t right = 31 - fixed->weight_exponent; /* not negative */
    return fixed->beyond_coxa_q31 >= 0 &&
           (right > 63 || ((uint64_t)(uint32_t)fixed->beyond_coxa_q31 * 384u) >> right <= most_q8);
}

/* The unit of length is bounded, so that a float holds K and the tip's displacement. */
static inline bool is_space_kept(const brace_loaded_space_fixed_t *fixed)
{
    const int64_t lengths = (int64_t)fixed->coxa.length_q28 + fixed->femur.length_q28 + fixed->tibia.length_q28;
    const int64_t weights = (int64_t)fixed->beyond_femur_q31 + fixed->femur.weight_q31;
    return unit_holds(fixed->length_exponent, UNIT_LENGTH_EXPONENT_LEAST, UNIT_LENGTH_EXPONENT_MOST) &&
           is_link_kept(&fixed->coxa) && is_link_kept(&fixed->femur) && is_link_kept(&fixed->tibia) &&
           lengths <= LENGTHS_MOST_Q28 && fixed->beyond_femur_q31 >= 0 &&
           weights <= (int64_t)fixed->beyond_coxa_q31 + WEIGHTS_APART_Q31 &&
           fixed->tibia.weight_q31 <= (int64_t)fixed->beyond_femur_q31 + WEIGHTS_APART_Q31 && fixed->base_x_q31 >= 0 &&
           fixed->base_z_q31 >= 0 && fixed->base_rotation_q31 >= 0 && is_weight_kept(fixed);
}

#endif
