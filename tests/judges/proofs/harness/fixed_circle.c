/* From C to K, its eigenvalues and its axis in integers. A product is replaced by any number of its size. */
#include "fixed/fixed_roots.h"
#include "fixed/fixed_sincos.h"
#include "proof.h"

#include "fixed/fixed_table.c"

static uint32_t trace, number, per_root, half_shift;
static int32_t deviator_x, deviator_z;

static uint32_t bits_in(uint32_t word)
{
    return word == 0u ? 0u : 32u - (uint32_t)__builtin_clz(word);
}

static uint32_t size_of(int32_t value)
{
    return value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
}

/* Factors of so many bits make a product of as many as both together, or one less. */
static uint64_t any_product(uint32_t a, uint32_t b)
{
    const uint64_t any = any_u64();
    const uint32_t bits = bits_in(a) + bits_in(b);
    ASSUME(a == 0u || b == 0u ? any == 0u : any >> (bits - 2u) != 0u && (bits == 64u || any >> bits == 0u));
    return any;
}

static uint32_t any_high_unsigned(uint32_t a, uint32_t b)
{
    if (b == PI_Q30) {
        return (uint32_t)((uint64_t)a * PI_Q30 >> 32);
    }
    const uint32_t high_word = (uint32_t)(any_product(a, b) >> 32);
    /* fixed_lengths: a number times one over its root is below 2^27 */
    ASSUME(a != number || b != per_root || high_word < 1u << 27);
    return high_word;
}

static bool is_shifted(int32_t shifted, int32_t component)
{
    return shifted == (int32_t)((uint32_t)component << half_shift) && shifted >> half_shift == component;
}

/* fixed_lengths: a component, shifted by half_shift, times one over the length. Others by their sizes. */
static int32_t any_high(int32_t a, int32_t b)
{
    const int32_t high_word = any_i32();
    if (b == (int32_t)per_root && (is_shifted(a, deviator_x) || is_shifted(a, deviator_z))) {
        ASSUME(high_word >= -(1 << 26) && high_word < 1 << 26);
        return high_word;
    }
    const uint64_t size = any_product(size_of(a), size_of(b));
    return brace_high_word((a < 0) == (b < 0) ? (int64_t)(size & INT64_MAX) : -(int64_t)(size & INT64_MAX));
}

/* The deviator's square: at least that of each component, and its length is below 2^31. */
static int64_t square_stand_in(int32_t a, int32_t b, int32_t c, int32_t d)
{
    PROVE(a == deviator_x && b == a && c == deviator_z && d == c, "the square of the deviator");
    const uint64_t square = any_u64();
    ASSUME(square < 1ull << 62);
    ASSUME(a == 0 || square >> (2u * (bits_in(size_of(a)) - 1u)) != 0u);
    ASSUME(c == 0 || square >> (2u * (bits_in(size_of(c)) - 1u)) != 0u);
    half_shift = ((uint32_t)__builtin_clz((uint32_t)(square >> 32) | 1u) >> 1) - 1u;
    number = (uint32_t)(square >> (32u - 2u * (half_shift + 1u)));
    return (int64_t)square;
}

static uint32_t any_per_root(uint32_t of)
{
    PROVE(of == number, "of the leading bits of the square");
    per_root = any_u32();
    ASSUME(per_root >> 26 != 0u && per_root >> 31 == 0u);
    return per_root;
}

static uint32_t any_per_product(uint32_t of)
{
    PROVE(of >= 1u << 29, "a product that can be inverted");
    const uint32_t inverse = any_u32();
    ASSUME(inverse >= 1u << 27 && inverse <= 1u << 30);
    return inverse;
}

static int32_t any_off_entry(int32_t cosine, int32_t sine, uint32_t *entry)
{
    PROVE(cosine >= -(1 << 26) && cosine < 1 << 26 && sine >= -(1 << 26) && sine < 1 << 26, "a vector of the grid");
    *entry = any_u8() & 63u;
    return any_i32();
}

/* The deviator turned by a direction. By Cauchy's inequality no component is longer than the deviator. */
static int32_t turned_stand_in(int32_t a, int32_t b, int32_t c, int32_t d)
{
    (void)b, (void)d;
    PROVE(a == deviator_x && (c == deviator_z || c == -deviator_z), "the deviator");
    const int32_t component = any_i32();
    ASSUME(4 * (int64_t)component <= (int64_t)trace - 8 && 4 * (int64_t)component >= 4 - (int64_t)trace);
    return component;
}

#define high_unsigned any_high_unsigned
#define high any_high
#define whole_sum square_stand_in
#define high_sum turned_stand_in
#define fixed_per_root_q27 any_per_root
#define fixed_per_product any_per_product
#define fixed_off_entry_q32 any_off_entry
#include "fixed/fixed_inverse.h"
#undef fixed_off_entry_q32

static bool is_finite(float value)
{
    return value - value == 0.0f;
}

static void to_stiffness(void)
{
    fixed_circle_t c;
    brace_stiffness_t k;
    trace = c.trace, deviator_x = c.minus_dev_x, deviator_z = c.dev_z;
    ASSUME(trace >= 0x80000000u && c.det_leading >= 0x80000000u);
    ASSUME(c.exponent_k % (1u << 23) == 0u && c.exponent_k >= 59u << 23 && c.exponent_k <= 231u << 23);
    ASSUME(c.exponent_min % (1u << 23) == 0u && c.exponent_min >= 59u << 23 && c.exponent_min <= 231u << 23);
    const int32_t most = (int32_t)(trace / 2u) - 4;
    ASSUME(deviator_x <= most && deviator_x >= -most && deviator_z <= most && deviator_z >= -most);
    stiffness_of_circle(&c, &k);
    PROVE(is_finite(k.lambda_max_n_per_mm) && k.lambda_max_n_per_mm > 0.0f, "the largest eigenvalue");
    PROVE(is_finite(k.lambda_min_n_per_mm) && k.lambda_min_n_per_mm > 0.0f, "the least eigenvalue");
    PROVE(is_finite(k.k_xx_n_per_mm) && k.k_xx_n_per_mm > 0.0f, "K along x");
    PROVE(is_finite(k.k_zz_n_per_mm) && k.k_zz_n_per_mm > 0.0f, "K along z");
    PROVE(is_finite(k.k_xz_n_per_mm), "K across");
    PROVE(k.stiff_axis_rad >= -1.5707964f && k.stiff_axis_rad <= 1.5707964f, "the axis is within a quarter turn");
}

int main(void)
{
    uint32_t entry;
    (void)fixed_off_entry_q32(any_i32(), any_i32(), &entry);
    to_stiffness();
    return 0;
}
