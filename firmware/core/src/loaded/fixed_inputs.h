/* The inputs of K under load in fixed point: their units, the load in them, and the links as it sees them. */
#ifndef BRACE_CORE_LOADED_FIXED_INPUTS_H
#define BRACE_CORE_LOADED_FIXED_INPUTS_H

#include <stddef.h>

#include "base/exact.h"
#include "brace/loaded.h"
#include "brace/loaded_fixed_types.h"
#include "loaded/fixed_solve.h"

#define FORCE_MOST_Q17 (10000u << 17)
#define REACH_HIGH_Q24 (31 << 24) /* BRACE_REACH_RAD2 */
#define DOWN_MOST_Q30 ((1 << 30) + (1 << 20))
#define FORCE_EXPONENT_MOST 40 /* beyond it nothing yields that a float of K could tell */

/* A tick's numbers in integers. */
typedef struct {
    int32_t theta1_q28, theta2_q28;
    fixed_vec_t tip_q30, down_q30;
    int32_t hip_yields, knee_yields, hip, knee; /* compliances, the base's rotation with the hip's */
    uint32_t parity;                            /* of the units: which of a spring's two vectors */
    int32_t force_exponent;
    uint32_t bend_shift, spring_shift, root_shift, weight_shift;
    uint32_t coarser; /* bits by which C and what it is added up of are coarser: a load that is large beside the limb */
} fixed_inputs_t;

INLINE uint32_t at_most_31(int32_t bits)
{
    return bits > 31 ? 31u : (uint32_t)bits;
}

INLINE bool is_finite_word(uint32_t bits)
{
    return (bits & BRACE_INFINITE_BITS) != BRACE_INFINITE_BITS;
}

/* Angles and force: in range, out of it, or not a number. A magnitude of 8 rad and more, and of 2^14 N and more, does
 * not fit its word. */
INLINE brace_status_t check_range(uint32_t theta1, uint32_t theta2, uint32_t x, uint32_t z, fixed_inputs_t *in,
                                  uint32_t *force_q17)
{
    if (!is_finite_word(theta1) || !is_finite_word(theta2) || !is_finite_word(x) || !is_finite_word(z)) {
        return BRACE_E_NOT_FINITE;
    }
    if (exponent_above(theta1) > 3 || exponent_above(theta2) > 3 || exponent_above(x) > 14 || exponent_above(z) > 14) {
        return BRACE_E_RANGE;
    }
    in->theta1_q28 = fixed_of(theta1, 28), in->theta2_q28 = fixed_of(theta2, 28);
    const uint32_t x_q17 = (uint32_t)fixed_of(x & 0x7fffffffu, 17), z_q17 = (uint32_t)fixed_of(z & 0x7fffffffu, 17);
    const uint32_t most_q17 = x_q17 > z_q17 ? x_q17 : z_q17, sum_q17 = x_q17 + z_q17;
    *force_q17 = most_q17 + ((sum_q17 - most_q17) >> 1) + 1u; /* at least the length of (x, z) */
    const uint64_t reach =
        (uint64_t)((int64_t)in->theta1_q28 * in->theta1_q28) + (uint64_t)((int64_t)in->theta2_q28 * in->theta2_q28);
    return (uint32_t)(reach >> 32) < REACH_HIGH_Q24 && sum_q17 <= FORCE_MOST_Q17 ? BRACE_OK : BRACE_E_RANGE;
}

INLINE uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* The units, and the load in them. The unit of force is a power of two above the loads, and where they are small, one
 * that makes the compliances fill their words. */
INLINE brace_status_t inputs_of(const brace_loaded_fixed_t *limb, float theta1_rad, float theta2_rad,
                                const brace_load_t *load, fixed_inputs_t *in)
{
    const uint32_t x = bits_of(load->tip.x_n), z = bits_of(load->tip.z_n);
    const uint32_t down_x = bits_of(load->down.x), down_z = bits_of(load->down.z);
    const uint32_t hip_yields = bits_of(load->hip.yields_by_rad_per_n_mm), hip = bits_of(load->hip.slope_rad_per_n_mm);
    const uint32_t knee_yields = bits_of(load->knee.yields_by_rad_per_n_mm);
    const uint32_t knee = bits_of(load->knee.slope_rad_per_n_mm);
    uint32_t force_q17;
    const brace_status_t status = check_range(bits_of(theta1_rad), bits_of(theta2_rad), x, z, in, &force_q17);
    if (status != BRACE_OK) {
        return status;
    }
    if (exponent_above(down_x) > 1 || exponent_above(down_z) > 1) {
        return BRACE_E_RANGE;
    }
    in->down_q30 = (fixed_vec_t){fixed_of(down_x, 30), fixed_of(down_z, 30)};
    if (!is_within(in->down_q30.x, DOWN_MOST_Q30) || !is_within(in->down_q30.z, DOWN_MOST_Q30)) {
        return BRACE_E_RANGE;
    }
    /* Floats that are not negative order as their bits do. */
    const int32_t length = limb->length_exponent;
    const int32_t joint_exponent = exponent_above(larger(larger(hip_yields, hip), larger(knee_yields, knee))) + length;
    const int32_t spring_most = limb->spring_exponent + 3;
    int32_t most = joint_exponent > limb->bend_exponent ? joint_exponent : limb->bend_exponent;
    most = most > spring_most ? most : spring_most;
    const uint32_t force_q8 = (force_q17 >> 9) + limb->weight_q8 + 2u;
    const int32_t above_force = 24 - (int32_t)leading_zeros(force_q8);
    const int32_t force = above_force > -most ? above_force : -most;
    const bool is_negative = ((hip_yields | hip | knee_yields | knee) >> 31) != 0u;
    if (is_negative || force + most > 2 || force + spring_most > 1 || force > FORCE_EXPONENT_MOST) {
        return BRACE_E_SINGULAR;
    }
    const int32_t roots = force + limb->spring_exponent;
    in->parity = (uint32_t)roots & 1u;
    in->force_exponent = force;
    in->coarser = force + most > 0 ? 2u : 0u;
    in->bend_shift = at_most_31(2 - force - limb->bend_exponent);
    in->spring_shift = at_most_31(1 - roots);
    in->root_shift = at_most_31(1 - ((roots + 1) >> 1));
    in->weight_shift = at_most_31(1 + force - limb->weight_exponent);
    in->tip_q30 = (fixed_vec_t){fixed_of(x, 30 - force), fixed_of(z, 30 - force)};
    const int32_t base = limb->base_rotation_q31 >> in->bend_shift, format = 29 + force + length;
    in->hip_yields = wrapped_plus(fixed_of(hip_yields, format), base);
    in->hip = wrapped_plus(fixed_of(hip, format), base);
    in->knee_yields = fixed_of(knee_yields, format), in->knee = fixed_of(knee, format);
    return (in->hip_yields | in->hip) < 0 ? BRACE_E_SINGULAR : BRACE_OK; /* with the base's, 4 and more wrap */
}

INLINE fixed_vec_t root_of(const fixed_vec_t roots_q31[2], const fixed_inputs_t *in)
{
    return fixed_right(roots_q31[in->parity], in->root_shift);
}

INLINE fixed_link_t link_seen(const brace_loaded_fixed_link_t *link, const fixed_inputs_t *in,
                              const fixed_vec_t *turned, fixed_vec_t beyond, fixed_vec_t down)
{
    fixed_vec_t to_beam = link->to_beam_q28, beam = link->beam_q28;
    fixed_vec_t root_root = root_of(link->root_root_q31, in), end_root = root_of(link->end_root_q31, in);
    if (turned != NULL) {
        to_beam = fixed_turned(to_beam, *turned), beam = fixed_turned(beam, *turned);
        root_root = fixed_turned(root_root, *turned), end_root = fixed_turned(end_root, *turned);
    }
    const fixed_vec_t own = fixed_scaled(down, link->weight_q31 >> in->weight_shift, 30);
    const int32_t along = fixed_dot(root_root, fixed_plus(beyond, own), 30);
    return (fixed_link_t){.to_beam = to_beam,
                          .beam = beam,
                          .rigid = fixed_plus(to_beam, fixed_scaled(root_root, along, 32)),
                          .root_root = root_root,
                          .end_root = end_root,
                          .end_q30 = link->end_q31 >> in->spring_shift,
                          .bend = link->bend_q31 >> in->bend_shift,
                          .beyond = beyond,
                          .own = own,
                          .on_rigid = {beyond.x + (own.x >> 1), beyond.z + (own.z >> 1)}};
}

#endif
