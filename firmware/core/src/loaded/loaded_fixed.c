#include "brace/loaded_fixed.h"

#include "loaded/fixed_buckling.h"
#include "loaded/fixed_compliance.h"
#include "loaded/fixed_inputs.h"

/* brace/loaded.h in integers: the steps of loaded.c, in the formats of loaded/fixed_vec.h. */

#define BEND_PROMISED ANGLE_Q29(0.25) /* as loaded.c */
#define STEPS_MOST 4
#define BENT_STEPS_MOST (STEPS_MOST - 1) /* after the first one, from the straight limb */
#define SURE ANGLE_Q27(0.05)
#define SETTLED ANGLE_Q27(0.14)
#define SETTLED_SQUARE_Q31 Q31(0.14 * 0.14)

/* --- the limb ------------------------------------------------------------------------------------------------- */

/* Has the second step moved so little that a third would hardly change the limb? As is_settled of loaded.c. */
INLINE bool is_settled(int32_t unsettled, fixed_wide_t det)
{
    const int32_t square_q31 = times(unsettled, unsettled, 27); /* below 0.02 */
    const int32_t limit = times(det.mantissa_q31, SETTLED_SQUARE_Q31, 31), exponent = det.exponent;
    return exponent >= 0 ? square_q31 >> (exponent > 31 ? 31 : exponent) <= limit
                         : square_q31 <= limit >> (exponent < -31 ? 31 : -exponent);
}

/* As settle of loaded.c. is_bent: the limb is bent already. turned_q27: by the last step, a link's end at most
 * returns false where the limb yields too much for the formats */
INLINE bool fixed_settle(fixed_limb_t *limb, const fixed_inputs_t *in, bool is_bent, int bent_steps_most,
                         int32_t *turned_q27)
{
    bool is_within_formats = true;
    if (!is_bent) {
        is_within_formats = fixed_bounded_step(limb, true, in->hip_yields, in->knee_yields, turned_q27);
    }
    for (int taken = 0; taken < bent_steps_most && is_within_formats && (taken < 1 || *turned_q27 > SURE); taken++) {
        is_within_formats = fixed_bounded_step(limb, false, in->hip_yields, in->knee_yields, turned_q27);
    }
    return is_within_formats;
}

/* The whole load, as the base carries it [q30]. */
INLINE fixed_vec_t on_base_of(const brace_loaded_fixed_t *limb, const fixed_inputs_t *in)
{
    return fixed_plus(in->tip_q30, fixed_scaled(in->down_q30, limb->weight_q31 >> in->weight_shift, 30));
}

/* Is the whole load within half of itself of the one before? The units of the two may differ. */
INLINE bool is_near(fixed_vec_t load_q30, int32_t exponent, const brace_loaded_fixed_place_t *before)
{
    const int32_t apart = exponent - before->force_exponent;
    const uint32_t now_bits = at_most_31(apart < 0 ? 1 - apart : 1), old_bits = at_most_31(apart > 0 ? apart + 1 : 1);
    const int32_t x = load_q30.x >> now_bits, change_x = x - (before->on_base_q30.x >> old_bits);
    const int32_t z = load_q30.z >> now_bits, change_z = z - (before->on_base_q30.z >> old_bits);
    return sum2(change_x, change_x, change_z, change_z) <= sum2(x, x, z, z) >> 2;
}

/* How far a link bends within itself, half of it in q29. */
INLINE uint32_t half_bend_of(const fixed_shape_t *shape)
{
    return (magnitude_of(shape->a) + magnitude_of(shape->b)) >> 1;
}

static brace_displacement_t displacement_of(const brace_loaded_fixed_t *limb, const fixed_inputs_t *in,
                                            fixed_vec_t bent, fixed_vec_t femur, fixed_vec_t tibia)
{
    const fixed_vec_t straight = {limb->femur.length_q28 + times(limb->tibia.length_q28, tibia.x, 30),
                                  times(limb->tibia.length_q28, tibia.z, 30)};
    const fixed_vec_t moved = fixed_turned(fixed_minus(bent, straight), femur);
    const fixed_vec_t on_base = on_base_of(limb, in), root = root_of(limb->base_root_q31, in);
    const int32_t along = fixed_dot(root, on_base, 30);
    const fixed_vec_t base = fixed_sum2(on_base, limb->base_q31 >> in->spring_shift, root, along, 32);
    const int32_t format = 28 - limb->length_exponent;
    return (brace_displacement_t){float_from(moved.x + base.x, format), float_from(moved.z + base.z, format)};
}

/* The equilibrium: by all the steps that it takes, or with `place` as brace_loaded_fixed_follow. */
INLINE bool comes_to_rest(const brace_loaded_fixed_t *fixed, const fixed_inputs_t *in, bool is_bent,
                          brace_loaded_fixed_place_t *place, fixed_limb_t *limb, int32_t *turned_q27)
{
    if (place == NULL) {
        return fixed_settle(limb, in, false, BENT_STEPS_MOST, turned_q27) && *turned_q27 <= SETTLED;
    }
    const fixed_vec_t on_base_q30 = on_base_of(fixed, in);
    const bool goes_on = is_bent && is_near(on_base_q30, in->force_exponent, place);
    if (goes_on) {
        limb->femur_shape = place->femur_shape, limb->tibia_shape = place->tibia_shape;
    }
    const bool is_within_formats = fixed_settle(limb, in, goes_on, 1, turned_q27);
    *place = (brace_loaded_fixed_place_t){limb->femur_shape, limb->tibia_shape, on_base_q30, in->force_exponent};
    return is_within_formats && *turned_q27 <= SURE;
}

/* place: NULL: the whole search */
INLINE brace_status_t stiffness_from(const brace_loaded_fixed_t *fixed, float theta1_rad, float theta2_rad,
                                     const brace_load_t *load, bool is_bent, brace_loaded_fixed_place_t *place,
                                     brace_loaded_stiffness_t *result)
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
    int32_t turned_q27;
    if (!comes_to_rest(fixed, &in, is_bent, place, &limb, &turned_q27)) {
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
    if (!is_settled(4 * turned_q27, det)) {
        return BRACE_E_SINGULAR;
    }
    lost_t lost = 0u;
    fixed_tensor_t c = {0, 0, 0}, springs = {0, 0, 0};
    const fixed_vec_t none = {0, 0};
    const fixed_vec_t by_knee = add_link(&c, &springs, &tibia_rest, &p.tibia, in.coarser, none, &lost);
    add_scaled(&c, by_knee, kept((int64_t)(in.knee >> in.coarser) * p.per_knee, 27, ROOM_COMPLIANCE, &lost));
    const fixed_vec_t beyond = {kept((int64_t)by_knee.x * p.per_knee, 27, ROOM_LEVER, &lost),
                                kept((int64_t)by_knee.z * p.per_knee, 27, ROOM_LEVER, &lost)};
    look_at(&c, &lost);
    if (lost >= LOST) {
        return BRACE_E_SINGULAR;
    }
    const fixed_vec_t by_hip = add_link(&c, &springs, &femur_rest, &p.femur, in.coarser, beyond, &lost);
    add_scaled(&c, by_hip, kept((int64_t)(in.hip >> in.coarser) * p.per_hip, 27, ROOM_COMPLIANCE, &lost));
    look_at(&c, &lost);
    if (lost >= LOST) {
        return BRACE_E_SINGULAR;
    }
    add_spring(&springs, fixed_turned_back(root_of(fixed->base_root_q31, &in), femur));
    const uint64_t even_q54 = (uint64_t)((fixed->base_q31 >> in.spring_shift) + limb.femur.end_q30 + limb.tibia.end_q30)
                              << 24;
    c.xx += ((springs.xx >> 6) + even_q54) >> in.coarser, c.zz += ((springs.zz >> 6) + even_q54) >> in.coarser;
    c.xz += (uint64_t)((int64_t)springs.xz >> (6u + in.coarser));
    const brace_status_t status = stiffness_of(
        &c, theta1_turn, in.force_exponent - fixed->length_exponent - (int32_t)in.coarser, &result->stiffness);
    if (status != BRACE_OK) {
        return status;
    }
    if (half_bend_of(&limb.femur_shape) > BEND_PROMISED >> 1 || half_bend_of(&limb.tibia_shape) > BEND_PROMISED >> 1) {
        result->stiffness.flags |= (uint32_t)BRACE_FLAG_NEAR_SINGULAR;
    }
    const fixed_vec_t tibia_bent = fixed_turned(tibia_rest.tip, femur);
    const int32_t length_format = 28 - fixed->length_exponent;
    result->displacement = displacement_of(fixed, &in, fixed_plus(femur_rest.tip, tibia_rest.tip), femur, tibia);
    result->tibia_mm = (brace_vec_t){float_from(tibia_bent.x, length_format), float_from(tibia_bent.z, length_format)};
    result->hip_turn_rad = float_from(limb.femur_shape.root, 29);
    result->knee_turn_rad = float_from((limb.tibia_shape.root >> 1) - (fixed_end_turn(&limb.femur_shape) >> 1), 28);
    result->buckling_factor = fixed_buckling_factor(&stance, det);
    return BRACE_OK;
}

brace_status_t brace_loaded_fixed_stiffness(const brace_loaded_fixed_t *fixed, float theta1_rad, float theta2_rad,
                                            const brace_load_t *load, brace_loaded_stiffness_t *result)
{
    return stiffness_from(fixed, theta1_rad, theta2_rad, load, false, NULL, result);
}

brace_status_t brace_loaded_fixed_follow(const brace_loaded_fixed_t *fixed, float theta1_rad, float theta2_rad,
                                         const brace_load_t *load, bool is_bent, brace_loaded_fixed_place_t *place,
                                         brace_loaded_stiffness_t *result)
{
    return stiffness_from(fixed, theta1_rad, theta2_rad, load, is_bent, place, result);
}
