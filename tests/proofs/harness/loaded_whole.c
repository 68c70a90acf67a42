/* K under load in fixed point from its inputs to what is told: each part promises what its own proof says, and the next
 * one is given what it takes. A vector is known by its parts and by its length, a product by its factors' sizes. */
#include "proof.h"
#include "loaded_sizes.h"

/* How long a vector is at most; 0: no longer than its parts together. */
#define BRACE_FIXED_VEC_H
typedef struct {
    int32_t x, z;
    int64_t most;
} brace_fixed_vec_t;
typedef struct {
    int32_t x, y, z;
} brace_fixed_vec3_t;

#include "loaded/fixed_solve.h"
#include "loaded/fixed_units.h"

#include "fixed/fixed_table.c"

typedef __int128 wide_t;

static int64_t size_of(int32_t number)
{
    return number < 0 ? -(int64_t)number : number;
}

static int32_t any_within(int64_t most)
{
    const int32_t any = any_i32();
    PROVE(most < 1LL << 31, "it fits its word");
    ASSUME(any <= most && any >= -most);
    return any;
}

static int32_t any_not_below_0(void)
{
    return any_i32() & INT32_MAX;
}

static fixed_vec_t any_vector(int64_t most)
{
    return (fixed_vec_t){any_within(most), any_within(most), most};
}

/* --- the limb, as it has passed the last look (loaded_collapse), and its inputs (loaded_inputs) ------------------ */

static brace_loaded_fixed_t limb_seen;
static uint32_t root_shift;

static bool is_root(fixed_vec_t v, const fixed_vec_t root[2])
{
    return (v.x == root[0].x >> root_shift && v.z == root[0].z >> root_shift) ||
           (v.x == root[1].x >> root_shift && v.z == root[1].z >> root_shift);
}

/* A spring's vector is one of the limb's, shifted. Any other one that the text puts together is no longer than its
 * parts. */
static int64_t length_of(fixed_vec_t v)
{
    if (v.most != 0) {
        return v.most;
    }
    const brace_loaded_fixed_link_t *femur = &limb_seen.femur, *tibia = &limb_seen.tibia;
    const bool is_spring = is_root(v, femur->root_root_q31) || is_root(v, femur->end_root_q31) ||
                           is_root(v, tibia->root_root_q31) || is_root(v, tibia->end_root_q31) ||
                           is_root(v, limb_seen.base_root_q31);
    return is_spring ? (UNIT_ROOT_MOST_Q31 >> 2) + 2 : size_of(v.x) + size_of(v.z);
}

static void any_seen(brace_loaded_fixed_link_t *link)
{
    const int64_t length = link->length_q28;
    ASSUME(length >= 0 && link->bend_q31 >= 0 && link->end_q31 >= 0);
    link->beam_q28 = any_vector(length + UNIT_OFF_Q28);
    link->to_beam_q28 = any_vector(((length * UNIT_ROOT_OF_TWO_Q15) >> 15) + UNIT_OFF_Q28);
}

static void any_limb(brace_loaded_fixed_t *limb)
{
    ASSUME(unit_are_exponents(limb) && unit_are_weights(limb) && limb->base_q31 >= 0 && limb->base_rotation_q31 >= 0);
    ASSUME((int64_t)limb->femur.length_q28 + limb->tibia.length_q28 <= UNIT_REACH_MOST_Q28);
    ASSUME(limb->femur.length_q28 >= 0 && limb->tibia.length_q28 >= 0);
    any_seen(&limb->femur);
    any_seen(&limb->tibia);
    limb_seen = *limb;
}

/* --- products, and vectors --------------------------------------------------------------------------------------- */

#define ROUNDED 8

static uint32_t bits_in(uint32_t word)
{
    return word == 0u ? 0u : 32u - (uint32_t)__builtin_clz(word);
}

static int32_t any_times(int32_t a, int32_t b, int bits)
{
    if (bits == 30 && size_of(b) <= DIRECTION_MOST) {
        return any_within(size_of(a) + 2);
    }
    const int32_t in = (int32_t)(bits_in(magnitude_of(a)) + bits_in(magnitude_of(b))) - bits;
    PROVE(in < 31, "a product fits its word");
    return any_within(1LL << (in < 0 ? 0 : in));
}

static fixed_vec_t sum_of(fixed_vec_t a, fixed_vec_t b)
{
    const fixed_vec_t sum = {a.x + b.x, a.z + b.z, length_of(a) + length_of(b)};
    ASSUME(size_of(sum.x) <= sum.most && size_of(sum.z) <= sum.most);
    return sum;
}

static fixed_vec_t difference_of(fixed_vec_t a, fixed_vec_t b)
{
    const fixed_vec_t difference = {a.x - b.x, a.z - b.z, length_of(a) + length_of(b)};
    ASSUME(size_of(difference.x) <= difference.most && size_of(difference.z) <= difference.most);
    return difference;
}

static fixed_vec_t turned_of(fixed_vec_t v, fixed_vec_t by)
{
    PROVE(by.most == DIRECTION_MOST, "a direction");
    return any_vector((length_of(v) * DIRECTION_MOST >> 30) + ROUNDED);
}

/* A weight along its direction, or a spring's vector times what it gives. */
static fixed_vec_t scaled_of(fixed_vec_t v, int32_t by, int bits)
{
    if (bits == 30) {
        PROVE(by >= 0 && length_of(v) <= ((int64_t)DOWN_MOST_64THS << 24) + 16, "a weight");
        return any_vector(((int64_t)by * DOWN_MOST_64THS >> 6) + ROUNDED);
    }
    PROVE(bits == 32 && size_of(by) <= SPRING_GIVES_MOST && length_of(v) <= SPRING_MOST, "a spring");
    return any_vector((SPRING_MOST * (SPRING_GIVES_MOST) >> bits) + ROUNDED);
}

static fixed_vec_t sum2_of(fixed_vec_t a, int32_t by, fixed_vec_t b, int32_t to, int bits)
{
    PROVE(by >= 0 && by <= END_MOST && size_of(to) <= SPRING_GIVES_MOST && length_of(b) <= SPRING_MOST, "the base");
    return any_vector(((length_of(a) * END_MOST + SPRING_MOST * (SPRING_GIVES_MOST)) >> bits) + ROUNDED);
}

/* What a force presses a spring with. */
static int32_t dot_of(fixed_vec_t a, fixed_vec_t b, int bits)
{
    PROVE(bits == 30 && length_of(a) <= SPRING_MOST && length_of(b) <= FORCE_MOST, "a spring and a force");
    return any_within(SPRING_MOST * FORCE_MOST >> 30);
}

#define fixed_plus sum_of
#define fixed_minus difference_of
#define fixed_turned turned_of
#define fixed_turned_back turned_of
#define fixed_scaled scaled_of
#define fixed_sum2 sum2_of
#define fixed_dot dot_of
#define fixed_direction(turn) any_vector(DIRECTION_MOST)
#define times any_times
#include "loaded/fixed_inputs.h"
#undef times
#undef fixed_scaled
#include "loaded/fixed_compliance.h"
#include "loaded/fixed_buckling.h"
#define times any_times
#define fixed_scaled scaled_of

static brace_status_t any_inputs(const brace_loaded_fixed_t *limb, float theta1_rad, float theta2_rad,
                                 const brace_load_t *load, fixed_inputs_t *in)
{
    (void)theta1_rad, (void)theta2_rad, (void)load;
    if (any_bool()) {
        return BRACE_E_SINGULAR;
    }
    fixed_inputs_t any;
    *in = any;
    ASSUME(in->hip >= 0 && in->hip_yields >= 0 && in->knee >= 0 && in->knee_yields >= 0);
    ASSUME(in->bend_shift >= 1u && in->bend_shift <= 31u && in->spring_shift >= 3u && in->spring_shift <= 31u);
    ASSUME(in->root_shift >= 2u && in->root_shift <= 31u && in->parity <= 1u);
    ASSUME(in->weight_shift >= 1u && in->weight_shift <= 31u);
    ASSUME(in->force_exponent >= FORCE_EXPONENT_LEAST && in->force_exponent <= FORCE_EXPONENT_MOST);
    root_shift = in->root_shift;
    in->tip_q30.most = size_of(in->tip_q30.x) + size_of(in->tip_q30.z);
    const int64_t weight = limb->weight_q31 >> in->weight_shift;
    ASSUME(in->tip_q30.most + weight * DOWN_MOST_64THS / 64 <= FORCE_UNIT);
    ASSUME(is_within(in->down_q30.x, DOWN_MOST_Q30) && is_within(in->down_q30.z, DOWN_MOST_Q30));
    in->down_q30.most = (int64_t)DOWN_MOST_64THS << 24;
    return BRACE_OK;
}

/* --- the parts --------------------------------------------------------------------------------------------------- */

static void is_link(const fixed_link_t *link)
{
    PROVE(length_of(link->to_beam) <= TO_BEAM_MOST && length_of(link->beam) <= BEAM_MOST, "a link's way");
    PROVE(length_of(link->rigid) <= RIGID_MOST, "and with its spring");
    PROVE(length_of(link->root_root) <= SPRING_MOST && length_of(link->end_root) <= SPRING_MOST, "its springs");
    PROVE(link->end_q30 >= 0 && link->end_q30 <= END_MOST && link->bend >= 0, "its compliances");
    PROVE(length_of(link->beyond) + length_of(link->own) <= FORCE_MOST, "its forces together");
}

static bool any_step(fixed_limb_t *limb, bool is_first, int32_t hip, int32_t knee)
{
    (void)is_first;
    is_link(&limb->femur);
    is_link(&limb->tibia);
    PROVE(hip >= 0 && knee >= 0, "joints' compliances");
    limb->femur_shape = (fixed_shape_t){any_within(ROOT_ANGLE_MOST), any_within(CURVATURE_MOST), any_within(CURVATURE_MOST)};
    limb->tibia_shape = (fixed_shape_t){any_within(ROOT_ANGLE_MOST), any_within(CURVATURE_MOST), any_within(CURVATURE_MOST)};
    return any_bool();
}

static void any_rest_of(const fixed_link_t *link, const fixed_shape_t *shape, fixed_rest_t *rest)
{
    PROVE(size_of(shape->root) <= ROOT_ANGLE_MOST, "the root's angle");
    PROVE(size_of(shape->a) <= CURVATURE_MOST && size_of(shape->b) <= CURVATURE_MOST, "curvatures");
    const bool is_short = length_of(link->beam) <= HALF_BEAM_MOST && length_of(link->to_beam) <= HALF_TO_BEAM_MOST;
    rest->tip = any_vector(is_short ? HALF_TIP_MOST : TIP_MOST), rest->aside = any_vector(ASIDE_MOST);
    rest->a = any_vector(LEVER_MOST), rest->b = any_vector(LEVER_MOST), rest->end = any_vector(LEVER_MOST);
}

static bool any_pivots_of(const fixed_stance_t *limb, fixed_pivots_t *p)
{
    PROVE(limb->femur_bend >= 0 && limb->tibia_bend >= 0 && limb->hip >= 0 && limb->knee >= 0, "compliances");
    ASSUME(p->per_hip > 0 && p->per_knee > 0);
    return any_bool();
}

static fixed_wide_t any_product(const fixed_pivots_t *p)
{
    (void)p;
    const fixed_wide_t product = {any_not_below_0(), any_i32()};
    ASSUME(product.mantissa_q31 >= 1 << 30 && size_of(product.exponent) <= 64);
    return product;
}

/* --- C (loaded_levers) ------------------------------------------------------------------------------------------- */

/* Off the diagonal, of C and of its springs, in words of any size. */
static wide_t off_lever, off_spring;

static void add_terms(fixed_tensor_t *c, wide_t *off, uint64_t most, int64_t rounded)
{
    const uint64_t xx = any_u64(), zz = any_u64();
    const int64_t xz = any_i64();
    ASSUME(xx <= most && zz <= most && xz <= (int64_t)most && xz >= -(int64_t)most);
    ASSUME(2 * (wide_t)xz <= (wide_t)xx + zz + rounded && -2 * (wide_t)xz <= (wide_t)xx + zz + rounded);
    PROVE(c->xx <= UINT64_MAX - xx && c->zz <= UINT64_MAX - zz, "no entry of the diagonal wraps");
    c->xx += xx, c->zz += zz, c->xz += (uint64_t)xz;
    *off += xz;
}

static void any_scaled_added(fixed_tensor_t *c, fixed_vec_t v, int32_t by, bool is_lost)
{
    (void)v;
    PROVE(by >= 0 || is_lost, "a yield");
    add_terms(c, &off_lever, 1ull << 62, 1LL << 33);
}

static void any_spring_added(fixed_tensor_t *c, fixed_vec_t v)
{
    PROVE(length_of(v) <= SPRING_GIVES_MOST, "a spring");
    add_terms(c, &off_spring, 1ull << 60, 0);
}

static fixed_vec_t any_link_added(fixed_tensor_t *c, fixed_tensor_t *springs, const fixed_rest_t *rest,
                                  const fixed_factors_t *f, fixed_vec_t beyond, lost_t *lost)
{
    (void)rest, (void)f;
    PROVE(size_of(beyond.x) <= BEYOND_MOST && size_of(beyond.z) <= BEYOND_MOST, "what is beyond the link");
    add_terms(c, &off_lever, 1ull << 62, 1LL << 33);
    add_terms(c, &off_lever, 1ull << 62, 1LL << 33);
    add_terms(springs, &off_spring, 1ull << 60, 0);
    add_terms(springs, &off_spring, 1ull << 60, 0);
    *lost |= any_u32();
    return (fixed_vec_t){any_i32(), any_i32()};
}

static brace_status_t stiffness_fits(const fixed_tensor_t *c, uint32_t theta1_turn, int32_t exponent,
                                     brace_stiffness_t *stiffness)
{
    (void)theta1_turn, (void)stiffness;
    PROVE(c->xx <= C_MOST && c->zz <= C_MOST, "C's diagonal");
    const int64_t half = (int64_t)((c->xx + c->zz) / 2u) + C_ROUNDED, xz = (int64_t)c->xz;
    PROVE(xz <= half && xz >= -half, "and off it");
    PROVE(xz == off_lever + (off_spring >> 6), "which has not wrapped");
    PROVE(exponent >= FORCE_EXPONENT_LEAST - UNIT_LENGTH_EXPONENT_MOST && exponent <= FORCE_EXPONENT_MOST - 1, "units");
    return any_bool() ? BRACE_OK : BRACE_E_SINGULAR;
}

static float any_factor(const fixed_stance_t *stance, fixed_wide_t now)
{
    (void)stance, (void)now;
    return any_float();
}

/* A product of a compliance and one over a pivot is not negative; of a lever it is any. */
static int32_t any_kept(bool is_not_negative, int bits, int room, lost_t *lost)
{
    const int64_t sum = any_i64();
    ASSUME(!is_not_negative || sum >= 0);
    const int32_t number = kept(sum, bits, room, lost);
    ASSUME(*lost >= LOST || number == sum >> bits); /* loaded_levers, loaded_solve */
    return number;
}

#define IS_COMPLIANCE(text) ((text)[9] == 'i' && (text)[10] == 'n') /* (int64_t)in.knee * p.per_knee */
#define kept(sum, bits, room, lost) any_kept(IS_COMPLIANCE(#sum), bits, room, lost)
#define inputs_of any_inputs
#define fixed_step any_step
#define fixed_rest_of any_rest_of
#define fixed_pivots_of any_pivots_of
#define fixed_product any_product
#define add_scaled(c, v, by) add_scaled_once(c, v, by, &lost)
#define add_spring any_spring_added
#define add_link any_link_added
#define stiffness_of stiffness_fits
#define fixed_buckling_factor any_factor

static void add_scaled_once(fixed_tensor_t *c, fixed_vec_t v, int32_t by, const lost_t *lost)
{
    any_scaled_added(c, v, by, *lost >= LOST);
}

#include "loaded/loaded_fixed.c"

int main(void)
{
    brace_loaded_fixed_t limb;
    brace_load_t load;
    brace_loaded_stiffness_t result;
    any_limb(&limb);
    (void)brace_loaded_fixed_stiffness(&limb, any_float(), any_float(), &load, &result);
    return 0;
}
