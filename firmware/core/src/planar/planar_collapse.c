#include <stddef.h>

#include "brace/planar.h"
#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "planar/planar_tables.h"
#include "base/turn.h"
#include "base/vec.h"

/* det C = per_mean mean + constant + cross^2, but for a first harmonic of the amplitude leftover. */
typedef struct {
    float per_mean, constant, leftover;
} rest_t;

/* What a number is uncertain by, and [rad] a direction in the plane of (1 + cos, sin). */
#define ROUNDING 6e-8f

/* Brings det C into this form: 2 iso mean - iso^2 and what the elements bring themselves. Of that first harmonic,
 * what stands across `cross` in the plane of (1 + cos, sin) is taken up by more of the mean, and what lies along it by
 * shifting cross. Where cross and mean point the same way within rounding, the mean takes up nothing: that is left over.
 * grain: what the mean is uncertain by at its most. */
static inline rest_t affine_rest(brace_harmonics_t *h, float grain)
{
    const float iso = h->iso_mm_per_n;
    const brace_vec_t mean = {h->mean.per_cos, h->mean.per_sin};
    const brace_vec_t cross = {h->cross.per_cos, h->cross.per_sin};
    const brace_vec_t beyond = {h->rest.per_cos, h->rest.per_sin};
    const float square = vec_dot(cross, cross), length = __builtin_sqrtf(square); /* never nothing */
    const float apart = vec_cross(cross, mean) / length, noise = grain * grain;
    const float across = vec_cross(cross, beyond) / length / __builtin_fmaf(apart, apart, noise);
    const float more = across * apart;
    const float shift = 0.5f * (vec_dot(cross, beyond) - more * vec_dot(cross, mean)) / square;
    const float constant = h->rest.at_fold - iso * iso - more * h->mean.at_fold -
                           shift * (2.0f * h->cross.at_fold + shift);
    h->cross.at_fold += shift;
    return (rest_t){2.0f * iso + more, constant, across * noise};
}

/* Is the accuracy of the tick safe? Where rest could lose digits against its parts, at the mean's least or most, it must
 * not be less than a sixteenth of them; and where det is least, at the zeros of cross, an error of cross, from rounded
 * constants and from the last place of the tick, must stay below 2e-6 of the square root of the rest: both together, as
 * squares. And the mean's own rounding, 3e-8 of the most, must stay below 1.2e-6 of the least. */
static inline int accurate(const brace_harmonics_t *h, rest_t rest, float middle, float swing, float unit)
{
    const float smaller = rest.constant + rest.per_mean * middle - __builtin_fabsf(rest.per_mean) * swing;
    const float error =
        unit + ROUNDING * (__builtin_fabsf(h->cross.per_cos) + __builtin_fabsf(h->cross.at_fold));
    return __builtin_fabsf(rest.constant) + __builtin_fabsf(rest.leftover) / ROUNDING + error * error * 4e12f <
               16.0f * smaller &&
           middle + swing < 40.0f * (middle - swing);
}

/* The factors are those of minus cosine and minus sine, q30, of whose products the high words are a quarter. At the fold
 * minus the cosine is one: there the rounding of its factor goes into the constant. */
static inline void fix(const brace_harmonic_t *h, float units, brace_planar_harmonic_t *fixed)
{
    const float per_word = -4.0f * units;
    fixed->per_cos = (int32_t)(h->per_cos * per_word);
    fixed->per_sin = (int32_t)(h->per_sin * per_word);
    fixed->constant = (int32_t)(h->at_fold * units) - (fixed->per_cos >> 2);
}

/* The tick's constants from the harmonics of the elements, with iso beside them; h is used up.
 * planar: written on success only. */
static inline brace_status_t give_constants(brace_harmonics_t *h, brace_planar_t *planar)
{
    const brace_harmonic_t *from = &h->mean;     /* then dev_x, dev_y, cross: */
    brace_planar_harmonic_t *to = &planar->mean; /* the same order in both */

    h->mean.at_fold += h->iso_mm_per_n;
    const float per_cos = h->mean.per_cos, per_sin = h->mean.per_sin;
    const float middle = h->mean.at_fold + per_cos, swing = __builtin_sqrtf(per_cos * per_cos + per_sin * per_sin);
    const float grain = ROUNDING * (middle + swing);
    if (!(middle - swing > -16.0f * grain)) {
        return BRACE_E_PARAMETER;
    }
    const rest_t rest = affine_rest(h, grain);
    /* The middle of the mean is 2^27 units. No more than that swings any of the four: none is ever above the mean, and
     * two means half a turn apart are twice the middle. */
    const float unit = middle * (1.001f / 0x1p27f), units = 1.0f / unit;
    if (!accurate(h, rest, middle, swing, unit)) {
        return BRACE_E_UNSUPPORTED;
    }
    float by = units;
    for (int i = 0; i < 4; i++) {
        fix(&from[i], by, &to[i]);
        by = 4.0f * units; /* what the deviator's turn into the world's frame takes, and a finer cross */
    }
    planar->sine = brace_sine_table;
    planar->cosine = brace_sine_table + BRACE_SINE_QUARTER;
    planar->axis = brace_axis_table + BRACE_AXIS_ROWS / 2 - 1;
    planar->rest_per_mean = rest.per_mean * units;
    planar->rest = rest.constant * units * units;
    planar->per_unit_n_per_mm = units;
    planar->slope_per_unit = BRACE_AXIS_ONE * unit;
    return BRACE_OK;
}

BRACE_OFF_TICK brace_status_t brace_planar_collapse(const brace_limb_t *limb, brace_planar_t *planar)
{
    if (limb == NULL || planar == NULL) {
        return BRACE_E_NULL;
    }
    const float base = limb->base.x_mm_per_n;
    if (base != limb->base.z_mm_per_n) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_harmonics_t h;
    brace_swing_t element[BRACE_CHAIN_FIRM];
    h.iso_mm_per_n = brace_chain_at_rest(limb, element) + base;
    brace_harmonics_sum(element, &h);
    return give_constants(&h, planar);
}
