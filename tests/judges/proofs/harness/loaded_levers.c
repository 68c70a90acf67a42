/* From the levers of a link under load in fixed point to C, and from C to the circle: a product is any number of its
 * size. */
#include "proof.h"
#include "loaded_sizes.h"
#include "fixed/fixed_inverse.h"
#include "loaded/fixed_solve.h"

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

static fixed_vec_t any_vector(int64_t most)
{
    return (fixed_vec_t){any_within(most), any_within(most)};
}

/* --- products --------------------------------------------------------------------------------------------------- */

static uint32_t bits_in(uint32_t word)
{
    return word == 0u ? 0u : 32u - (uint32_t)__builtin_clz(word);
}

/* What was multiplied last, in order. */
static int64_t product[3];
static int product_count;

static int64_t any_product(int32_t a, int32_t b)
{
    const int64_t any = any_i64(), most = 1LL << (bits_in(magnitude_of(a)) + bits_in(magnitude_of(b)));
    ASSUME(any <= most && any >= -most);
    ASSUME(a == 0 || b == 0 ? any == 0 : (any >= 0) == ((a < 0) == (b < 0)));
    product[product_count % 3] = any;
    product_count++;
    return any;
}

static uint32_t any_high_unsigned(uint32_t a, uint32_t b)
{
    (void)a, (void)b;
    return any_u32();
}

/* A lever times a yield below its word: between nothing and the lever, rounded down. */
static fixed_vec_t any_scaled(fixed_vec_t v, int32_t by, int bits)
{
    PROVE(by >= 0 && bits == 31, "a yield");
    const fixed_vec_t scaled = {any_i32(), any_i32()};
    ASSUME(v.x >= 0 ? scaled.x >= 0 && scaled.x <= v.x : scaled.x < 0 && scaled.x >= v.x);
    ASSUME(v.z >= 0 ? scaled.z >= 0 && scaled.z <= v.z : scaled.z < 0 && scaled.z >= v.z);
    return scaled;
}

/* A sum of three products that fits 64 bits, whatever signs they have; then any number. */
static int64_t sum_fits(int32_t a, int32_t b, int32_t c, int32_t d, int32_t e, int32_t f)
{
    PROVE(size_of(a) <= 1LL << 31 && b == 1 << 27, "a lever");
    PROVE(size_of(c) <= 1LL << 31 && size_of(d) <= 1LL << 29, "a lever times a ratio");
    PROVE(size_of(e) <= 1LL << 31 && size_of(f) <= 1LL << 29, "another");
    return any_i64();
}

/* Is every number so far what it would be in words of any size? */
static bool is_true;

static int32_t true_kept(int64_t sum, int bits, int room, lost_t *lost)
{
    const int32_t number = kept(sum, bits, room, lost);
    PROVE(*lost >= LOST || number == sum >> bits, "a number beyond its word is noted as lost");
    is_true = is_true && number == sum >> bits;
    return number;
}

#define whole_product any_product
#define high_unsigned any_high_unsigned
#define fixed_scaled any_scaled
#define sum3 sum_fits
#define kept true_kept
#define stiffness_of_circle circle_fits
static void circle_fits(const fixed_circle_t *circle, brace_stiffness_t *stiffness);
#include "loaded/fixed_compliance.h"

/* As fixed_circle takes it. That the deviator is shorter than half the trace by 4 units, so that K is positive, follows
 * from det C as it was looked at (docs/trust.md). */
static void circle_fits(const fixed_circle_t *c, brace_stiffness_t *stiffness)
{
    PROVE(c->trace >= 0x80000000u && c->det_leading >= 0x80000000u, "trace and determinant fill their words");
    PROVE(c->exponent_k % (1u << 23) == 0u && c->exponent_k >= 59u << 23 && c->exponent_k <= 231u << 23,
          "K's exponent");
    PROVE(c->exponent_min % (1u << 23) == 0u && c->exponent_min >= 59u << 23 && c->exponent_min <= 231u << 23,
          "the least eigenvalue's");
    (void)stiffness;
}

/* --- one link --------------------------------------------------------------------------------------------------- */

static fixed_rest_t any_rest(void)
{
    fixed_rest_t rest;
    rest.tip = any_vector(TIP_MOST), rest.aside = any_vector(ASIDE_MOST);
    rest.a = any_vector(LEVER_MOST), rest.b = any_vector(LEVER_MOST), rest.end = any_vector(LEVER_MOST);
    rest.root_spring = any_vector(SPRING_GIVES_MOST), rest.end_spring = any_vector(SPRING_GIVES_MOST);
    return rest;
}

static void links(void)
{
    const fixed_rest_t rest = any_rest();
    fixed_factors_t f;
    fixed_tensor_t c, springs;
    ASSUME(f.yields_a >= 0 && f.yields_b >= 0);
    ASSUME(size_of(f.b_by_a) <= RATIO_MOST && size_of(f.root_by_a) <= RATIO_MOST && size_of(f.root_by_b) <= RATIO_MOST);
    lost_t lost = any_u32();
    is_true = true;
    (void)add_link(&c, &springs, &rest, &f, any_bool() ? 2u : 0u, any_vector(BEYOND_MOST), &lost);
    PROVE(lost >= LOST || is_true, "levers that are not noted are true");
}

/* --- C ---------------------------------------------------------------------------------------------------------- */

static void sums(void)
{
    const fixed_vec_t lever = {any_i32(), any_i32()}, spring = any_vector(SPRING_GIVES_MOST);
    const fixed_tensor_t before;
    fixed_tensor_t c = before;
    const bool is_lever = any_bool();
    product_count = 0;
    if (is_lever) {
        add_scaled(&c, lever, any_within(INT32_MAX) & INT32_MAX);
    } else {
        add_spring(&c, spring);
    }
    const int64_t most = is_lever ? 1LL << 62 : 1LL << 60;
    PROVE(product_count == 3 && product[0] >= 0 && product[2] >= 0, "nothing is taken from the diagonal");
    PROVE(product[0] <= most && product[1] <= most && product[1] >= -most && product[2] <= most, "each is below 256");
    PROVE(c.xx == before.xx + (uint64_t)product[0] && c.xz == before.xz + (uint64_t)product[1] &&
              c.zz == before.zz + (uint64_t)product[2],
          "it is added");
}

static void looks(void)
{
    fixed_tensor_t c;
    lost_t lost = 0u;
    look_at(&c, &lost);
    PROVE((lost < LOST) == (c.xx < 1ull << 62 && c.zz < 1ull << 62), "what reaches 256 is noted");
}

/* --- K ---------------------------------------------------------------------------------------------------------- */

static void inverts(void)
{
    fixed_tensor_t c;
    brace_stiffness_t k;
    const int32_t exponent = any_within(UINT8_MAX);
    ASSUME(exponent >= FORCE_EXPONENT_LEAST - 22 && exponent <= FORCE_MOST_EXPONENT - 1);
    ASSUME(c.xx <= C_MOST && c.zz <= C_MOST);
    /* xz^2 is at most xx zz but for rounding: no more than half of the trace */
    const int64_t half = (int64_t)((c.xx + c.zz) / 2u) + C_ROUNDED, xz = (int64_t)c.xz;
    ASSUME(xz <= half && xz >= -half);
    (void)stiffness_of(&c, any_u32(), exponent, &k);
}

int main(void)
{
    links();
    sums();
    looks();
    inverts();
    return 0;
}
