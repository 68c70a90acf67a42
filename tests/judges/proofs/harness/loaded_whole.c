/* K under load in fixed point, from inputs to answer. Each part has its own proof: here it may answer whatever that
 * proof allows, and the next part must accept it. A vector is known by its parts and length, a product by sizes. */
#include "proof.h"
#include "loaded_sizes.h"

/* loaded_seen looks as far as the links alone; here the links are as it says. */
#ifdef SEEN_ONLY
#define IF_SEEN_ONLY(statement) statement
#else
#define IF_SEEN_ONLY(statement)
#endif

/* How long a vector is at most; 0: no longer than its parts together. Of a force: what it is the sum of. */
#define BRACE_FIXED_VEC_H
enum { TIP = 1, KNEE_WEIGHT = 2, FEMUR_WEIGHT = 4, TIBIA_WEIGHT = 8, WHOLE_WEIGHT = 16 };
typedef struct {
    int32_t x, z;
    int64_t most;
    int forces;
} brace_fixed_vec_t;
typedef struct {
    int32_t x, y, z;
} brace_fixed_vec3_t;

#include "loaded/fixed_solve.h"
#include "loaded/fixed_units.h"

#include "fixed/fixed_table.c"

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
    return (fixed_vec_t){any_within(most), any_within(most), most, 0};
}

static fixed_vec_t any_force(int forces)
{
    fixed_vec_t force = any_vector(FORCE_MOST);
    force.forces = forces;
    return force;
}

/* --- the limb, as it has passed the last look (loaded_collapse), and its inputs (loaded_inputs) ------------------ */

/* A vector that the text puts together is no longer than its parts. */
static int64_t length_of(fixed_vec_t v)
{
    return v.most != 0 ? v.most : size_of(v.x) + size_of(v.z);
}

/* One of the two links at least is half of the reach at most. */
#define HALF_MOST (UNIT_REACH_MOST_Q28 / 2)
#define TILTED(length) ((length)*UNIT_ROOT_OF_TWO_Q15 >> 15)

static bool is_femur_short;
static brace_loaded_fixed_t limb;

static void any_seen(brace_loaded_fixed_link_t *link, bool is_short)
{
    const int64_t most = is_short ? HALF_MOST : UNIT_REACH_MOST_Q28;
    ASSUME(link->bend_q31 >= 0 && link->end_q31 >= 0 && link->length_q28 >= 0 && link->length_q28 <= most);
    link->beam_q28 = any_vector(most + UNIT_OFF_Q28), link->to_beam_q28 = any_vector(TILTED(most) + UNIT_OFF_Q28);
}

static void any_limb(void)
{
    brace_loaded_fixed_t any;
    limb = any;
    ASSUME(unit_are_exponents(&limb) && limb.base_q31 >= 0 && limb.base_rotation_q31 >= 0);
    ASSUME(limb.weight_q31 >= 0 && limb.knee_q31 >= 0 && limb.femur.weight_q31 >= 0 && limb.tibia.weight_q31 >= 0);
    any_seen(&limb.femur, is_femur_short);
    any_seen(&limb.tibia, !is_femur_short);
    ASSUME((int64_t)limb.femur.length_q28 + limb.tibia.length_q28 <= UNIT_REACH_MOST_Q28);
}

/* Forces whose lengths together are below FORCE_MOST. Of the tip's force and the whole weight, 91/64 times its number,
 * loaded_inputs says that they are below the unit; the last look says that knee and femur make the whole within 256,
 * which the unit's shift halves at least, and that the tibia's is in the knee's. So together they are no more than the
 * unit, 129 91/64 and, turned, scaled and rounded three times, 32 more. */
static bool are_within_unit(int forces)
{
    return (forces & ~(TIP | WHOLE_WEIGHT)) == 0 || (forces & ~(TIP | KNEE_WEIGHT | FEMUR_WEIGHT)) == 0 ||
           (forces & ~(TIP | TIBIA_WEIGHT)) == 0;
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
    const int forces = a.forces | b.forces;
    PROVE((a.forces & b.forces) == 0 && (a.forces == 0) == (b.forces == 0) && are_within_unit(forces),
          "forces together");
    ASSUME(forces == 0 || (size_of(a.x) + size_of(b.x) <= FORCE_MOST && size_of(a.z) + size_of(b.z) <= FORCE_MOST));
    const fixed_vec_t sum = {a.x + b.x, a.z + b.z, forces != 0 ? FORCE_MOST : length_of(a) + length_of(b), forces};
    ASSUME(size_of(sum.x) <= sum.most && size_of(sum.z) <= sum.most);
    return sum;
}

static fixed_vec_t difference_of(fixed_vec_t a, fixed_vec_t b)
{
    const fixed_vec_t difference = {a.x - b.x, a.z - b.z, length_of(a) + length_of(b), 0};
    ASSUME(size_of(difference.x) <= difference.most && size_of(difference.z) <= difference.most);
    return difference;
}

static fixed_vec_t turned_of(fixed_vec_t v, fixed_vec_t by)
{
    PROVE(by.most == (1LL << 30) + 2 && length_of(v) < 1LL << 31, "a direction");
    return v.forces != 0 ? any_force(v.forces) : any_vector(length_of(v) + 4 + ROUNDED);
}

/* One of the limb's springs, in its unit. */
static fixed_vec_t spring_of(fixed_vec_t v, uint32_t bits)
{
    (void)v;
    PROVE(bits >= 2u && bits <= 31u, "by a quarter of its square or less");
    return any_vector((UNIT_ROOT_MOST_Q31 >> 2) + 2);
}

#define PRESSED_MOST (SPRING_MOST * FORCE_MOST >> 30)

/* A weight along its direction, or a spring's vector times what it gives. */
static uint32_t weight_shift;
static int weight_count;

static int weight_of(int32_t by)
{
    static const int forces[] = {KNEE_WEIGHT, FEMUR_WEIGHT, TIBIA_WEIGHT, WHOLE_WEIGHT, WHOLE_WEIGHT};
    const int32_t weights[] = {limb.knee_q31, limb.femur.weight_q31, limb.tibia.weight_q31, limb.weight_q31,
                               limb.weight_q31};
    PROVE(weight_count < 5 && by == weights[weight_count] >> weight_shift, "a weight in its unit");
    return forces[weight_count++];
}

static fixed_vec_t scaled_of(fixed_vec_t v, int32_t by, int bits)
{
    if (bits == 30) {
        PROVE(length_of(v) <= ((int64_t)DOWN_MOST_64THS << 24) + 16, "the weight's direction");
        return any_force(weight_of(by));
    }
    PROVE(bits == 32 && size_of(by) <= PRESSED_MOST && length_of(v) <= SPRING_MOST, "a spring");
    return any_vector((SPRING_MOST * PRESSED_MOST >> bits) + ROUNDED);
}

static fixed_vec_t sum2_of(fixed_vec_t a, int32_t by, fixed_vec_t b, int32_t to, int bits)
{
    PROVE(by >= 0 && by <= END_MOST && size_of(to) <= PRESSED_MOST && length_of(b) <= SPRING_MOST, "the base");
    return any_vector(((length_of(a) * END_MOST + SPRING_MOST * PRESSED_MOST) >> bits) + ROUNDED);
}

/* What a force presses a spring with. */
static int32_t dot_of(fixed_vec_t a, fixed_vec_t b, int bits)
{
    PROVE(bits == 30 && length_of(a) <= SPRING_MOST && length_of(b) <= FORCE_MOST, "a spring and a force");
    return any_within(PRESSED_MOST);
}

#define fixed_plus sum_of
#define fixed_minus difference_of
#define fixed_turned turned_of
#define fixed_turned_back turned_of
#define fixed_scaled scaled_of
#define fixed_sum2 sum2_of
#define fixed_dot dot_of
#define fixed_right spring_of
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
    (void)limb, (void)theta1_rad, (void)theta2_rad, (void)load;
    if (any_bool()) {
        return BRACE_E_SINGULAR;
    }
    fixed_inputs_t any;
    *in = any;
    ASSUME(in->hip >= 0 && in->hip_yields >= 0 && in->knee >= 0 && in->knee_yields >= 0);
    ASSUME(in->bend_shift <= 31u && in->spring_shift >= 3u && in->spring_shift <= 31u);
    ASSUME(in->root_shift >= 2u && in->root_shift <= 31u && in->parity <= 1u);
    ASSUME(in->weight_shift >= 1u && in->weight_shift <= 31u && (in->coarser == 0u || in->coarser == 2u));
    ASSUME(in->force_exponent >= FORCE_EXPONENT_LEAST && in->force_exponent <= FORCE_EXPONENT_MOST);
    in->tip_q30 = any_force(TIP);
    weight_shift = in->weight_shift, weight_count = 0;
    ASSUME(is_within(in->down_q30.x, DOWN_MOST_Q30) && is_within(in->down_q30.z, DOWN_MOST_Q30));
    in->down_q30.most = (int64_t)DOWN_MOST_64THS << 24, in->down_q30.forces = 0;
    return BRACE_OK;
}

/* --- the parts --------------------------------------------------------------------------------------------------- */

static void is_link(const fixed_link_t *link, bool is_femur)
{
    const bool is_short = is_femur == is_femur_short;
    PROVE(length_of(link->to_beam) <= (is_short ? HALF_TO_BEAM_MOST : TO_BEAM_MOST), "the way to a link's beam");
    PROVE(length_of(link->beam) <= (is_short ? HALF_BEAM_MOST : BEAM_MOST), "its beam");
    PROVE(length_of(link->rigid) <= RIGID_MOST, "and with its spring");
    PROVE(length_of(link->root_root) <= SPRING_MOST && length_of(link->end_root) <= SPRING_MOST, "its springs");
    PROVE(link->end_q30 >= 0 && link->end_q30 <= END_MOST && link->bend >= 0, "its compliances");
    PROVE(link->beyond.forces == (is_femur ? TIP | KNEE_WEIGHT : TIP), "the force beyond it");
    PROVE(link->own.forces == (is_femur ? FEMUR_WEIGHT : TIBIA_WEIGHT), "its own");
}

/* A shape that a step leads to and may begin from (loaded_solve). */
static bool is_shape_in_range(const fixed_shape_t *shape)
{
    return IS_SHAPE(size_of(shape->root), size_of(shape->a), size_of(shape->b));
}

static void any_shape(fixed_shape_t *shape)
{
    *shape = (fixed_shape_t){any_within(ROOT_ANGLE_MOST), any_within(CURVATURE_MOST), any_within(CURVATURE_MOST)};
    ASSUME(is_shape_in_range(shape));
}

/* Where the step is refused, one of the two links may stand where it leads. */
static bool any_step(fixed_limb_t *limb, bool is_first, int32_t hip, int32_t knee, int32_t *turned_q27)
{
    IF_SEEN_ONLY(is_link(&limb->femur, true));
    IF_SEEN_ONLY(is_link(&limb->tibia, false));
    PROVE(hip >= 0 && knee >= 0, "joints' compliances");
    PROVE(is_first || (is_shape_in_range(&limb->femur_shape) && is_shape_in_range(&limb->tibia_shape)), "shapes");
    any_shape(&limb->femur_shape);
    any_shape(&limb->tibia_shape);
    *turned_q27 = any_not_below_0();
    IF_SEEN_ONLY(ASSUME(false));
    return any_bool();
}

/* What a part takes, which any_step has looked at (loaded_seen). */
static fixed_link_t any_link(const brace_loaded_fixed_link_t *link, const fixed_inputs_t *in, const fixed_vec_t *turned,
                             fixed_vec_t beyond, fixed_vec_t down)
{
    (void)link, (void)in, (void)beyond, (void)down;
    const bool is_short = (turned == NULL) == is_femur_short;
    fixed_link_t seen;
    weight_count++; /* its own */
    ASSUME(seen.end_q30 >= 0 && seen.end_q30 <= END_MOST && seen.bend >= 0);
    seen.beam = any_vector(is_short ? HALF_BEAM_MOST : BEAM_MOST);
    seen.to_beam = any_vector(is_short ? HALF_TO_BEAM_MOST : TO_BEAM_MOST);
    return seen;
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

/* Off the diagonal the words may wrap on the way; what they come to is no more than half of the trace, by Cauchy's
 * inequality for each term, and their rounding. */
static void add_terms(fixed_tensor_t *c, uint64_t most)
{
    const uint64_t xx = any_u64(), zz = any_u64();
    ASSUME(xx <= most && zz <= most);
    PROVE(c->xx <= UINT64_MAX - xx && c->zz <= UINT64_MAX - zz, "no entry of the diagonal wraps");
    c->xx += xx, c->zz += zz, c->xz = any_u64();
}

static void any_scaled_added(fixed_tensor_t *c, fixed_vec_t v, int32_t by, bool is_lost)
{
    (void)v;
    PROVE(by >= 0 || is_lost, "a yield");
    add_terms(c, 1ull << 62);
}

static void any_spring_added(fixed_tensor_t *c, fixed_vec_t v)
{
    PROVE(length_of(v) <= SPRING_GIVES_MOST, "a spring");
    add_terms(c, 1ull << 60);
}

static fixed_vec_t any_link_added(fixed_tensor_t *c, fixed_tensor_t *springs, const fixed_rest_t *rest,
                                  const fixed_factors_t *f, uint32_t coarser, fixed_vec_t beyond, lost_t *lost)
{
    (void)rest, (void)f;
    PROVE(coarser <= 2u, "yields keep their words");
    PROVE(size_of(beyond.x) <= BEYOND_MOST && size_of(beyond.z) <= BEYOND_MOST, "what is beyond the link");
    add_terms(c, 1ull << 62);
    add_terms(c, 1ull << 62);
    add_terms(springs, 1ull << 60);
    add_terms(springs, 1ull << 60);
    *lost |= any_u32();
    return (fixed_vec_t){any_i32(), any_i32()};
}

static brace_status_t stiffness_fits(const fixed_tensor_t *c, uint32_t theta1_turn, int32_t exponent,
                                     brace_stiffness_t *stiffness)
{
    (void)theta1_turn, (void)stiffness;
    PROVE(c->xx <= C_MOST && c->zz <= C_MOST, "C's diagonal");
    PROVE(exponent >= FORCE_EXPONENT_LEAST - 22 && exponent <= FORCE_EXPONENT_MOST - 1, "units"); /* loaded_levers */
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

#define IS_COMPLIANCE(text) ((text)[10] == 'i' && (text)[11] == 'n') /* (int64_t)(in.knee >> in.coarser) * p.per_knee */
#define kept(sum, bits, room, lost) any_kept(IS_COMPLIANCE(#sum), bits, room, lost)
#define inputs_of any_inputs
#define fixed_bounded_step any_step
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

#ifndef SEEN_ONLY
#define link_seen any_link
#endif
#include "loaded/loaded_fixed.c"

/* A place as a tick has left it: brace_loaded_fixed_follow promises it of every place that it writes. */
static bool is_place(const brace_loaded_fixed_place_t *place)
{
    return is_shape_in_range(&place->femur_shape) && is_shape_in_range(&place->tibia_shape) &&
           size_of(place->on_base_q30.x) <= FORCE_MOST && size_of(place->on_base_q30.z) <= FORCE_MOST &&
           place->force_exponent >= FORCE_EXPONENT_LEAST && place->force_exponent <= FORCE_EXPONENT_MOST;
}

static void told(bool is_femur_the_short_one)
{
    brace_load_t load;
    brace_loaded_stiffness_t result;
    brace_loaded_fixed_place_t place;
    const bool is_bent = any_bool();
    is_femur_short = is_femur_the_short_one;
    any_limb();
    if (any_bool()) {
        (void)brace_loaded_fixed_stiffness(&limb, any_float(), any_float(), &load, &result);
        return;
    }
    ASSUME(!is_bent || is_place(&place));
    if (brace_loaded_fixed_follow(&limb, any_float(), any_float(), &load, is_bent, &place, &result) == BRACE_OK) {
        PROVE(is_place(&place), "a place again");
    }
}

int main(void)
{
    told(true);
    told(false);
    return 0;
}
