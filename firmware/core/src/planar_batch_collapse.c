#include "brace/planar_batch.h"

#include <math.h>
#include <stddef.h>

/* at_fold + per_cos (1 + cos theta2) + per_sin sin theta2, written as least + swing sin(h - zero 0) sin(h - zero 1)
 * with h = theta2/2. As middle + amplitude cos(theta2 - crest) it vanishes where theta2 - crest is plus and minus
 * acos(-middle/amplitude); where it never does, both zeros move to where it comes nearest. */
static void factor(const brace_harmonic_t *cross, brace_planar_batch_t *batch)
{
    const double middle = (double)cross->at_fold + (double)cross->per_cos;
    const double amplitude = hypot(cross->per_cos, cross->per_sin);
    const double crest = atan2(cross->per_sin, cross->per_cos);
    const double level = amplitude > 0.0 ? fmax(-1.0, fmin(1.0, -middle / amplitude)) : 1.0;
    const double aside = acos(level);
    const double zero[2] = {0.5 * (crest + aside), 0.5 * (crest - aside)};
    batch->cross_least = (float)(middle + amplitude * level);
    batch->cross_swing = (float)(-2.0 * amplitude);
    for (int i = 0; i < 2; i++) {
        const double within = remainder(zero[i], 3.14159265358979324);
        batch->zero_rad[i] = (float)within;
        batch->zero_rest_rad[i] = (float)(within - (double)batch->zero_rad[i]);
    }
    batch->upright = cross->at_fold == 0.0f && cross->per_cos == 0.0f;
    if (batch->upright) {
        batch->cross_least = 0.0f;
        batch->cross_swing = 2.0f * cross->per_sin;
    }
}

/* For the loop's half of 1 + cos and of sin. */
static brace_harmonic_t doubled(const brace_harmonic_t *h)
{
    return (brace_harmonic_t){h->at_fold, 2.0f * h->per_cos, 2.0f * h->per_sin};
}

brace_status_t brace_planar_batch_collapse(const brace_limb_t *limb, brace_planar_batch_t *batch)
{
    if (batch == NULL) {
        return BRACE_E_NULL;
    }
    brace_chain_t chain;
    brace_harmonics_t harmonics;
    brace_status_t status = brace_chain_build(limb, &chain);
    if (status == BRACE_OK) {
        status = brace_harmonics(&chain, &harmonics);
    }
    if (status == BRACE_OK) {
        batch->mean = doubled(&harmonics.mean);
        batch->dev_x = doubled(&harmonics.dev_x);
        batch->dev_y = doubled(&harmonics.dev_y);
        batch->rest = doubled(&harmonics.rest);
        batch->flags = 0;
        factor(&harmonics.cross, batch);
    }
    return status;
}
