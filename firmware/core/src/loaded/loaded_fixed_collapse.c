#include <math.h>

#include "brace/loaded_fixed.h"
#include "loaded/fixed_quantise.h"
#include "loaded/fixed_units.h"

static brace_fixed_vec_t lengths_of(brace_vec_t v_mm, int32_t exponent)
{
    return (brace_fixed_vec_t){quantised((double)v_mm.x, exponent), quantised((double)v_mm.z, exponent)};
}

/* A spring's vector over the root of the unit of length, in units of the root of 2^spring_exponent; and that over the
 * root of two. spring_exponent is even. */
static void roots_of(brace_vec_t root, const brace_loaded_fixed_t *fixed, brace_fixed_vec_t roots_q31[2])
{
    const int32_t length = fixed->length_exponent, half = (length + (length & 1)) / 2;
    const double odd = (length & 1) != 0 ? 1.4142135623730951 : 1.0;
    const int32_t exponent = 31 - half - fixed->spring_exponent / 2;
    for (int parity = 0; parity < 2; parity++) {
        const double by = parity != 0 ? odd * 0.70710678118654752 : odd;
        roots_q31[parity] =
            (brace_fixed_vec_t){quantised(by * (double)root.x, exponent), quantised(by * (double)root.z, exponent)};
    }
}

static brace_loaded_fixed_link_t link_of(const brace_loaded_link_t *link, const brace_loaded_fixed_t *fixed)
{
    const int32_t length = fixed->length_exponent;
    brace_loaded_fixed_link_t of = {
        .length_q28 = quantised((double)link->length_mm, 28 - length),
        .to_beam_q28 = lengths_of(link->to_beam_mm, 28 - length),
        .beam_q28 = lengths_of(link->beam_mm, 28 - length),
        .bend_q31 = quantised((double)link->bend_rad_per_n_mm, 31 + length - fixed->bend_exponent),
        .end_q31 = quantised((double)link->end_mm_per_n, 31 - length - fixed->spring_exponent),
        .weight_q31 = quantised((double)link->weight_n, 31 - fixed->weight_exponent)};
    roots_of(link->root_root, fixed, of.root_root_q31);
    roots_of(link->end_root, fixed, of.end_root_q31);
    return of;
}

static float square(brace_vec_t v)
{
    return v.x * v.x + v.z * v.z;
}

void brace_loaded_fixed_collapse(const brace_loaded_t *loaded, brace_loaded_fixed_t *fixed)
{
    const brace_loaded_link_t *femur = &loaded->femur, *tibia = &loaded->tibia;
    fixed->length_exponent = exponent_above(femur->length_mm + tibia->length_mm);
    const float bend =
        fmaxf(fmaxf(femur->bend_rad_per_n_mm, tibia->bend_rad_per_n_mm), loaded->base_rotation_rad_per_n_mm);
    fixed->bend_exponent = exponent_above(bend) + fixed->length_exponent;
    const float ends = loaded->base_mm_per_n + femur->end_mm_per_n + tibia->end_mm_per_n;
    const float springs = ends + square(loaded->base_root) + square(femur->root_root) + square(femur->end_root) +
                          square(tibia->root_root) + square(tibia->end_root);
    const int32_t spring_exponent = exponent_above(springs) - fixed->length_exponent;
    fixed->spring_exponent = larger(spring_exponent + (spring_exponent & 1), 2 * LEAST_EXPONENT);
    fixed->weight_exponent = exponent_above(loaded->weight_n);
    fixed->femur = link_of(femur, fixed);
    fixed->tibia = link_of(tibia, fixed);
    fixed->knee_q31 = quantised((double)loaded->knee_n, 31 - fixed->weight_exponent);
    fixed->weight_q31 = quantised((double)loaded->weight_n, 31 - fixed->weight_exponent);
    fixed->base_q31 = quantised((double)loaded->base_mm_per_n, 31 - fixed->length_exponent - fixed->spring_exponent);
    roots_of(loaded->base_root, fixed, fixed->base_root_q31);
    fixed->base_rotation_q31 =
        quantised((double)loaded->base_rotation_rad_per_n_mm, 31 + fixed->length_exponent - fixed->bend_exponent);
    fixed->weight_q8 = (uint32_t)quantised(384.0 * (double)loaded->weight_n, 0);
    if (!is_within_units(fixed)) {
        *fixed = (brace_loaded_fixed_t){.bend_exponent = REFUSED_EXPONENT};
    }
}
