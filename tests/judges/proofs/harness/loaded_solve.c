/* The equations of K under load in fixed point: what is answered, not refused, has no number that left its word. */
#include "proof.h"
#include "loaded_sizes.h"
#include "loaded/fixed_link.h"

#include "fixed/fixed_table.c"

static int64_t size_of(int32_t number)
{
    return number < 0 ? -(int64_t)number : number;
}

static int32_t any_within(int64_t most)
{
    const int32_t any = any_i32();
    ASSUME(any <= most && any >= -most);
    return any;
}

/* Is every number so far what it would be in words of any size? */
static bool is_true;

/* Any sum of products, kept by the firmware's own text. */
static int32_t any_kept(int64_t sum, int bits, int room, lost_t *lost)
{
    const int32_t number = kept(sum, bits, room, lost);
    PROVE(*lost >= LOST || number == sum >> bits, "a number beyond its word is noted as lost");
    PROVE(*lost >= LOST || size_of(number) <= 1LL << (56 + room - bits), "and beyond its room");
    is_true = is_true && number == sum >> bits;
    return number;
}

static int32_t plus_or_not(int32_t a, int32_t b)
{
    is_true = is_true && wrapped_plus(a, b) == (int64_t)a + b;
    return wrapped_plus(a, b);
}

static int32_t less_or_not(int32_t a, int32_t b)
{
    is_true = is_true && wrapped_less(a, b) == (int64_t)a - b;
    return wrapped_less(a, b);
}

/* Two or three products that are not all as large as words allow: their sum fits 64 bits. */
static int64_t sum2_fits(int32_t a, int32_t b, int32_t c, int32_t d)
{
    (void)a, (void)b;
    PROVE(size_of(c) < 1LL << 31 || size_of(d) < 1LL << 31, "the sum of two products fits 64 bits");
    return 0;
}

static int64_t sum3_fits(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    (void)a, (void)b, (void)d, (void)f;
    PROVE(size_of(c) <= 1LL << 29 && size_of(e) <= 1LL << 29, "the sum of three products fits 64 bits");
    return 0;
}

/* A product of pivots has as many bits as its factors have, or one less. */
static uint32_t bits_in(uint32_t word)
{
    return word == 0u ? 0u : 32u - (uint32_t)__builtin_clz(word);
}

static int32_t any_times(int32_t a, int32_t b, int bits)
{
    if (bits == 30) { /* a way, and the part of it that a shape goes */
        PROVE(b >= 0 && b <= 1 << 30, "a part is no more than the whole");
        const int32_t part = any_within(size_of(a));
        ASSUME(a < 0 ? part <= 0 : part >= 0);
        return part;
    }
    PROVE(a > 0 && b > 0, "of numbers above zero");
    const uint64_t any = any_u64();
    const uint32_t in = bits_in((uint32_t)a) + bits_in((uint32_t)b);
    ASSUME(any >> (in - 2u) != 0u && any >> in == 0u);
    return shifted((int64_t)any, bits);
}

static int32_t any_inverse(int32_t pivot)
{
    PROVE(pivot >= LEAST_PIVOT_Q27, "one over it fits its word");
    const int32_t inverse = any_i32();
    ASSUME(inverse > 0);
    return inverse;
}

/* A compliance, which is not negative, over a pivot. */
static int64_t any_above_zero(void)
{
    const int64_t sum = any_i64();
    ASSUME(sum >= 0);
    return sum;
}

static fixed_matrix_t any_matrix(int64_t most)
{
    return (fixed_matrix_t){any_within(most), any_within(most), any_within(most),
                            any_within(most), any_within(most), any_within(most)};
}

/* What a link's proof promises (loaded_link). */
static void any_pull(fixed_pull_t *pull)
{
    *pull = (fixed_pull_t){any_matrix(RESISTS_MOST),
                           {any_within(ROOT_DRIVES_MOST), any_within(DRIVES_MOST), any_within(DRIVES_MOST)},
                           any_within(END_RESISTS_MOST),
                           any_within(END_DRIVES_MOST)};
}

static bool is_bent_as_promised(const fixed_shape_t *shape)
{
    return IS_SHAPE(size_of(shape->root), size_of(shape->a), size_of(shape->b));
}

static void any_pull_straight(const fixed_link_t *link, fixed_pull_t *pull)
{
    (void)link;
    any_pull(pull);
}

static void any_pull_bent(const fixed_link_t *link, const fixed_shape_t *shape, fixed_pull_t *pull)
{
    (void)link;
    PROVE(is_bent_as_promised(shape), "a shape that a link takes");
    any_pull(pull);
}

#define fixed_pull_straight any_pull_straight
#define fixed_pull_bent any_pull_bent
/* A sum is looked at, a product of two words is not made: it fits 64 bits. */
#define sum2 sum2_fits
#define sum3 sum3_fits
#define IS_SUM(text) ((text)[0] == 's')
#define IS_OVER_PIVOT(text) ((text)[9] == 'b' && (text)[16] == 'i') /* (int64_t)bend * inverse_q27(...) */
#define kept(sum, bits, room, lost) \
    (IS_SUM(#sum) ? (void)(sum) : (void)0, \
     any_kept(IS_OVER_PIVOT(#sum) ? any_above_zero() : any_i64(), bits, room, lost))
#define wrapped_plus plus_or_not
#define wrapped_less less_or_not
#define times any_times
#define inverse_q27 any_inverse
#include "loaded/fixed_solve.h"

static void steps(void)
{
    fixed_limb_t limb;
    const bool is_first = any_bool();
    ASSUME(is_bent_as_promised(&limb.femur_shape) && is_bent_as_promised(&limb.tibia_shape));
    ASSUME(limb.femur.bend >= 0 && limb.tibia.bend >= 0);
    is_true = true;
    int32_t turned_q27;
    if (fixed_bounded_step(&limb, is_first, any_within(INT32_MAX), any_within(INT32_MAX), &turned_q27)) {
        PROVE(is_true, "a step that is answered is true");
        PROVE(is_bent_as_promised(&limb.femur_shape) && is_bent_as_promised(&limb.tibia_shape), "to a shape again");
    }
}

static fixed_rest_t any_rest(void)
{
    fixed_rest_t rest;
    rest.resists = any_matrix(REST_MOST);
    rest.end_resists = any_within(SOFTENS_MOST);
    ASSUME(rest.root_softens >= 0 && rest.root_softens <= SOFTENS_MOST);
    ASSUME(rest.end_softens >= 0 && rest.end_softens <= SOFTENS_MOST);
    return rest;
}

/* What levers are eliminated with (loaded_levers). */
static void are_factors(const fixed_factors_t *f)
{
    PROVE(f->yields_a >= 0 && f->yields_b >= 0, "yields");
    PROVE(size_of(f->b_by_a) <= RATIO_MOST && size_of(f->root_by_a) <= RATIO_MOST &&
              size_of(f->root_by_b) <= RATIO_MOST,
          "ratios");
}

static void pivots(void)
{
    const fixed_rest_t femur = any_rest(), tibia = any_rest();
    const fixed_stance_t stance = {&femur, &tibia, any_i32(), any_i32(), any_i32(), any_i32()};
    ASSUME(stance.femur_bend >= 0 && stance.tibia_bend >= 0);
    fixed_pivots_t p;
    is_true = true;
    if (!fixed_pivots_of(&stance, &p)) {
        return;
    }
    PROVE(is_true, "pivots that are answered are true");
    are_factors(&p.femur);
    are_factors(&p.tibia);
    PROVE(p.per_hip > 0 && p.per_knee > 0, "one over a joint's pivot");
    const fixed_wide_t det = fixed_product(&p);
    PROVE(det.mantissa_q31 >= 1 << 30 && size_of(det.exponent) <= 64, "their product");
}

int main(void)
{
    steps();
    pivots();
    return 0;
}
