#include "brace/planar_fixed.h"

#include <stddef.h>
#include <string.h>

#include "brace/chain.h"
#include "turn.h"

/* BRACE_TURN_ONE as an integer: the tick's sine and cosine of one. */
#define TRIG_ONE 2147481600

/* det C at its least over the largest mean^2: below SLENDER the stated accuracy is no longer promised, below
 * TOO_SLENDER the words of the tick no longer hold the numbers. */
#define SLENDER 2e-6f
#define TOO_SLENDER 2.5e-7f
/* The same for the least mean over the largest. */
#define UNEVEN 1e-3f
#define SMALLEST_MM_PER_N 1e-7f
#define LARGEST_MM_PER_N 1e7f

typedef struct {
    float least, most, swing;
} extent_t;

/* Over all knee angles. */
static extent_t extent(const brace_harmonic_t *h)
{
    const float swing = __builtin_sqrtf(h->per_cos * h->per_cos + h->per_sin * h->per_sin);
    const float middle = h->at_fold + h->per_cos;
    const float below = h->per_cos > 0.0f ? h->per_sin * h->per_sin / (swing + h->per_cos) : swing - h->per_cos;
    return (extent_t){h->at_fold - below, middle + swing, swing};
}

/* Largest e with value * 2^e < 2^bits. value > 0. */
static int32_t headroom(float value, int32_t bits)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return bits - ((int32_t)(word >> 23) - 126);
}

static float two_to(int32_t exponent)
{
    const uint32_t word = (uint32_t)(exponent + 127) << 23;
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

/* at_fold is kept apart from per_cos until both are integers: what cancels there cancels exactly. */
static brace_fixed_harmonic_t quantised(const brace_harmonic_t *h, float scale)
{
    const float per_turn = scale * (0x1p32f / BRACE_TURN_ONE);
    const int32_t per_cos = (int32_t)(h->per_cos * per_turn), per_sin = (int32_t)(h->per_sin * per_turn);
    const int64_t at_fold = (int64_t)(h->at_fold * scale * 0x1p32f);
    return (brace_fixed_harmonic_t){
        .constant = at_fold + (int64_t)per_cos * TRIG_ONE + (int64_t)0x80000000,
        .per_turn = (uint32_t)per_cos | (uint64_t)(uint32_t)per_sin << 32,
    };
}

static int32_t least_of(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* A little less than a power of two, so that rounding carries nothing over it. */
static float padded(float value)
{
    return value * 1.0005f;
}

static brace_status_t quantise(const brace_harmonics_t *harmonics, brace_planar_fixed_t *fixed)
{
    const extent_t mean = extent(&harmonics->mean), rest = extent(&harmonics->rest);
    const float square = mean.most * mean.most;
    if (!(mean.most > SMALLEST_MM_PER_N && mean.most < LARGEST_MM_PER_N && rest.least > TOO_SLENDER * square)) {
        return BRACE_E_UNSUPPORTED;
    }
    const extent_t cross = extent(&harmonics->cross);
    const float cross_most = __builtin_fabsf(harmonics->cross.at_fold + harmonics->cross.per_cos) + cross.swing;

    const int32_t mean_scale = headroom(padded(mean.most), 30); /* trace of C below 2^31 */
    const int32_t rest_scale = headroom(padded(rest.most), 31);
    int32_t cross_scale = (rest_scale + 30) >> 1; /* its square, by rest_weight, below 2^61 */
    if (cross_most > 0.0f) {
        cross_scale = least_of(cross_scale, headroom(padded(cross_most), 31));
        cross_scale = least_of(cross_scale, headroom(padded(cross.swing), 30));
    }
    const int32_t weight = 2 * cross_scale - rest_scale;
    if (weight < 0) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_harmonic_t *dev_x = &harmonics->dev_x;
    const brace_harmonic_t minus_dev_x = {-dev_x->at_fold, -dev_x->per_cos, -dev_x->per_sin};
    fixed->mean = quantised(&harmonics->mean, two_to(mean_scale + 1));
    fixed->minus_dev_x = quantised(&minus_dev_x, two_to(mean_scale));
    fixed->dev_y = quantised(&harmonics->dev_y, two_to(mean_scale));
    fixed->cross = quantised(&harmonics->cross, two_to(cross_scale));
    fixed->rest = quantised(&harmonics->rest, two_to(rest_scale));
    fixed->rest_weight = (int32_t)1 << weight;
    fixed->exponent_k = (uint32_t)(99 + 2 * cross_scale - mean_scale) << 23;
    fixed->exponent_min = (uint32_t)(98 + mean_scale) << 23;
    const int delicate = rest.least < SLENDER * square || mean.least < UNEVEN * mean.most;
    fixed->flags = delicate ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}

brace_status_t brace_planar_fixed_collapse(const brace_limb_t *limb, brace_planar_fixed_t *fixed)
{
    if (fixed == NULL) {
        return BRACE_E_NULL;
    }
    brace_chain_t chain;
    brace_harmonics_t harmonics;
    brace_status_t status = brace_chain_build(limb, &chain);
    if (status == BRACE_OK) {
        status = brace_harmonics(&chain, &harmonics);
    }
    return status == BRACE_OK ? quantise(&harmonics, fixed) : status;
}
