#include "brace/planar_batch.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "chain/chain_list.h"
#include "fixed/fixed_det.h"

#define PI 3.14159265358979324

/* The leading digits, as many as a float holds. By bits: GCC 12 takes x - (double)(float)x for zero when it
 * makes vectors of two of them. */
static double float_part(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= ~(uint64_t)0x1fffffff;
    memcpy(&value, &bits, sizeof bits);
    return value;
}

/* constant + per_cos cos theta2 + per_sin sin theta2, but for the sign written as
 * least + swing sin(h - zero 0) sin(h - zero 1) with h = theta2/2. As middle + amplitude cos(theta2 - crest)
 * it vanishes where theta2 - crest is plus and minus acos(-middle/amplitude); where it never does, both zeros
 * are where it comes nearest, and their sines' product has one sign. */
static void factor(const brace_det_harmonic_t *cross, brace_planar_batch_t *batch)
{
    const double middle = fabs(cross->constant), amplitude = hypot(cross->per_cos, cross->per_sin);
    const double crest = cross->constant < 0.0 ? atan2(-cross->per_sin, -cross->per_cos)
                                               : atan2(cross->per_sin, cross->per_cos);
    const double aside = middle < amplitude ? acos(-middle / amplitude) : PI;
    const double zero[2] = {0.5 * (crest + aside),
                            middle < amplitude ? 0.5 * (crest - aside) : 0.5 * (crest + aside)};
    batch->cross_least = middle < amplitude ? 0.0f : (float)(middle - amplitude);
    batch->cross_swing = (float)(2.0 * amplitude);
    for (int i = 0; i < 2; i++) {
        const double within = zero[i] - PI * floor(zero[i] / PI + 0.5);
        const double first = float_part(within);
        batch->zero_rad[i] = (float)first;
        batch->zero_rest_rad[i] = (float)(within - first);
    }
    batch->upright = middle == 0.0 && cross->per_cos == 0.0;
    if (batch->upright) {
        batch->cross_swing = (float)(2.0 * cross->per_sin);
    }
}

/* For the loop's half of 1 + cos and of sin. */
static brace_harmonic_t doubled(const brace_harmonic_t *h)
{
    return (brace_harmonic_t){h->at_fold, 2.0f * h->per_cos, 2.0f * h->per_sin};
}

brace_status_t brace_planar_batch_collapse(const brace_limb_t *limb, brace_planar_batch_t *batch)
{
    brace_status_t status = batch == NULL ? BRACE_E_NULL : brace_limb_check(limb);
    if (status != BRACE_OK) {
        return status;
    }
    if (limb->base.x_mm_per_n != limb->base.z_mm_per_n) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_swing_t element[BRACE_CHAIN_FIRM];
    const float iso = brace_chain_at_rest(limb, element) + limb->base.x_mm_per_n;
    const brace_det_t det = brace_det_of(iso, element, BRACE_CHAIN_FIRM);
    brace_harmonics_t plane;
    brace_harmonics_sum(element, &plane);
    plane.mean.at_fold += iso;
    const double mean_most = (double)plane.mean.at_fold + (double)plane.mean.per_cos +
                             hypot(plane.mean.per_cos, plane.mean.per_sin);
    uint32_t flags;
    status = brace_det_judge(&det, mean_most, &flags);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_det_harmonic_t *rest = &det.rest;
    batch->mean = doubled(&plane.mean);
    batch->dev_x = doubled(&plane.dev_x);
    batch->dev_y = doubled(&plane.dev_y);
    batch->rest = (brace_harmonic_t){(float)(rest->constant - rest->per_cos), 2.0f * (float)rest->per_cos,
                                     2.0f * (float)rest->per_sin};
    batch->flags = flags;
    factor(&det.cross, batch);
    return BRACE_OK;
}
