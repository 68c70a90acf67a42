#include <math.h>
#include <stdbool.h>

#include "brace/loaded_space_fixed.h"
#include "fixed_space/space_kept.h"
#include "loaded/fixed_quantise.h"

static brace_fixed_vec_t vector_of(brace_vec_t v, int32_t exponent)
{
    return (brace_fixed_vec_t){quantised((double)v.x, exponent), quantised((double)v.z, exponent)};
}

/* The arm of the springs at a link's end, as a part of the unit of length: so short that they curl the link's own turns
 * by no more than one for each radian. */
static int32_t arm_shift_of(const brace_space_link_t *link, int32_t length_exponent)
{
    const int32_t curl = exponent_above(link->curl_per_mm) + length_exponent;
    return curl > (int32_t)ARM_SHIFT_MOST ? (int32_t)ARM_SHIFT_MOST : larger(curl, 0);
}

static bool is_too_short(const brace_space_link_t *link, int32_t length_exponent)
{
    return exponent_above(link->curl_per_mm) + length_exponent > (int32_t)ARM_SHIFT_MOST;
}

/* Exponents of a link's compliances for an angle, in 1/N, their turn times the unit of length. */
static int32_t turn_exponent_of(const brace_space_link_t *link, int32_t length_exponent)
{
    if (is_too_short(link, length_exponent)) {
        return REFUSED_EXPONENT;
    }
    /* To the twist comes what bending spreads: by less than a quarter of the most that a word holds. */
    const float turns = fmaxf(fmaxf(1.25f * link->twist_rad_per_n_mm, link->sideways_rad_per_n_mm),
                              fmaxf(link->bend_rad_per_n_mm, fmaxf(link->across_spread_per_n_mm,
                                                                   link->sideways_spread_per_n_mm)));
    const float springs = fmaxf(link->across_mm_per_n, link->sideways_mm_per_n);
    const int32_t arms = 2 * arm_shift_of(link, length_exponent);
    return larger(exponent_above(turns) + length_exponent, exponent_above(springs) - length_exponent + arms);
}

static float stretch_of(const brace_space_link_t *link)
{
    return link->stretch_root.x * link->stretch_root.x + link->stretch_root.z * link->stretch_root.z;
}

static brace_space_fixed_link_t link_of(const brace_space_link_t *link, const brace_loaded_space_fixed_t *fixed)
{
    const int32_t length = fixed->length_exponent, turns = 31 + length - fixed->turn_exponent;
    const int32_t arm_shift = arm_shift_of(link, length), per_arm = 30 + length - arm_shift;
    const int32_t arms = 31 - length - fixed->turn_exponent + 2 * arm_shift;
    return (brace_space_fixed_link_t){
        .length_q28 = quantised((double)link->length_mm, 28 - length),
        .twelfth_q28 = quantised((double)link->twelfth_mm, 28 - length),
        .along_q30 = {quantised((double)link->across.z, 30), quantised((double)-link->across.x, 30)},
        .tilt_q28 = vector_of(link->tilt_mm, 28 - length),
        .bow_q28 = vector_of(link->bow_mm, 28 - length),
        .twist_q31 = quantised((double)link->twist_rad_per_n_mm, turns),
        .sideways_q31 = quantised((double)link->sideways_rad_per_n_mm, turns),
        .bend_q31 = quantised((double)link->bend_rad_per_n_mm, turns),
        .across_arm_q31 = quantised((double)link->across_mm_per_n, arms),
        .sideways_arm_q31 = quantised((double)link->sideways_mm_per_n, arms),
        .across_spread_q31 = quantised((double)link->across_spread_per_n_mm, turns),
        .sideways_spread_q31 = quantised((double)link->sideways_spread_per_n_mm, turns),
        .stretch_q31 = quantised((double)stretch_of(link), 31 - length - fixed->spring_exponent),
        .end_share_q30 = larger(quantised((double)link->end_share, 30) - 1, 0), /* and a half more is below 1 */
        .stretch_end_share_q30 = quantised((double)link->stretch_end_share, 30),
        .own_share_q30 = quantised((double)link->own_share, 30),
        .curl_q30 = quantised((double)link->curl_per_mm, per_arm),
        .shortens_q30 = quantised((double)link->shortens_per_mm, per_arm),
        .weight_q31 = quantised((double)link->weight_n, 31 - fixed->weight_exponent),
        .arm_shift = (uint32_t)arm_shift};
}

void brace_loaded_space_fixed_collapse(const brace_loaded_space_t *loaded, brace_loaded_space_fixed_t *fixed)
{
    const brace_space_link_t *coxa = &loaded->coxa, *femur = &loaded->femur, *tibia = &loaded->tibia;
    const int32_t length = exponent_above(coxa->length_mm + femur->length_mm + tibia->length_mm);
    const int32_t links = larger(larger(turn_exponent_of(coxa, length), turn_exponent_of(femur, length)),
                                 turn_exponent_of(tibia, length));
    const float springs = stretch_of(coxa) + stretch_of(femur) + stretch_of(tibia) + loaded->base_x_mm_per_n +
                          loaded->base_z_mm_per_n;
    fixed->length_exponent = length;
    fixed->turn_exponent = larger(links, exponent_above(loaded->base_rotation_rad_per_n_mm) + length);
    fixed->spring_exponent = exponent_above(springs) - length;
    fixed->weight_exponent = exponent_above(loaded->beyond_coxa_n);
    fixed->coxa = link_of(coxa, fixed);
    fixed->femur = link_of(femur, fixed);
    fixed->tibia = link_of(tibia, fixed);
    fixed->beyond_coxa_q31 = quantised((double)loaded->beyond_coxa_n, 31 - fixed->weight_exponent);
    fixed->beyond_femur_q31 = quantised((double)loaded->beyond_femur_n, 31 - fixed->weight_exponent);
    fixed->base_x_q31 = quantised((double)loaded->base_x_mm_per_n, 31 - length - fixed->spring_exponent);
    fixed->base_z_q31 = quantised((double)loaded->base_z_mm_per_n, 31 - length - fixed->spring_exponent);
    fixed->base_rotation_q31 = quantised((double)loaded->base_rotation_rad_per_n_mm,
                                         31 + length - fixed->turn_exponent);
    fixed->weight_q8 = (uint32_t)quantised(384.0 * (double)loaded->beyond_coxa_n, 0);
    if (!is_space_kept(fixed)) {
        *fixed = (brace_loaded_space_fixed_t){.turn_exponent = REFUSED_EXPONENT};
    }
}
