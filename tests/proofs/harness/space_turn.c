/* K in space in fixed point, whatever it is: its eigenvalues and axes in the plane and in the robot's frame. A product
 * is replaced by any number of its size. */
#include "proof.h"
#include "loaded_sizes.h"
#include "fixed/fixed_inverse.h"
#include "fixed_space/frame.h"

#include "fixed/fixed_table.c"

static int64_t magnitude(int64_t number)
{
    return number < 0 ? -number : number;
}

static int32_t any_within(int64_t most)
{
    const int32_t any = any_i32();
    PROVE(most < 1LL << 31, "it fits its word");
    ASSUME(any <= most && any >= -most);
    return any;
}

#define Q30_MOST (1LL << 30)
#define WORDS_MOST (1LL << 28)          /* K's entries in its unit */
#define AXIS_MOST PART_OF(30, 1.001)
#define SINE_MOST PART_OF(30, 0.7072)   /* of a turn by an eighth at most */
#define PER_COSINE_MOST PART_OF(27, 1.41423)

/* --- lengths (fixed_lengths, fixed_circle) ----------------------------------------------------------------------- */

static int32_t part_x, part_z;
static uint32_t half_shift;

static bool is_shifted(int32_t shifted_part, int32_t part)
{
    return shifted_part == (int32_t)((uint32_t)part << half_shift) && shifted_part >> half_shift == part;
}

static fixed_length_t any_length_of(int32_t x, int32_t z)
{
    PROVE(magnitude(x) <= Q30_MOST && magnitude(z) <= Q30_MOST, "a vector whose square is below 2^62");
    const fixed_length_t length = {any_u32(), any_u32(), any_u32()};
    ASSUME(length.length <= 1u << 31 && length.per_length_q27 >> 26 != 0u && length.per_length_q27 >> 31 == 0u);
    ASSUME(length.shift >= 1u && length.shift <= 15u);
    part_x = x, part_z = z, half_shift = length.shift - 1u;
    ASSUME(is_shifted((int32_t)((uint32_t)x << half_shift), x) && is_shifted((int32_t)((uint32_t)z << half_shift), z));
    return length;
}

/* A part, shifted, times one over the length. */
static int32_t any_high_of(int32_t a, int32_t per_length_q27)
{
    (void)per_length_q27;
    PROVE(is_shifted(a, part_x) || is_shifted(a, part_z), "a part of the vector");
    const int32_t part = any_i32();
    ASSUME(part >= -(1 << 26) && part < 1 << 26 && (a < 0 || part >= 0));
    return part;
}

static uint32_t any_per_root_q27(uint32_t number)
{
    PROVE(number >= INT32_MAX, "a number from a half on");
    const uint32_t per_root = any_u32();
    ASSUME(per_root >> 26 != 0u && per_root <= PER_COSINE_MOST);
    return per_root;
}

static float any_axis_rad(int32_t x, int32_t z, const fixed_length_t *length, uint32_t twice_turn)
{
    (void)length, (void)twice_turn;
    PROVE(x == part_x && z == part_z, "the vector whose length it is");
    const float axis = any_float();
    ASSUME(axis >= -1.5707964f && axis <= 1.5707964f);
    return axis;
}

/* --- products ---------------------------------------------------------------------------------------------------- */

static bool is_turning;

/* A number times one over its root is below 2^27 (fixed_lengths). */
static uint32_t any_high_unsigned(uint32_t a, uint32_t b)
{
    const uint32_t high_word = any_u32();
    ASSUME(high_word <= (a < b ? a : b) && (a >> 31 == 0u || high_word >= b >> 1));
    ASSUME(!is_turning || high_word < 1u << 27);
    return high_word;
}

/* Of K's entries. */
static int64_t any_whole_product(int32_t a, int32_t b)
{
    PROVE(magnitude(a) <= WORDS_MOST && magnitude(b) <= WORDS_MOST, "entries of K in its unit");
    const int64_t product = any_i64(), most = WORDS_MOST * WORDS_MOST;
    ASSUME(product <= most && product >= (a == b ? 0 : -most));
    return product;
}

static int32_t any_times(int32_t a, int32_t b, int bits)
{
    const int64_t per = PER_COSINE_MOST;
    if (bits == 24) {
        PROVE(magnitude(a) <= 1 << 26 && b <= per, "a sine, over its cosine");
        return any_within(((per << 26) >> 24) + 1);
    }
    if (bits == 27) {
        PROVE(magnitude(a) <= SINE_MOST && b <= per, "a tangent");
        return any_within(PART_OF(30, 1.0002));
    }
    PROVE(bits == 30 && magnitude(a) <= PART_OF(30, 1.0002) && magnitude(b) <= 1 << 29, "what one gives the other");
    return any_within(PART_OF(29, 1.0003));
}

/* A pair turned: of a matrix's entries, or of axes' parts. */
static int64_t any_sum2(int32_t a, int32_t b, int32_t c, int32_t d)
{
    PROVE(magnitude(a) <= Q30_MOST && magnitude(c) <= Q30_MOST, "a turn's cosine and sine");
    PROVE(magnitude(a) <= SINE_MOST || magnitude(c) <= SINE_MOST, "of an eighth at most");
    PROVE(magnitude(b) <= AXIS_MOST && magnitude(d) <= AXIS_MOST, "a pair");
    const int64_t sum = any_i64(), most = (int64_t)(1.71 * 0x1p60);
    ASSUME(sum <= most && sum >= -most);
    return sum;
}

static int32_t whole_less(int32_t a, int32_t b)
{
    PROVE(magnitude((int64_t)a - b) <= INT32_MAX, "a difference in its word");
    return wrapped_less(a, b);
}

static int32_t whole_plus(int32_t a, int32_t b)
{
    PROVE(magnitude((int64_t)a + b) <= INT32_MAX, "a sum in its word");
    return wrapped_plus(a, b);
}

static uint32_t any_over_q61(uint32_t leading)
{
    PROVE(leading >> 31 != 0u, "a number that fills its word");
    const uint32_t over = any_u32();
    ASSUME(over >= (1u << 29) - 8u && over <= 1u << 30);
    return over;
}

/* --- the text ---------------------------------------------------------------------------------------------------- */

#define SECOND(first, second, ...) second
#define PICK(...) SECOND(__VA_ARGS__)
#define fixed_twice_turned(first, ...) PICK(TWICE_##first, any_twice_turned, ~)(first, __VA_ARGS__)
#define TWICE_int32_t ~, text_twice_turned,
#define fixed_length_of any_length_of
#define high_of any_high_of
#define fixed_per_root_q27 any_per_root_q27
#define fixed_axis_rad any_axis_rad
#define high_unsigned any_high_unsigned
#define times any_times
#define sum2 any_sum2
#define whole_product any_whole_product
#define less whole_less
#define plus whole_plus
#define over_q61 any_over_q61

/* As far as a word holds it below 2^30 (twice_turned, below). */
static fixed_vec_t any_twice_turned(int32_t apart, int32_t twice_pq)
{
    PROVE(magnitude(apart) < Q30_MOST && magnitude(twice_pq) < Q30_MOST, "entries apart by less than 2^30");
    const fixed_vec_t any = {any_within(Q30_MOST - 1), any_within(Q30_MOST)};
    ASSUME(any.x > 0);
    return any;
}

#include "fixed_space/jacobi.h"

#undef less
#undef plus
#define fixed_jacobi any_jacobi
#define fixed_sym3_about_z any_sym3_about_z
#define fixed_about_z any_about_z
#define fixed_direction(turn) ((fixed_vec_t){any_within(Q30_MOST), any_within(Q30_MOST)})

/* Eigenvalues and axes (jacobi_turns, below). */
static void any_jacobi(fixed_jacobi_t *j)
{
    PROVE(magnitude(j->m.xx) <= WORDS_MOST && magnitude(j->m.xy) <= WORDS_MOST && magnitude(j->m.xz) <= WORDS_MOST &&
              magnitude(j->m.yy) <= WORDS_MOST && magnitude(j->m.yz) <= WORDS_MOST && magnitude(j->m.zz) <= WORDS_MOST,
          "K in its unit");
    PROVE(j->m.xx > 0 && j->m.yy > 0 && j->m.zz > 0, "its diagonal");
    j->m.xx = any_within(Q30_MOST - 1), j->m.yy = any_within(Q30_MOST - 1), j->m.zz = any_within(Q30_MOST - 1);
    for (int i = 0; i < 3; i++) {
        j->axis[i] = (fixed3_t){any_within(AXIS_MOST), any_within(AXIS_MOST), any_within(AXIS_MOST)};
    }
}

/* A turn keeps what a matrix and a vector are in size (loaded_space). */
static void any_sym3_about_z(fixed_sym3_t *m, fixed_vec_t by)
{
    (void)by;
    PROVE(magnitude(m->xx) <= WORDS_MOST && magnitude(m->yy) <= WORDS_MOST && magnitude(m->zz) <= WORDS_MOST,
          "K in its unit");
    *m = (fixed_sym3_t){any_within(3 * WORDS_MOST), any_within(3 * WORDS_MOST), any_within(3 * WORDS_MOST),
                        any_within(3 * WORDS_MOST), any_within(3 * WORDS_MOST), any_within(3 * WORDS_MOST)};
}

static fixed3_t any_about_z(fixed3_t v, fixed_vec_t by)
{
    (void)by;
    PROVE(magnitude(v.x) <= AXIS_MOST && magnitude(v.y) <= AXIS_MOST && magnitude(v.z) <= AXIS_MOST, "an axis");
    return (fixed3_t){any_within(2 * AXIS_MOST - Q30_MOST / 2), any_within(2 * AXIS_MOST - Q30_MOST / 2), v.z};
}

#include "fixed_space/loaded_space_fixed_turn.c"

/* --- the claims -------------------------------------------------------------------------------------------------- */

static void twice_turned(void)
{
    const fixed_vec_t twice = text_twice_turned(any_within(Q30_MOST - 1), any_within(Q30_MOST - 1));
    PROVE(twice.x > 0 && twice.x < Q30_MOST, "along");
    PROVE(magnitude(twice.z) <= Q30_MOST, "aside");
}

/* Of a matrix with a diagonal from 0 to 1 and all else from -1 to 1 the part without its mean has at most
 * 2/3 + 6 as its entries' squares' sum, which no turn changes. Two of its eigenvalues, and so any qq - pp and 2 pq in
 * any frame, are apart by the root of twice that at most: 3.652. Rounding adds less than 2^-20 in a turn. Its mean is 1
 * at most, so that each entry is below 1 + 2.11. */
#define APART_MOST PART_OF(28, 3.653)
#define TURNED_MOST PART_OF(28, 3.12)

static void jacobi_turns(void)
{
    int32_t pp = any_within(TURNED_MOST), pq = any_within(APART_MOST / 2), qq = any_within(TURNED_MOST);
    int32_t rp = any_within(APART_MOST / 2), rq = any_within(APART_MOST / 2);
    fixed3_t p = {any_within(AXIS_MOST), any_within(AXIS_MOST), any_within(AXIS_MOST)}, q = p;
    ASSUME(magnitude((int64_t)qq - pp) <= APART_MOST);
    is_turning = true;
    fixed_jacobi_turn(&pp, &pq, &qq, &rp, &rq, &p, &q);
    is_turning = false;
}

static bool is_finite(float value)
{
    return (bits_of(value) & 0x7f800000u) != 0x7f800000u;
}

static bool is_above_zero(float value)
{
    return bits_of(value) - 1u < 0x7fffffffu;
}

static void in_plane(void)
{
    brace_k3_t k;
    brace_stiffness_t plane;
    if (brace_loaded_space_fixed_in_plane(&k, &plane) == BRACE_OK) {
        PROVE(is_finite(plane.lambda_min_n_per_mm) && is_above_zero(plane.lambda_min_n_per_mm), "the least eigenvalue");
        PROVE(is_finite(plane.lambda_max_n_per_mm) && is_above_zero(plane.lambda_max_n_per_mm), "the largest");
    }
}

static void turned(void)
{
    brace_k3_t k;
    brace_stiffness_spatial_t told;
    if (brace_loaded_space_fixed_turn(any_float(), &k, &told) == BRACE_OK) {
        PROVE(is_finite(told.k_xx_n_per_mm) && is_finite(told.k_xy_n_per_mm) && is_finite(told.k_xz_n_per_mm) &&
                  is_finite(told.k_yy_n_per_mm) && is_finite(told.k_yz_n_per_mm), "K is finite");
        PROVE(is_finite(told.lambda_n_per_mm[0]) && is_above_zero(told.lambda_n_per_mm[0]), "the least eigenvalue");
    }
}

int main(void)
{
    twice_turned();
    jacobi_turns();
    in_plane();
    turned();
    return 0;
}
