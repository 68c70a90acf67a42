#include "brace/planar_fixed.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "chain/elements.h"
#include "chain/harmonics.h"
#include "fixed/fixed_det.h"
#include "fixed/fixed_kept.h"
#include "fixed/fixed_table.h"

/* Where the least mean over the largest is below this, the words that hold the mean are too short for the accuracy. */
#define UNEVEN 3e-4
#define SMALLEST_MM_PER_N 1e-7
#define LARGEST_MM_PER_N 1e7

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

/* Anchored at the folded knee, where the levers nearly cancel, so that they cancel exactly in the integers too. */
static brace_fixed_harmonic_t quantised(const brace_det_harmonic_t *h, int32_t scale)
{
    const double unit = (double)two_to(scale), per_turn = unit * (0x1p32 / BRACE_FIXED_ONE);
    const int32_t per_cos = (int32_t)(h->per_cos * per_turn), per_sin = (int32_t)(h->per_sin * per_turn);
    const int64_t at_fold = (int64_t)((h->constant - h->per_cos) * unit * 0x1p32);
    return (brace_fixed_harmonic_t){
        .constant_q32 = at_fold + (int64_t)per_cos * BRACE_FIXED_ONE + (int64_t)0x80000000,
        .per_cos = per_cos,
        .per_sin = per_sin,
    };
}

static brace_det_harmonic_t fine(const brace_harmonic_t *h, double factor)
{
    const double per_cos = 0.5 * (double)h->per_cos2, per_sin = 0.5 * (double)h->per_sincos;
    return (brace_det_harmonic_t){factor * ((double)h->at_fold + per_cos), factor * per_cos, factor * per_sin};
}

static brace_fixed_harmonic_t quantised_float(const brace_harmonic_t *h, double factor, int32_t scale)
{
    const brace_det_harmonic_t at = fine(h, factor);
    return quantised(&at, scale);
}

static brace_det_extent_t extent_of(const brace_harmonic_t *h)
{
    const brace_det_harmonic_t at = fine(h, 1.0);
    return brace_det_extent(&at);
}

static int32_t least_of(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* A little more than the value, so that rounding carries nothing over a power of two. */
static float padded(double value)
{
    return (float)value * 1.0005f;
}

/* --- the last look at what has been made ---------------------------------------------------------------------- */

/* A function of the knee angle. */
typedef struct {
    double constant, cos, sin, cos_2, sin_2;
} waves_t;

static brace_det_harmonic_t of_words(const brace_fixed_harmonic_t *h)
{
    const double per_turn = (double)BRACE_FIXED_ONE / 0x1p32;
    return (brace_det_harmonic_t){(double)h->constant_q32 / 0x1p32, (double)h->per_cos * per_turn,
                                  (double)h->per_sin * per_turn};
}

static void add_square(waves_t *sum, double factor, const brace_fixed_harmonic_t *words)
{
    const brace_det_harmonic_t h = of_words(words);
    sum->constant += factor * (h.constant * h.constant + 0.5 * (h.per_cos * h.per_cos + h.per_sin * h.per_sin));
    sum->cos += factor * 2.0 * h.constant * h.per_cos;
    sum->sin += factor * 2.0 * h.constant * h.per_sin;
    sum->cos_2 += factor * 0.5 * (h.per_cos * h.per_cos - h.per_sin * h.per_sin);
    sum->sin_2 += factor * h.per_cos * h.per_sin;
}

static double swing_of(double cos, double sin)
{
    const brace_det_harmonic_t wave = {0.0, cos, sin};
    return brace_det_extent(&wave).swing;
}

/* Is half the trace longer than the deviator by 4 units at every knee angle, so that K is positive? The squares
 * of the two differ by det C, which is at least `rest`. What rounding to words adds to that counts, too.
 * det_unit: of cross^2, in the unit of the mean's square. The trace is below 2^31: 4 units are 4 2^31 of the squares;
 * that doubled, because sine and cosine are a unit vector within 2e-9 only. */
static bool is_definite(const brace_planar_fixed_t *fixed, double det_unit)
{
    const brace_det_harmonic_t rest = of_words(&fixed->rest);
    const double rest_unit = det_unit * (double)fixed->rest_weight;
    waves_t off = {-rest_unit * rest.constant, -rest_unit * rest.per_cos, -rest_unit * rest.per_sin, 0.0, 0.0};
    const brace_fixed_harmonic_t *const squared[4] = {&fixed->mean, &fixed->minus_dev_x, &fixed->dev_z, &fixed->cross};
    const double factor[4] = {0.25, -1.0, -1.0, -det_unit};
    for (int i = 0; i < 4; i++) {
        add_square(&off, factor[i], squared[i]);
    }
    const double most_off = fabs(off.constant) + swing_of(off.cos, off.sin) + swing_of(off.cos_2, off.sin_2);
    return rest_unit * brace_det_extent(&rest).least - most_off > 8.0 * 0x1p31;
}

static brace_status_t quantise(const brace_harmonics_t *plane, const brace_det_t *det, brace_planar_fixed_t *fixed)
{
    const brace_det_extent_t mean = extent_of(&plane->mean);
    const brace_det_extent_t rest = brace_det_extent(&det->rest), cross = brace_det_extent(&det->cross);
    uint32_t flags;
    if (!(mean.most > SMALLEST_MM_PER_N && mean.most < LARGEST_MM_PER_N) ||
        brace_det_judge(det, mean.most, &flags) != BRACE_OK) {
        return BRACE_E_UNSUPPORTED;
    }
    const int32_t mean_scale = headroom(padded(mean.most), 30); /* so that the trace of C stays below 2^31 */
    const int32_t rest_scale = headroom(padded(rest.most), 31);
    const double cross_most = cross.most > -cross.least ? cross.most : -cross.least;
    int32_t cross_scale = (rest_scale + 30) >> 1; /* so that cross^2 in rest's unit stays below 2^61 */
    if (cross_most > 0.0) {
        cross_scale = least_of(cross_scale, headroom(padded(cross_most), 31));
        cross_scale = least_of(cross_scale, headroom(padded(cross.swing), 30));
    }
    const int32_t weight = 2 * cross_scale - rest_scale;
    if (weight < 0) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_planar_fixed_t made = {.mean = quantised_float(&plane->mean, 1.0, mean_scale + 1),
                                       .minus_dev_x = quantised_float(&plane->dev_x, -1.0, mean_scale),
                                       .dev_z = quantised_float(&plane->dev_z, 1.0, mean_scale),
                                       .cross = quantised(&det->cross, cross_scale),
                                       .rest = quantised(&det->rest, rest_scale),
                                       .rest_weight = (int32_t)1 << weight,
                                       .exponent_k = (uint32_t)(99 + 2 * cross_scale - mean_scale) << 23,
                                       .exponent_min = (uint32_t)(98 + mean_scale) << 23,
                                       .flags = mean.least < UNEVEN * mean.most ? BRACE_FLAG_NEAR_SINGULAR : flags};
    if (!is_kept(&made) || !is_definite(&made, (double)two_to(2 * (mean_scale - cross_scale)))) {
        return BRACE_E_UNSUPPORTED;
    }
    *fixed = made;
    return BRACE_OK;
}

brace_status_t brace_planar_fixed_collapse(const brace_limb_t *limb, brace_planar_fixed_t *fixed)
{
    const brace_status_t status = fixed == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    if (limb->base.x_mm_per_n != limb->base.z_mm_per_n) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_harmonics_t plane;
    brace_det_t det;
    {
        brace_element_t element[BRACE_ELEMENT_COUNT];
        const float iso = brace_elements_of_limb(limb, element) + limb->base.x_mm_per_n;
        det = brace_det_of(iso, element);
        brace_harmonics_of(element, &plane);
        plane.mean.at_fold += iso;
    }
    return quantise(&plane, &det, fixed);
}
