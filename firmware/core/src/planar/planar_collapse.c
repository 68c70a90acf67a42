#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/vec.h"
#include "brace/planar.h"
#include "chain/elements.h"
#include "chain/harmonics.h"

/* Rounding error of a float, relative to itself; and of the direction of a vector of floats [rad]. */
#define ROUNDING 6e-8f

/* A cross that vanishes at the straight or at the folded knee would divide by zero; a share below this counts as
 * zero. */
#define NEARLY_NOTHING_RATIO 1e-12f

/* det C - cross^2 = per_mean mean + constant, except for a harmonic of the amplitude left_over. */
typedef struct {
    float per_mean, constant, left_over;
} rest_t;

/* Writes the rest as a multiple of the mean and a constant: one multiplication in the tick instead of a third
 * harmonic.
 *
 * Together with iso, the compliance that is equal in every direction, the rest is a harmonic: 2 iso mean - iso^2 + that
 * of the elements. The elements' harmonic is split in the plane of (cos^2 h, sin h cos h). Its part across `cross` is a
 * multiple of the mean. Its part along `cross` disappears when cross is shifted by a constant, because cross^2 =
 * (cross + shift)^2 - 2 shift cross - shift^2. Where cross and mean have the same direction to within rounding, no
 * multiple of the mean has a part across, and that part is left over. mean_off: the error of the mean. */
static rest_t rest_of(brace_harmonics_t *harmonics, float iso_mm_per_n, float mean_off)
{
    const brace_vec_t mean = {harmonics->mean.per_cos2, harmonics->mean.per_sincos};
    const brace_vec_t cross = {harmonics->cross.per_cos2, harmonics->cross.per_sincos};
    const brace_vec_t rest = {harmonics->rest.per_cos2, harmonics->rest.per_sincos};
    const float square = vec_dot(cross, cross), length = sqrtf(square); /* never zero (harmonics.c) */
    const float apart = vec_cross(cross, mean) / length, noise = 4.0f * mean_off * mean_off;
    const float across = vec_cross(cross, rest) / length / brace_fma(apart, apart, noise);
    const float more = across * apart;
    const float shift = 0.5f * (vec_dot(cross, rest) - more * vec_dot(cross, mean)) / square;
    const float constant = harmonics->rest.at_fold - iso_mm_per_n * iso_mm_per_n - more * harmonics->mean.at_fold -
                           shift * (2.0f * harmonics->cross.at_fold + shift);
    harmonics->cross.at_fold += shift;
    return (rest_t){2.0f * iso_mm_per_n + more, constant, 0.5f * across * noise};
}

/* Writes cross as least + factor (sin h - tan cos h) (cos h - cot sin h). The tick then computes cross from its zeros,
 * and not from terms that cancel there. Let A be its value at the straight knee and D at the folded one, with B sin h
 * cos h between them: cross = A cos^2 h + B sin h cos h + D sin^2 h. With q = -(B + sqrt(B^2 - 4 A D) sign B)/2 that is
 * -q (sin h - A/q cos h) (cos h - D/q sin h). Where cross has no zero, its least value `least` is subtracted from A and
 * from D, and the root becomes zero. Where q is negligible beside A or D, cross is A cos^2 h or D sin^2 h. The smaller
 * of the two is then a residue of rounding and is dropped; otherwise it would become as large as the other. Where
 * the rounding of `least` leaves a negative number under the root, the smaller of A and D takes the value that makes it
 * zero. That moves cross by rounding alone; else B would be wrong by half the share by which the number is negative. */
static void factor_cross(const brace_harmonic_t *cross, brace_planar_t *planar)
{
    const float straight = cross->at_fold + cross->per_cos2, folded = cross->at_fold;
    const float middle = brace_harmonic_middle(cross), swing = brace_harmonic_swing(cross);
    const float above = fabsf(middle) - swing;
    const float least = above > 0.0f ? copysignf(above, middle) : 0.0f;
    const float b = cross->per_sincos;
    float a = straight - least, d = folded - least;
    const float discriminant = brace_fma(b, b, -4.0f * a * d);
    const float root = sqrtf(discriminant > 0.0f ? discriminant : 0.0f);
    const float q = -0.5f * (b + copysignf(root, b));
    const float larger = fmaxf(fabsf(a), fabsf(d));
    if (discriminant < 0.0f) {
        const float product = 0.25f * b * b;
        if (fabsf(a) < larger) {
            a = product / d;
        } else {
            d = product / a;
        }
    }
    float divisor = q;
    if (!(fabsf(q) > ROUNDING * larger)) {
        divisor = NEARLY_NOTHING_RATIO * larger + FLT_MIN;
        a = fabsf(a) < larger ? 0.0f : a;
        d = fabsf(d) < larger ? 0.0f : d;
    }
    planar->cross_least = least;
    planar->cross_factor = -divisor;
    planar->zero_tan = a / divisor;
    planar->zero_cot = d / divisor;
}

/* Does the tick keep its accuracy at every posture?
 * First: terms of the rest cancel. Where the rest is least, it must be at least a sixteenth of these terms.
 * Second: where cross is as large as the root of the rest, an error of cross changes det C by that error over the root.
 * This must stay below 2e-6. The error comes from the two factors; a factor whose zero is at the straight or folded
 * knee has none.
 * Third: the mean's own rounding, 3e-8 of its largest value, must stay below 1.2e-6 of its least value. */
static bool is_accurate(const brace_planar_t *planar, const rest_t *rest, float middle, float swing)
{
    const float least_rest = rest->constant + rest->per_mean * middle - fabsf(rest->per_mean) * swing;
    const float zeros = fabsf(planar->zero_tan) + fabsf(planar->zero_cot);
    const float zeros_off = ROUNDING * fabsf(planar->cross_factor) * zeros;
    const float cross_off = zeros_off + ROUNDING * fabsf(planar->cross_least);
    const float parts = fabsf(rest->constant) + fabsf(rest->left_over) / ROUNDING;
    return parts < 16.0f * least_rest && cross_off * cross_off < 4e-12f * least_rest &&
           middle + swing < 40.0f * (middle - swing);
}

brace_status_t brace_planar_collapse(const brace_limb_t *limb, brace_planar_t *planar)
{
    if (limb == NULL || planar == NULL) {
        return BRACE_E_NULL;
    }
    if (limb->base.x_mm_per_n != limb->base.z_mm_per_n) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_element_t element[BRACE_ELEMENT_COUNT];
    const float iso_mm_per_n = brace_elements_of_limb(limb, element) + limb->base.x_mm_per_n;
    brace_harmonics_t harmonics;
    brace_harmonics_of(element, &harmonics);
    harmonics.mean.at_fold += iso_mm_per_n;

    const float middle = brace_harmonic_middle(&harmonics.mean), swing = brace_harmonic_swing(&harmonics.mean);
    const float mean_off = ROUNDING * (middle + swing);
    if (!brace_is_finite(middle - swing) || middle - swing <= -16.0f * mean_off) {
        return BRACE_E_PARAMETER;
    }
    const rest_t rest = rest_of(&harmonics, iso_mm_per_n, mean_off);
    brace_planar_t collapsed = {
        .mean = harmonics.mean,
        .dev_x = harmonics.dev_x,
        .dev_z = harmonics.dev_z,
        .rest_constant = rest.constant,
        .rest_per_mean = rest.per_mean,
    };
    factor_cross(&harmonics.cross, &collapsed);
    if (!is_accurate(&collapsed, &rest, middle, swing)) {
        return BRACE_E_UNSUPPORTED;
    }
    *planar = collapsed;
    return BRACE_OK;
}
