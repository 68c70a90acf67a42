/* What a structure keeps so that no sum of planar_fixed.c leaves its word at any knee angle. The collapse looks for
 * it last, in integers; the proof of planar_fixed.c stands on it (tests/judges/proofs/harness/fixed_planar.c). */
#ifndef BRACE_FIXED_KEPT_H
#define BRACE_FIXED_KEPT_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/planar_fixed.h"

/* Least and largest value of each harmonic, in its own unit. */
#define TRACE_LEAST (1 << 12)
#define TRACE_MOST INT32_MAX
#define DEVIATOR_MOST ((1 << 30) - 1)
#define CROSS_MOST INT32_MAX
#define REST_MOST INT32_MAX
#define WEIGHT_LEAST 8
#define WEIGHT_MOST (1 << 30)

/* Exponent fields, so that no float built from them is infinite or denormal. */
#define EXPONENT_LEAST (90u << 23)
#define EXPONENT_MOST (200u << 23)

/* The least rest of det C whose product with its weight is above 2^33. */
static inline int32_t rest_least(const brace_planar_fixed_t *fixed)
{
    return (int32_t)((1LL << 33) / fixed->rest_weight) + 1;
}

/* The largest amplitude, in the unit of per_cos and per_sin, with which the harmonic stays from least to most. */
static inline int64_t room_of(const brace_fixed_harmonic_t *h, int32_t least, int32_t most)
{
    const int64_t half_q31 = h->constant_q32 / 2;
    const int64_t below_q31 = half_q31 - (int64_t)least * (1LL << 31);
    const int64_t above_q31 = (int64_t)most * (1LL << 31) - half_q31;
    return (below_q31 < above_q31 ? below_q31 : above_q31) / (1LL << 30) - 1;
}

static inline bool stays_within(const brace_fixed_harmonic_t *h, int32_t least, int32_t most)
{
    const int64_t room = room_of(h, least, most);
    const uint64_t square = (uint64_t)((int64_t)h->per_cos * h->per_cos) + (uint64_t)((int64_t)h->per_sin * h->per_sin);
    return room >= 0 && square <= (uint64_t)room * (uint64_t)room;
}

static inline bool is_exponent(uint32_t field)
{
    return field >= EXPONENT_LEAST && field <= EXPONENT_MOST;
}

static inline bool is_weight(int32_t weight)
{
    return weight >= WEIGHT_LEAST && weight <= WEIGHT_MOST && ((uint32_t)weight & ((uint32_t)weight - 1u)) == 0u;
}

static inline bool is_kept(const brace_planar_fixed_t *fixed)
{
    if (!is_weight(fixed->rest_weight) || !is_exponent(fixed->exponent_k) || !is_exponent(fixed->exponent_min)) {
        return false;
    }
    const struct {
        const brace_fixed_harmonic_t *harmonic;
        int32_t least, most;
    } range[5] = {{&fixed->mean, TRACE_LEAST, TRACE_MOST},
                  {&fixed->minus_dev_x, -DEVIATOR_MOST, DEVIATOR_MOST},
                  {&fixed->dev_z, -DEVIATOR_MOST, DEVIATOR_MOST},
                  {&fixed->cross, -CROSS_MOST, CROSS_MOST},
                  {&fixed->rest, rest_least(fixed), REST_MOST}};
    bool stay = true;
    for (int i = 0; i < 5; i++) {
        stay = stay && stays_within(range[i].harmonic, range[i].least, range[i].most);
    }
    return stay;
}

#endif
