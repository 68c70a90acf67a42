/* What the proofs of K under load in fixed point take of its numbers: shifts, vectors, points of a bent link. */
#include "proof.h"
#include "loaded_sizes.h"
#include "loaded/fixed_solve.h"

#include "fixed/fixed_table.c"

static bool is_in(int64_t number, int64_t most)
{
    return number <= most && number >= -most;
}

static int64_t size_of(int32_t number)
{
    return number < 0 ? -(int64_t)number : number;
}

static void shifts(void)
{
    const int64_t sum = any_i64();
    const int32_t bits = any_i32();
    ASSUME(bits >= 25 && bits <= 33);
    ASSUME(sum >> bits >= INT32_MIN && sum >> bits <= INT32_MAX);
    PROVE(shifted(sum, bits) == sum >> bits, "a sum, shifted");
    if (bits <= 31) {
        const int64_t less = (sum >> bits) - coarse(sum, bits);
        PROVE(less >= 0 && less < 1LL << (32 - bits), "the same but for its last bits");
    }
}

/* Two points of the beam, seen from the root and from the end. */
static void points(void)
{
    fixed_shape_t shape;
    const int32_t root = shape.root;
    ASSUME(IS_SHAPE(size_of(root), size_of(shape.a), size_of(shape.b)));
    const double a1 = 0.5, b1 = -0.0773502692, a2 = 1.07735027, b2 = 0.5; /* fixed_pull_bent's */
    const int32_t first = fixed_turn_at(&shape, Q30(a1), Q30(b1));
    const int32_t second = fixed_turn_at(&shape, Q30(a2), Q30(b2)), end = fixed_end_turn(&shape);
    PROVE(is_in((int64_t)first - root, NEAR_MOST), "the first point is near the root");
    PROVE(is_in(first, FIRST_MOST) && is_in(second, SECOND_MOST), "neither is turned too far");
    PROVE(is_in((int64_t)second - first, FAR_MOST), "nor from the first");
    PROVE(is_in((int64_t)second - end, NEAR_MOST), "and near the end");
}

static fixed_vec_t any_vector(int64_t most)
{
    fixed_vec_t v;
    ASSUME(is_in(v.x, most) && is_in(v.z, most));
    return v;
}

/* CBMC's own checks: nothing here overflows. */
static void vectors(void)
{
    const uint32_t most = any_u32();
    ASSUME(most <= INT32_MAX);
    const fixed_vec_t a = any_vector(most), b = any_vector((int64_t)INT32_MAX - most);
    (void)fixed_plus(a, b);
    (void)fixed_minus(a, b);
    (void)fixed_quarter(a);
    (void)fixed_cross(a, b, 31);
    (void)fixed_turned(a, b);
    (void)fixed_turned_back(a, b);
}

static void pivots(void)
{
    const int32_t pivot = any_i32();
    ASSUME(pivot >= LEAST_PIVOT_Q27);
    (void)inverse_q27(pivot);
}

int main(void)
{
    shifts();
    points();
    vectors();
    pivots();
    return 0;
}
