/* One link under load in fixed point: what it tells of itself at any shape. A vector is known by its length only, and
 * a product by its factors' sizes. */
#include "proof.h"
#include "loaded_sizes.h"

/* What the firmware calls a vector, and how long it is at most. */
#define BRACE_FIXED_VEC_H
typedef enum { ANY_VECTOR, FORCE_BEYOND, OWN_FORCE } what_t;
typedef struct {
    int32_t x, z;
    int64_t most;
    what_t what;
} brace_fixed_vec_t;

#include "loaded/fixed_vec.h"

#include "fixed/fixed_table.c"

static int32_t any_within(int64_t most)
{
    const int32_t any = any_i32();
    PROVE(most < 1LL << 31, "it fits its word");
    ASSUME(any <= most && any >= -most);
    return any;
}

static fixed_vec_t any_vector(int64_t most)
{
    return (fixed_vec_t){any_within(most), any_within(most), most, ANY_VECTOR};
}

/* --- sums of products: their factors' sizes, the second's to 1/64 of its word ----------------------------------- */

#define PART 25

static int64_t size_of(int32_t number)
{
    return number < 0 ? -(int64_t)number : number;
}

static int64_t parts_of(int32_t number)
{
    return (size_of(number) + (1 << PART) - 1) >> PART;
}

static int64_t any_sum(int64_t parts)
{
    const int64_t sum = any_i64();
    PROVE(parts <= 1LL << (62 - PART), "the sum fits 64 bits");
    ASSUME(sum <= parts << PART && sum >= -(parts << PART));
    return sum;
}

/* What springs give is squared often: its square is known whole. */
static int64_t square_parts(int32_t number)
{
    const int64_t parts = size_of(number) * parts_of(number);
    const int64_t most = ((SPRING_GIVES_MOST * SPRING_GIVES_MOST) >> PART) + 1;
    return size_of(number) <= SPRING_GIVES_MOST && parts > most ? most : parts;
}

static int64_t any_product(int32_t a, int32_t b)
{
    const int64_t product = any_sum(a == b ? square_parts(a) : size_of(a) * parts_of(b));
    ASSUME(product >= 0 || (a < 0) != (b < 0));
    return product;
}

/* A difference of squares is no larger than the larger one. */
static int64_t any_sum2(int32_t a, int32_t b, int32_t c, int32_t d)
{
    if (a == b && c == -d) {
        const int64_t square = square_parts(a), other = square_parts(c);
        return any_sum(square > other ? square : other);
    }
    return any_sum(size_of(a) * parts_of(b) + size_of(c) * parts_of(d));
}

static int64_t any_sum3(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    return any_sum(size_of(a) * parts_of(b) + size_of(c) * parts_of(d) + size_of(e) * parts_of(f));
}

/* Their shifts, which may lose no bit that counts. */
static int32_t sound_shifted(int64_t sum, int bits)
{
    PROVE(sum >> bits >= INT32_MIN && sum >> bits <= INT32_MAX, "no high bit is lost");
    return shifted(sum, bits);
}

/* A shape at points of its beam: how far the first and the second are turned from the root (loaded_points). */
static int32_t root, first_off, end_off, point_count;

static int32_t any_point(void)
{
    const int32_t off = any_i32();
    if (point_count == 0) {
        ASSUME(off <= NEAR_MOST && off >= -NEAR_MOST);
        ASSUME((int64_t)root + off <= FIRST_MOST && (int64_t)root + off >= -FIRST_MOST);
        first_off = off;
    } else {
        PROVE(point_count == 1, "two points");
        ASSUME((int64_t)off - first_off <= FAR_MOST && (int64_t)off - first_off >= -FAR_MOST);
        ASSUME((int64_t)off - end_off <= NEAR_MOST && (int64_t)off - end_off >= -NEAR_MOST);
        ASSUME((int64_t)root + off <= SECOND_MOST && (int64_t)root + off >= -SECOND_MOST);
    }
    point_count++;
    return off;
}

static int32_t sound_coarse(int64_t sum, int bits)
{
    if (bits == 30) {
        return any_point();
    }
    PROVE(sum >> bits >= INT32_MIN && sum >> bits <= INT32_MAX, "no high bit is lost, coarsely");
    return coarse(sum, bits);
}

/* --- vectors ---------------------------------------------------------------------------------------------------- */

#define ROUNDED 8 /* what truncation adds to a vector's length, at most */

static fixed_vec_t sum_of(fixed_vec_t a, fixed_vec_t b)
{
    const bool is_force = a.what == FORCE_BEYOND && b.what == OWN_FORCE;
    return any_vector(is_force ? FORCE_MOST : a.most + b.most);
}

static fixed_vec_t quarter_of(fixed_vec_t v)
{
    return any_vector(v.most);
}

static fixed_vec_t turned_of(fixed_vec_t v, fixed_vec_t by)
{
    return any_vector((v.most * by.most >> 30) + ROUNDED);
}

static fixed_vec_t scaled_of(fixed_vec_t v, int32_t by, int bits)
{
    PROVE(size_of(by) <= SPRING_GIVES_MOST, "what a spring gives");
    return any_vector((v.most * (SPRING_GIVES_MOST) >> bits) + ROUNDED);
}

/* By a share of one. */
static fixed_vec_t share_of(fixed_vec_t v, int32_t by, int bits)
{
    PROVE(by >= 0 && bits == 31, "a share");
    fixed_vec_t share = any_vector(v.most);
    share.what = v.what;
    return share;
}

static fixed_vec_t sum2_of(fixed_vec_t a, int32_t by, fixed_vec_t b, int32_t to, int bits)
{
    PROVE(size_of(by) <= END_MOST, "what a link's end gives");
    PROVE(size_of(to) <= SPRING_GIVES_MOST, "what its spring gives");
    return any_vector(((a.most * END_MOST + b.most * (SPRING_GIVES_MOST)) >> bits) + ROUNDED);
}

static fixed_vec_t sum3_of(const fixed_vec_t v[3], int32_t a, int32_t b, int32_t c, int bits)
{
    return any_vector(((v[0].most * size_of(a) + v[1].most * size_of(b) + v[2].most * size_of(c)) >> bits) + ROUNDED);
}

/* The last two vectors' lever, along and across: together they are no more than the product of their lengths. */
static bool is_pair;
static int64_t lever_most;
static int32_t lever_along, lever_across;

static int32_t dot_of(fixed_vec_t a, fixed_vec_t b, int bits)
{
    lever_most = (a.most * b.most >> bits) + ROUNDED;
    is_pair = false;
    lever_along = any_within(lever_most);
    ASSUME(a.what != FORCE_BEYOND || b.what != FORCE_BEYOND || lever_along >= 0); /* a square */
    return lever_along;
}

static int32_t cross_of(fixed_vec_t a, fixed_vec_t b, int bits)
{
    PROVE((a.most * b.most >> bits) + ROUNDED == lever_most, "the same two vectors");
    is_pair = true;
    return lever_across = any_within(lever_most);
}

/* --- what drives: across + along times the turn is at most the lever times the root of 1 + turn^2 ---------------- */

static int64_t driven_most(int32_t turn)
{
    if (size_of(turn) <= ROOT_ANGLE_MOST) {
        return (lever_most >> 10) * 3336 + 4096; /* the root of 1 + 3.1^2 */
    }
    if (size_of(turn) <= FIRST_MOST) {
        return (lever_most >> 10) * 3699 + 4096;
    }
    return size_of(turn) <= SECOND_MOST ? (lever_most >> 10) * 4104 + 4096 : INT64_MAX;
}

static int64_t coarse_product(int32_t a, int32_t b, int bits)
{
    const int64_t product = any_product(a, b);
    if (is_pair && bits == 29 && a == lever_along) {
        const int64_t driven = (int64_t)lever_across + (product >> bits);
        ASSUME(driven <= driven_most(b) && driven >= -driven_most(b));
    }
    return product;
}

/* along times across is at most half of the square of both together */
static int64_t fine_product(int32_t a, int32_t b)
{
    const int64_t product = any_product(a, b);
    if (is_pair && a == lever_along && b == lever_across) {
        const int64_t most = (lever_most * lever_most) / 2;
        ASSUME(product <= most && product >= -most);
    }
    return product;
}

#define sum2 any_sum2
#define sum3 any_sum3
#define shifted sound_shifted
#define coarse sound_coarse
#define times(a, b, bits) sound_shifted(fine_product(a, b), bits)
#define coarse_times(a, b, bits) sound_coarse(coarse_product(a, b, bits), bits)
#define fixed_plus sum_of
#define fixed_minus sum_of
#define fixed_quarter quarter_of
#define fixed_scaled scaled_of
#define fixed_coarsely_scaled share_of
#define fixed_sum2 sum2_of
#define fixed_sum3 sum3_of
#define fixed_dot dot_of
#define fixed_cross cross_of
#define fixed_turned turned_of
#define fixed_turn_by(angle) any_vector(DIRECTION_MOST)
#define fixed_small_turn small_turn_of

static fixed_vec_t small_turn_of(int32_t angle)
{
    PROVE(size_of(angle) <= LARGER_ANGLE_MOST, "a small turn");
    return any_vector(size_of(angle) <= SMALL_ANGLE_MOST ? SMALL_TURN_MOST : LARGER_TURN_MOST);
}

#include "loaded/fixed_link.h"

static fixed_vec_t any_spring(void)
{
    return any_vector(SPRING_MOST);
}

static fixed_link_t any_link(void)
{
    fixed_link_t link = {any_vector(TO_BEAM_MOST),
                         any_vector(BEAM_MOST),
                         any_vector(RIGID_MOST),
                         any_spring(),
                         any_spring(),
                         any_i32(),
                         any_i32(),
                         any_vector(FORCE_MOST),
                         any_vector(FORCE_MOST),
                         any_vector(FORCE_MOST)};
    link.beyond.what = FORCE_BEYOND, link.own.what = OWN_FORCE;
    ASSUME(link.end_q30 >= 0 && link.end_q30 <= END_MOST && link.bend >= 0);
    return link;
}

static fixed_shape_t any_shape(void)
{
    const fixed_shape_t shape = {any_within(ROOT_ANGLE_MOST), any_within(CURVATURE_MOST), any_within(CURVATURE_MOST)};
    ASSUME(IS_SHAPE(size_of(shape.root), size_of(shape.a), size_of(shape.b)));
    return shape;
}

static void are_within(const fixed_matrix_t *m, int64_t most)
{
    PROVE(size_of(m->rr) <= most, "rr");
    PROVE(size_of(m->ra) <= most && size_of(m->rb) <= most, "root and curvatures");
    PROVE(size_of(m->aa) <= most && size_of(m->ab) <= most && size_of(m->bb) <= most, "curvatures");
}

static void is_pull(const fixed_pull_t *pull)
{
    are_within(&pull->resists, RESISTS_MOST);
    PROVE(size_of(pull->drives.root) <= ROOT_DRIVES_MOST, "drives the root");
    PROVE(size_of(pull->drives.a) <= DRIVES_MOST && size_of(pull->drives.b) <= DRIVES_MOST, "drives");
    PROVE(size_of(pull->end_resists) <= END_RESISTS_MOST, "the end resists");
    PROVE(size_of(pull->end_drives) <= END_DRIVES_MOST, "the end drives");
}

static void straight(void)
{
    const fixed_link_t link = any_link();
    fixed_pull_t pull;
    fixed_pull_straight(&link, &pull);
    is_pull(&pull);
}

static void bent(void)
{
    const fixed_link_t link = any_link();
    const fixed_shape_t shape = any_shape();
    fixed_pull_t pull;
    root = shape.root, end_off = shape.a + shape.b, point_count = 0;
    fixed_pull_bent(&link, &shape, &pull);
    is_pull(&pull);
}

static void at_rest(bool is_short)
{
    fixed_link_t link = any_link();
    if (is_short) {
        link.to_beam = any_vector(HALF_TO_BEAM_MOST), link.beam = any_vector(HALF_BEAM_MOST);
    }
    const fixed_shape_t shape = any_shape();
    fixed_rest_t rest;
    fixed_rest_of(&link, &shape, &rest);
    are_within(&rest.resists, REST_MOST);
    PROVE(size_of(rest.end_resists) <= SOFTENS_MOST, "the end resists");
    PROVE(rest.root_softens >= 0 && rest.root_softens <= SOFTENS_MOST, "the root softens");
    PROVE(rest.end_softens >= 0 && rest.end_softens <= SOFTENS_MOST, "the end softens");
    PROVE(rest.tip.most <= (is_short ? HALF_TIP_MOST : TIP_MOST), "the tip");
    PROVE(rest.a.most <= LEVER_MOST && rest.b.most <= LEVER_MOST, "curvatures' levers");
    PROVE(rest.end.most <= LEVER_MOST && rest.aside.most <= ASIDE_MOST, "other levers");
    PROVE(rest.root_spring.most <= SPRING_GIVES_MOST && rest.end_spring.most <= SPRING_GIVES_MOST, "springs");
}

int main(void)
{
    straight();
    bent();
    at_rest(false);
    at_rest(true);
    return 0;
}
