#include "brace/loaded_fixed.h"

#include <stddef.h>

#include "fixed/fixed_inverse.h"
#include "loaded/fixed_buckling.h"

/* brace/loaded.h in integers: the steps of loaded.c, in the formats of loaded/fixed_vec.h. */

#define TURN_MOST ANGLE_Q29(1.5)
#define BEND_MOST ANGLE_Q29(0.8)
#define SETTLED ANGLE_Q29(0.14)
#define SETTLED_SQUARE_Q31 Q31(0.14 * 0.14)
#define FORCE_MOST_Q17 (10000u << 17)
#define REACH_HIGH_Q24 (31 << 24) /* BRACE_REACH_RAD2 */
#define DOWN_MOST_Q30 ((1 << 30) + (1 << 20))
#define INFINITE_BITS 0x7f800000u
#define LEAST_TRACE_Q54 (1 << 20)
#define LEAST_DET_HIGH 4u         /* 3e-8 of the squared mean */
#define SLENDER_Q32 85899u        /* BRACE_SLENDER of chain/tensor.h, 2e-5 */

/* --- the inputs, and their units ------------------------------------------------------------------------------ */

/* A tick's numbers in integers. */
typedef struct {
    int32_t theta1_q28, theta2_q28;
    fixed_vec_t tip_q30, down_q30;
    int32_t hip_yields, knee_yields, hip, knee; /* compliances, the base's rotation with the hip's */
    uint32_t parity;                            /* of the units: which of a spring's two vectors */
    int32_t force_exponent;
    uint32_t bend_shift, spring_shift, root_shift, weight_shift;
} fixed_inputs_t;

INLINE uint32_t at_most_31(int32_t bits)
{
    return bits > 31 ? 31u : (uint32_t)bits;
}

INLINE bool is_finite_word(uint32_t bits)
{
    return (bits & INFINITE_BITS) != INFINITE_BITS;
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
    *force_q17 = (uint32_t)fixed_of(x & 0x7fffffffu, 17) + (uint32_t)fixed_of(z & 0x7fffffffu, 17);
    const uint64_t reach = (uint64_t)((int64_t)in->theta1_q28 * in->theta1_q28) +
                           (uint64_t)((int64_t)in->theta2_q28 * in->theta2_q28);
    return (uint32_t)(reach >> 32) < REACH_HIGH_Q24 && *force_q17 <= FORCE_MOST_Q17 ? BRACE_OK : BRACE_E_RANGE;
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
    if (((hip_yields | hip | knee_yields | knee) >> 31) != 0u || force + most > 1 || force > 60) {
        return BRACE_E_SINGULAR;
    }
    const int32_t roots = force + limb->spring_exponent;
    in->parity = (uint32_t)roots & 1u;
    in->force_exponent = force;
    in->bend_shift = at_most_31(2 - force - limb->bend_exponent);
    in->spring_shift = at_most_31(1 - roots);
    in->root_shift = at_most_31(1 - ((roots + 1) >> 1));
    in->weight_shift = at_most_31(1 + force - limb->weight_exponent);
    in->tip_q30 = (fixed_vec_t){fixed_of(x, 30 - force), fixed_of(z, 30 - force)};
    const int32_t base = limb->base_rotation_q31 >> in->bend_shift, format = 29 + force + length;
    in->hip_yields = fixed_of(hip_yields, format) + base, in->hip = fixed_of(hip, format) + base;
    in->knee_yields = fixed_of(knee_yields, format), in->knee = fixed_of(knee, format);
    return BRACE_OK;
}

INLINE fixed_vec_t root_of(const fixed_vec_t roots_q31[2], const fixed_inputs_t *in)
{
    const fixed_vec_t *root = &roots_q31[in->parity];
    return (fixed_vec_t){root->x >> in->root_shift, root->z >> in->root_shift};
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

/* --- C and K -------------------------------------------------------------------------------------------------- */

/* C, entry by entry, as whole sums of products. Those of one entry of the diagonal are not negative; entries wrap until
 * they are looked at. */
typedef struct {
    uint64_t xx, xz, zz;
} fixed_tensor_t;

INLINE uint64_t product_of(int32_t a, int32_t b)
{
    return (uint64_t)((int64_t)a * b);
}

/* c (q54) += by v v', v a lever, by at least 0. */
INLINE void add_scaled(fixed_tensor_t *c, fixed_vec_t v, int32_t by)
{
    const fixed_vec_t product_q26 = fixed_scaled(v, by, 31);
    c->xx += product_of(product_q26.x, v.x);
    c->xz += product_of(product_q26.x, v.z);
    c->zz += product_of(product_q26.z, v.z);
}

/* c (q60) += v v', v a spring's vector. */
INLINE void add_spring(fixed_tensor_t *c, fixed_vec_t v)
{
    c->xx += product_of(v.x, v.x);
    c->xz += product_of(v.x, v.z);
    c->zz += product_of(v.z, v.z);
}

/* Notes as lost an entry of the diagonal, q54, that reaches 256. Three of add_scaled's are below 3 256, whatever v and
 * `by`, so that two of these and springs do not wrap beyond it. */
INLINE void look_at(const fixed_tensor_t *c, lost_t *lost)
{
    *lost |= (uint32_t)(c->xx >> 32) >> 6 | (uint32_t)(c->zz >> 32) >> 6;
}

/* Levers (q28) less others times ratios (q27). */
INLINE fixed_vec_t less_scaled(fixed_vec_t v, fixed_vec_t a, int32_t by, fixed_vec_t b, int32_t to, lost_t *lost)
{
    return (fixed_vec_t){kept(sum3(v.x, ONE_Q27, a.x, -by, b.x, -to), 27, ROOM_LEVER_LESS, lost),
                         kept(sum3(v.z, ONE_Q27, a.z, -by, b.z, -to), 27, ROOM_LEVER_LESS, lost)};
}

/* As add_link of loaded.c. */
INLINE fixed_vec_t add_link(fixed_tensor_t *c, fixed_tensor_t *springs, const fixed_rest_t *rest,
                            const fixed_factors_t *f, fixed_vec_t beyond, lost_t *lost)
{
    const fixed_vec_t none = {0, 0}, end = fixed_plus(rest->end, beyond), a = fixed_plus(rest->a, end);
    const fixed_vec_t b = less_scaled(fixed_plus(rest->b, end), a, f->b_by_a, none, 0, lost);
    const fixed_vec_t root = fixed_plus(fixed_minus(fixed_quarter(rest->tip), rest->aside), beyond);
    add_scaled(c, a, f->yields_a);
    add_scaled(c, b, f->yields_b);
    add_spring(springs, rest->root_spring);
    add_spring(springs, rest->end_spring);
    return less_scaled(root, a, f->root_by_a, b, f->root_by_b, lost);
}

/* K from C (q54 in units of length over force), seen from the femur. exponent: of force over length. */
static brace_status_t stiffness_of(const fixed_tensor_t *c, uint32_t theta1_turn, int32_t exponent,
                                   brace_stiffness_t *stiffness)
{
    const uint64_t trace_as_is = c->xx + c->zz;
    if ((int64_t)trace_as_is < LEAST_TRACE_Q54) { /* 512 and more are negative */
        return BRACE_E_SINGULAR;
    }
    const uint32_t zeros = (uint32_t)__builtin_clzll(trace_as_is) - 1u;
    const uint64_t xx = c->xx << zeros, zz = c->zz << zeros, xz = c->xz << zeros;
    /* det C, q60 of the unit of xx's high word: high and low words, so that the small difference of large products is
     * right to the last place */
    const int32_t xz_high = (int32_t)(uint32_t)(xz >> 32);
    const uint32_t xx_high = (uint32_t)(xx >> 32), zz_high = (uint32_t)(zz >> 32);
    const uint64_t across = (uint64_t)xx_high * (uint32_t)zz + (uint64_t)zz_high * (uint32_t)xx;
    const int64_t det = (int64_t)((uint64_t)xx_high * zz_high) - (int64_t)xz_high * xz_high + (int64_t)(across >> 32) -
                        (((int64_t)xz_high * (int64_t)(uint32_t)xz) >> 31);
    if (det < (int64_t)((uint64_t)LEAST_DET_HIGH << 32)) {
        return BRACE_E_SINGULAR;
    }
    const uint64_t trace = xx + zz;
    const uint32_t det_high = (uint32_t)((uint64_t)det >> 32), det_zeros = leading_zeros(det_high);
    const uint32_t mean = (uint32_t)(trace >> 33), slender = high_unsigned(high_unsigned(mean, mean), SLENDER_Q32);
    const fixed_circle_t circle = {
        .trace = (uint32_t)(trace >> 31),
        .minus_dev_x = brace_high_word((int64_t)(zz - xx)),
        .dev_z = shifted((int64_t)xz, 31),
        .det_leading = (uint32_t)(((uint64_t)det << det_zeros) >> 32),
        .exponent_k = (uint32_t)(120 + (int32_t)(zeros + det_zeros) + exponent) << 23,
        .exponent_min = (uint32_t)(121 + (int32_t)zeros + exponent) << 23,
        .twice_turn = 2u * theta1_turn};
    stiffness_of_circle(&circle, stiffness);
    stiffness->flags = det_high < slender ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}

/* --- the limb ------------------------------------------------------------------------------------------------- */

/* Has the second step moved so little that a third would hardly change the limb? As is_settled of loaded.c. */
INLINE bool is_settled(int32_t unsettled, fixed_wide_t det)
{
    const int32_t square_q31 = times(unsettled, unsettled, 27); /* below 0.02 */
    const int32_t limit = times(det.mantissa_q31, SETTLED_SQUARE_Q31, 31), exponent = det.exponent;
    return exponent >= 0 ? square_q31 >> (exponent > 31 ? 31 : exponent) <= limit
                         : square_q31 <= limit >> (exponent < -31 ? 31 : -exponent);
}

static brace_displacement_t displacement_of(const brace_loaded_fixed_t *limb, const fixed_inputs_t *in,
                                            fixed_vec_t bent, fixed_vec_t femur, fixed_vec_t tibia)
{
    const fixed_vec_t straight = {limb->femur.length_q28 + times(limb->tibia.length_q28, tibia.x, 30),
                                  times(limb->tibia.length_q28, tibia.z, 30)};
    const fixed_vec_t moved = fixed_turned(fixed_minus(bent, straight), femur);
    const fixed_vec_t on_base =
        fixed_plus(in->tip_q30, fixed_scaled(in->down_q30, limb->weight_q31 >> in->weight_shift, 30));
    const fixed_vec_t root = root_of(limb->base_root_q31, in);
    const int32_t along = fixed_dot(root, on_base, 30);
    const fixed_vec_t base = fixed_sum2(on_base, limb->base_q31 >> in->spring_shift, root, along, 32);
    const int32_t format = 28 - limb->length_exponent;
    return (brace_displacement_t){float_from(moved.x + base.x, format), float_from(moved.z + base.z, format)};
}

brace_status_t brace_loaded_fixed_stiffness(const brace_loaded_fixed_t *fixed, float theta1_rad, float theta2_rad,
                                            const brace_load_t *load, brace_loaded_stiffness_t *result)
{
    fixed_inputs_t in;
    const brace_status_t refused = inputs_of(fixed, theta1_rad, theta2_rad, load, &in);
    if (refused != BRACE_OK) {
        return refused;
    }
    const uint32_t theta1_turn = brace_turn_from_q28(in.theta1_q28);
    const fixed_vec_t femur = fixed_direction(theta1_turn);
    const fixed_vec_t tibia = fixed_direction(0u - brace_turn_from_q28(in.theta2_q28)); /* seen from the femur */
    const fixed_vec_t tip = fixed_turned_back(in.tip_q30, femur), down = fixed_turned_back(in.down_q30, femur);
    const fixed_vec_t knee_carries = fixed_plus(tip, fixed_scaled(down, fixed->knee_q31 >> in.weight_shift, 30));
    fixed_limb_t limb = {.femur = link_seen(&fixed->femur, &in, NULL, knee_carries, down),
                         .tibia = link_seen(&fixed->tibia, &in, &tibia, tip, down)};
    if (!fixed_step(&limb, true, in.hip_yields, in.knee_yields)) {
        return BRACE_E_SINGULAR;
    }
    const int32_t turned = fixed_end_turn(&limb.tibia_shape);
    if (!fixed_step(&limb, false, in.hip_yields, in.knee_yields)) {
        return BRACE_E_SINGULAR;
    }
    const int32_t now_turned = fixed_end_turn(&limb.tibia_shape), unsettled = wrapped_less(now_turned, turned);
    if (!is_within((now_turned >> 1) - (turned >> 1), SETTLED >> 1) ||
        !fixed_is_bent_within(&limb.femur_shape, TURN_MOST, BEND_MOST) ||
        !fixed_is_bent_within(&limb.tibia_shape, TURN_MOST, BEND_MOST)) {
        return BRACE_E_SINGULAR;
    }
    fixed_rest_t femur_rest, tibia_rest;
    fixed_rest_of(&limb.femur, &limb.femur_shape, &femur_rest);
    fixed_rest_of(&limb.tibia, &limb.tibia_shape, &tibia_rest);

    const fixed_stance_t stance = {&femur_rest, &tibia_rest, limb.femur.bend, limb.tibia.bend, in.hip, in.knee};
    fixed_pivots_t p;
    if (!fixed_pivots_of(&stance, &p)) {
        return BRACE_E_SINGULAR;
    }
    const fixed_wide_t det = fixed_product(&p);
    if (!is_settled(unsettled, det)) {
        return BRACE_E_SINGULAR;
    }
    lost_t lost = 0u;
    fixed_tensor_t c = {0, 0, 0}, springs = {0, 0, 0};
    const fixed_vec_t none = {0, 0};
    const fixed_vec_t by_knee = add_link(&c, &springs, &tibia_rest, &p.tibia, none, &lost);
    add_scaled(&c, by_knee, kept((int64_t)in.knee * p.per_knee, 27, ROOM_COMPLIANCE, &lost));
    const fixed_vec_t beyond = {kept((int64_t)by_knee.x * p.per_knee, 27, ROOM_LEVER, &lost),
                                kept((int64_t)by_knee.z * p.per_knee, 27, ROOM_LEVER, &lost)};
    look_at(&c, &lost);
    if (lost >= LOST) {
        return BRACE_E_SINGULAR;
    }
    const fixed_vec_t by_hip = add_link(&c, &springs, &femur_rest, &p.femur, beyond, &lost);
    add_scaled(&c, by_hip, kept((int64_t)in.hip * p.per_hip, 27, ROOM_COMPLIANCE, &lost));
    look_at(&c, &lost);
    if (lost >= LOST) {
        return BRACE_E_SINGULAR;
    }
    add_spring(&springs, fixed_turned_back(root_of(fixed->base_root_q31, &in), femur));
    const uint64_t even_q54 =
        (uint64_t)((fixed->base_q31 >> in.spring_shift) + limb.femur.end_q30 + limb.tibia.end_q30) << 24;
    c.xx += (springs.xx >> 6) + even_q54, c.zz += (springs.zz >> 6) + even_q54;
    c.xz += (uint64_t)((int64_t)springs.xz >> 6);
    const brace_status_t status =
        stiffness_of(&c, theta1_turn, in.force_exponent - fixed->length_exponent, &result->stiffness);
    if (status != BRACE_OK) {
        return status;
    }
    const fixed_vec_t tibia_bent = fixed_turned(tibia_rest.tip, femur);
    const int32_t length_format = 28 - fixed->length_exponent;
    result->displacement = displacement_of(fixed, &in, fixed_plus(femur_rest.tip, tibia_rest.tip), femur, tibia);
    result->tibia_mm =
        (brace_vec_t){float_from(tibia_bent.x, length_format), float_from(tibia_bent.z, length_format)};
    result->hip_turn_rad = float_from(limb.femur_shape.root, 29);
    result->knee_turn_rad = float_from(limb.tibia_shape.root - fixed_end_turn(&limb.femur_shape), 29);
    result->buckling_factor = fixed_buckling_factor(&stance, det);
    return BRACE_OK;
}
