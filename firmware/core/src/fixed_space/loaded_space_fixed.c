#include "brace/loaded_space_fixed.h"

#include "fixed_space/invert.h"

/* brace/loaded_space.h in integers: the steps of loaded_space.c, in the formats of fixed_space/number.h. */

#define LEFT_MOST_Q26 41943u /* 6.25e-4 rad2, as in loaded_space.c */
#define LINKS_Q26 96636764u  /* 1.44 rad2 */
#define SMALL_TURN_Q26 24159191u /* 0.36 rad2 */
#define JOINT_TURN_Q29 805306368 /* 1.5 rad */
#define SQUARE_MOST_Q25 (16u << 25) /* rad2 */
#define FORCE_MOST_Q17 (10000u << 17)
#define REACH_HIGH_Q24 (31 << 24) /* BRACE_REACH_RAD2 */
#define DOWN_MOST_Q30 ((1 << 30) + (1 << 20))
#define INFINITE_BITS 0x7f800000u

/* The limb's plane's frame, x outwards, y to the left, z up, as the coxa's frame at rest: x outwards, y up, z to the
 * right; and back. */
INLINE fixed3_t seen_from_coxa(int32_t x, int32_t y, int32_t z)
{
    return fixed3(x, z, -y);
}

INLINE brace_vec3_t seen_from_plane(fixed3_t v_q28, int32_t length_exponent)
{
    const int32_t format = 28 - length_exponent;
    return (brace_vec3_t){float_from(v_q28.x, format), -float_from(v_q28.z, format), float_from(v_q28.y, format)};
}

/* --- the inputs, and their units ------------------------------------------------------------------------------ */

/* A tick's numbers in integers. */
typedef struct {
    fixed3_t tip_q30, down_q30;
    fixed_weights_t weights;
    fixed_yields_t yields;
} fixed_inputs3_t;

INLINE bool is_number(uint32_t bits)
{
    return (bits & INFINITE_BITS) != INFINITE_BITS;
}

INLINE uint32_t magnitude_q17(uint32_t bits)
{
    return (uint32_t)fixed_of(bits & 0x7fffffffu, 17);
}

INLINE uint32_t more(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

INLINE uint32_t at_most_31(int32_t bits)
{
    return bits > 31 ? 31u : (uint32_t)bits;
}

/* Angles and force: in range, out of it, or not a number. A magnitude of 8 rad and more, and of 2^13 N and more than
 * FORCE_MOST, does not fit its word. */
INLINE brace_status_t check_range(uint32_t theta1, uint32_t theta2, uint32_t x, uint32_t y, uint32_t z,
                                  fixed_rest3_t *rest, uint32_t *force_q17)
{
    if (!(is_number(theta1) && is_number(theta2) && is_number(x) && is_number(y) && is_number(z))) {
        return BRACE_E_NOT_FINITE;
    }
    if (exponent_above(theta1) > 3 || exponent_above(theta2) > 3 || exponent_above(x) > 14 || exponent_above(y) > 14 ||
        exponent_above(z) > 14 || magnitude_q17(x) + magnitude_q17(y) > FORCE_MOST_Q17) {
        return BRACE_E_RANGE;
    }
    const int32_t theta1_q28 = fixed_of(theta1, 28), theta2_q28 = fixed_of(theta2, 28);
    *force_q17 = magnitude_q17(x) + magnitude_q17(y) + magnitude_q17(z);
    const uint64_t reach = (uint64_t)((int64_t)theta1_q28 * theta1_q28) + (uint64_t)((int64_t)theta2_q28 * theta2_q28);
    rest->theta1_turn = brace_turn_from_q28(theta1_q28);
    rest->theta2_turn = brace_turn_from_q28(theta2_q28);
    return (uint32_t)(reach >> 32) < REACH_HIGH_Q24 && *force_q17 <= FORCE_MOST_Q17 ? BRACE_OK : BRACE_E_RANGE;
}

/* A direction's part. */
INLINE bool is_part(uint32_t bits)
{
    return exponent_above(bits) <= 1 && fixed_of(bits, 30) <= DOWN_MOST_Q30 && fixed_of(bits, 30) >= -DOWN_MOST_Q30;
}

/* The units, and the load in them. The unit of force is a power of two above the loads, and where they are small, one
 * that makes the compliances fill their words. */
INLINE brace_status_t inputs_of(const brace_loaded_space_fixed_t *limb, float theta1_rad, float theta2_rad,
                                const brace_space_load_t *load, fixed_inputs3_t *in, fixed_rest3_t *rest)
{
    const uint32_t x = bits_of(load->tip_n.x), y = bits_of(load->tip_n.y), z = bits_of(load->tip_n.z);
    const uint32_t down_x = bits_of(load->down.x), down_y = bits_of(load->down.y), down_z = bits_of(load->down.z);
    const uint32_t yaw_by = bits_of(load->yaw.yields_by_rad_per_n_mm), yaw = bits_of(load->yaw.slope_rad_per_n_mm);
    const uint32_t hip_by = bits_of(load->hip.yields_by_rad_per_n_mm), hip = bits_of(load->hip.slope_rad_per_n_mm);
    const uint32_t knee_by = bits_of(load->knee.yields_by_rad_per_n_mm), knee = bits_of(load->knee.slope_rad_per_n_mm);
    uint32_t force_q17;
    const brace_status_t status = check_range(bits_of(theta1_rad), bits_of(theta2_rad), x, y, z, rest, &force_q17);
    if (status != BRACE_OK) {
        return status;
    }
    if (!(is_part(down_x) && is_part(down_y) && is_part(down_z))) {
        return BRACE_E_RANGE;
    }
    /* Floats that are not negative order as their bits do. */
    const uint32_t softest = more(more(more(yaw_by, yaw), more(hip_by, hip)), more(knee_by, knee));
    const int32_t length = limb->length_exponent, joint_most = exponent_above(softest) + length;
    const int32_t spring_most = limb->spring_exponent + 3;
    int32_t most = joint_most > limb->turn_exponent ? joint_most : limb->turn_exponent;
    most = most > spring_most ? most : spring_most;
    const uint32_t force_q8 = (force_q17 >> 9) + limb->weight_q8 + 2u;
    const int32_t above_force = 24 - (int32_t)leading_zeros(force_q8);
    const int32_t force = above_force > 1 - most ? above_force : 1 - most;
    if (((yaw_by | yaw | hip_by | hip | knee_by | knee) >> 31) != 0u || force + most > 5 || force > 60 ||
        force + limb->spring_exponent > -2) {
        return BRACE_E_SINGULAR;
    }
    rest->force_exponent = force;
    rest->turn_shift = at_most_31(5 - force - limb->turn_exponent);
    rest->spring_shift = at_most_31(-2 - force - limb->spring_exponent);
    in->tip_q30 = seen_from_coxa(fixed_of(x, 30 - force), fixed_of(y, 30 - force), fixed_of(z, 30 - force));
    in->down_q30 = seen_from_coxa(fixed_of(down_x, 30), fixed_of(down_y, 30), fixed_of(down_z, 30));
    const uint32_t weight_shift = at_most_31(1 + force - limb->weight_exponent);
    in->weights = (fixed_weights_t){limb->beyond_coxa_q31 >> weight_shift, limb->beyond_femur_q31 >> weight_shift,
                                    limb->femur.weight_q31 >> weight_shift, limb->tibia.weight_q31 >> weight_shift};
    const int32_t format = 26 + force + length;
    in->yields = (fixed_yields_t){limb->base_rotation_q31 >> rest->turn_shift, fixed_of(yaw_by, format),
                                  fixed_of(hip_by, format), fixed_of(knee_by, format), rest->turn_shift};
    rest->base_q26 = in->yields.base_q26;
    rest->yaw_q26 = fixed_of(yaw, format);
    rest->hip_q26 = fixed_of(hip, format);
    rest->knee_q26 = fixed_of(knee, format);
    return BRACE_OK;
}

/* --- the equilibrium ------------------------------------------------------------------------------------------ */

INLINE int64_t product_of(fixed3_t a, fixed3_t b)
{
    return fixed3_dot(fixed3_halved(a, 1), b);
}

INLINE int64_t sum_of(int64_t a, int64_t b)
{
    return (int64_t)((uint64_t)a + (uint64_t)b);
}

/* Of the links' turns; q57, as all below. */
INLINE int64_t dot_of_links(const brace_space_fixed_pose_t *a, const brace_space_fixed_pose_t *b)
{
    return sum_of(sum_of(product_of(a->coxa, b->coxa), product_of(a->femur, b->femur)),
                  product_of(a->tibia, b->tibia));
}

/* All coordinates of two poses; q25. */
INLINE int32_t dot_of_poses(const brace_space_fixed_pose_t *a, const brace_space_fixed_pose_t *b)
{
    const int64_t joints = sum_of(sum2(a->base >> 1, b->base, a->yaw >> 1, b->yaw),
                                  sum2(a->hip >> 1, b->hip, a->knee >> 1, b->knee));
    return brace_high_word(sum_of(dot_of_links(a, b), joints));
}

INLINE void add_to_link(fixed3_t *turn, fixed3_t more, int32_t by_q29, noted_t *noted)
{
    *turn = fixed3_plus_q29(*turn, more, by_q29);
    note_turned(*turn, noted);
}

INLINE void add_to_joint(int32_t *turn, int32_t more, int32_t by, noted_t *noted)
{
    *turn = plus(*turn, by_q29(more, by));
    note(noted, *turn, TURN_MOST_BITS);
}

INLINE void add_to_pose(brace_space_fixed_pose_t *pose, const brace_space_fixed_pose_t *more, int32_t by,
                        noted_t *noted)
{
    add_to_link(&pose->coxa, more->coxa, by, noted);
    add_to_link(&pose->femur, more->femur, by, noted);
    add_to_link(&pose->tibia, more->tibia, by, noted);
    add_to_joint(&pose->base, more->base, by, noted);
    add_to_joint(&pose->yaw, more->yaw, by, noted);
    add_to_joint(&pose->hip, more->hip, by, noted);
    add_to_joint(&pose->knee, more->knee, by, noted);
}

/* The whole of a series of steps, each the same multiple of the one before, without its first step, over its second;
 * q29. As in loaded_space.c that multiple is at most a half and at least -0.9. Thirteen turns of at most 1 rad have a
 * square below 16 rad^2; a limb that turns further is refused, and only has to leave the words below within theirs. */
INLINE int32_t over_second_step(int32_t second_by_first, uint32_t first2)
{
    const uint32_t size = (first2 < SQUARE_MOST_Q25 ? first2 : SQUARE_MOST_Q25) | 1u;
    const int32_t apart = less((int32_t)size, second_by_first), least = (int32_t)(size - (size >> 1));
    const int32_t most = (int32_t)(size + size - size / 10u);
    const uint32_t limited = (uint32_t)(apart < least ? least : apart > most ? most : apart);
    const uint32_t zeros = leading_zeros(limited) - 2u;
    return (int32_t)(((size << zeros) / ((limited << zeros) >> 15)) << 14);
}

INLINE void see_straight(const fixed_weights_t *weights, fixed3_t tip, fixed3_t down, fixed3_t whole,
                         const fixed_commanded_t *commanded, fixed_forces_t at[3])
{
    const fixed_vec_t hip = fixed_back(commanded->hip), knee = fixed_back(commanded->knee);
    const fixed3_t femur = fixed_about_z(tip, hip), femur_down = fixed_about_z(down, hip);
    const fixed3_t tibia = fixed_about_z(femur, knee), tibia_down = fixed_about_z(femur_down, knee);
    at[0] = (fixed_forces_t){whole, {0, 0, 0}};
    at[1] = (fixed_forces_t){fixed3_plus_q30(femur, femur_down, weights->beyond_femur_q30),
                             fixed3_scaled_q30(femur_down, weights->femur_q30)};
    at[2] = (fixed_forces_t){tibia, fixed3_scaled_q30(tibia_down, weights->tibia_q30)};
}

INLINE void bend_to(const brace_loaded_space_fixed_t *limb, const fixed_inputs3_t *in, fixed_rest3_t *rest,
                    fixed_curls_t *curls, bool is_driven, brace_space_fixed_pose_t *drives, noted_t *noted)
{
    fixed_turns_of(rest, *curls, &rest->turns, noted);
    fixed_see_forces(&in->weights, in->tip_q30, in->down_q30, rest);
    fixed_bend_limb(limb, rest, curls, is_driven, drives, noted);
}

/* As in loaded_space.c: second^4 is at most so much of first^2 + second^2. */
INLINE bool is_settled(uint32_t first2_q25, uint32_t second2_q25)
{
    return (uint64_t)second2_q25 * second2_q25 * 2u <= (uint64_t)LEFT_MOST_Q26 * ((uint64_t)first2_q25 + second2_q25);
}

/* Two steps with the matrix of the straight limb, the second of them prolonged. Then the bent limb.
 * returns whether they have settled */
INLINE bool find_rest(const brace_loaded_space_fixed_t *limb, const fixed_inputs3_t *in, fixed_rest3_t *rest,
                      noted_t *noted)
{
    static const brace_space_fixed_pose_t straight;
    const fixed_commanded_t commanded = {fixed_direction(rest->theta1_turn), fixed_direction(0u - rest->theta2_turn)};
    fixed_forces_t at[3];
    fixed_factors_t factors;
    brace_space_fixed_pose_t drives, step;
    fixed_curls_t curls = {0, 0};
    see_straight(&in->weights, in->tip_q30, in->down_q30, rest->whole_q30, &commanded, at);
    fixed_straight_limb(limb, at, &commanded, &in->yields, rest->whole_q30, &factors, &drives, noted);
    fixed_solve_straight(&factors, &drives, &straight, &commanded, &rest->pose, noted);
    bend_to(limb, in, rest, &curls, true, &drives, noted);
    fixed_solve_straight(&factors, &drives, &rest->pose, &commanded, &step, noted);
    const int32_t first2 = dot_of_poses(&rest->pose, &rest->pose), second2 = dot_of_poses(&step, &step);
    add_to_pose(&rest->pose, &step, over_second_step(dot_of_poses(&step, &rest->pose), (uint32_t)first2), noted);
    bend_to(limb, in, rest, &curls, false, &drives, noted);
    return is_settled((uint32_t)first2, (uint32_t)second2);
}

INLINE bool is_within(int32_t turn_q29, int32_t limit_q29)
{
    return turn_q29 <= limit_q29 && turn_q29 >= -limit_q29;
}

static bool is_near(const brace_space_fixed_pose_t *pose)
{
    const uint32_t links_q25 = (uint32_t)brace_high_word(dot_of_links(pose, pose));
    const uint32_t base_q25 = (uint32_t)brace_high_word(sum2(pose->base >> 1, pose->base, pose->yaw >> 1, pose->yaw));
    return 2u * links_q25 <= LINKS_Q26 && 2u * base_q25 <= SMALL_TURN_Q26 &&
           is_within(turned_at_joint(pose->coxa, pose->hip, pose->femur), JOINT_TURN_Q29) &&
           is_within(turned_at_joint(pose->femur, pose->knee, pose->tibia), JOINT_TURN_Q29);
}

brace_status_t brace_loaded_space_fixed_settle(const brace_loaded_space_fixed_t *fixed, float theta1_rad,
                                               float theta2_rad, const brace_space_load_t *load,
                                               brace_space_fixed_rest_t *rest)
{
    fixed_inputs3_t in;
    const brace_status_t refused = inputs_of(fixed, theta1_rad, theta2_rad, load, &in, rest);
    if (refused != BRACE_OK) {
        return refused;
    }
    noted_t noted = 0u;
    rest->whole_q30 = fixed3_plus_q30(in.tip_q30, in.down_q30, in.weights.beyond_coxa_q30);
    const bool has_settled = find_rest(fixed, &in, rest, &noted);
    return has_settled && !is_refused(noted) && is_near(&rest->pose) ? BRACE_OK : BRACE_E_SINGULAR;
}

/* --- K -------------------------------------------------------------------------------------------------------- */

/* How far the tip has moved from where the commanded limb has it. */
static fixed3_t moved(const brace_loaded_space_fixed_t *limb, const fixed_rest3_t *rest, fixed3_t tip_q28)
{
    const fixed_vec_t femur = fixed_direction(rest->theta1_turn);
    const fixed_vec_t tibia = fixed_direction(rest->theta1_turn - rest->theta2_turn);
    const int32_t femur_q28 = limb->femur.length_q28, tibia_q28 = limb->tibia.length_q28;
    const int32_t base_x = high_of(limb->base_x_q31 >> rest->spring_shift, rest->whole_q30.x) >> 3;
    const int32_t base_z = high_of(limb->base_z_q31 >> rest->spring_shift, rest->whole_q30.y) >> 3;
    return fixed3(plus(less(tip_q28.x, shifted(sum2(femur_q28, femur.x, tibia_q28, tibia.x), 30)), base_x),
                  plus(less(tip_q28.y, shifted(sum2(femur_q28, femur.z, tibia_q28, tibia.z), 30)), base_z), tip_q28.z);
}

/* An angle q29. */
INLINE float rad_of(int32_t angle)
{
    return float_from(angle, 29);
}

brace_status_t brace_loaded_space_fixed_stiffness(const brace_loaded_space_fixed_t *fixed,
                                                  const brace_space_fixed_rest_t *rest, brace_space_result_t *result)
{
    noted_t noted = 0u;
    fixed_freedoms_t free;
    fixed_frames_t frames;
    fixed_sum_t sum;
    brace_k3_t k;
    fixed_eliminate_limb(fixed, rest, NULL, &free, &noted);
    if (is_refused(noted)) {
        return BRACE_E_SINGULAR;
    }
    fixed_frames_of(&rest->turns, &frames);
    fixed_sum_limb(fixed, rest, &free, &frames, &sum, &noted);
    if (is_refused(noted) || !fixed_inverse3(&sum.c, rest->force_exponent - fixed->length_exponent, &k)) {
        return BRACE_E_SINGULAR;
    }
    result->k = (brace_k3_t){k.xx_n_per_mm, -k.xz_n_per_mm, k.xy_n_per_mm,
                             k.zz_n_per_mm, -k.yz_n_per_mm, k.yy_n_per_mm};
    result->displacement_mm = seen_from_plane(moved(fixed, rest, sum.tip_q28), fixed->length_exponent);
    result->tibia_mm = seen_from_plane(sum.tibia_q28, fixed->length_exponent);
    result->yaw_turn_rad = rad_of(rest->pose.yaw);
    result->hip_turn_rad = rad_of(rest->pose.hip);
    result->knee_turn_rad = rad_of(rest->pose.knee);
    return BRACE_OK;
}
