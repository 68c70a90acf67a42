/* Straight-line code with more values in flight than registers: scheduling before registers are allotted
 * costs a dozen spills (256 instructions instead of 238). */
#if defined(__arm__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-schedule-insns")
#endif

#include "brace/planar_fixed.h"

#include <stddef.h>
#include <string.h>

#include "fixed/fixed_table.h"
#include "base/turn.h"

/* High words of products. */
static inline int32_t high_word(int64_t sum)
{
    return (int32_t)(uint32_t)((uint64_t)sum >> 32);
}

static inline int32_t high(int32_t a, int32_t b)
{
    return high_word((int64_t)a * b);
}

static inline uint32_t high_unsigned(uint32_t a, uint32_t b)
{
    return (uint32_t)(((uint64_t)a * b) >> 32);
}

static inline int32_t high_sum(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return high_word((int64_t)a * b + (int64_t)c * d);
}

/* Leading zeros of a word that is not zero. */
static inline uint32_t leading_zeros(uint32_t word)
{
    return (uint32_t)__builtin_clz(word);
}

static inline brace_sincos_t nearest(uint32_t turn)
{
    return brace_fixed_sincos[(turn + 0x02000000u) >> 26];
}

/* Sine and cosine off the nearest entry; a sum of 64-bit products takes one instruction a term. d: what is left from the
 * nearest table entry, 2^31 = pi/64; cos_d_less_1: q32. */
static inline brace_sincos_t add_angle(brace_sincos_t near, int32_t d, int32_t d2, int32_t cos_d_less_1)
{
    const int32_t sin_d = high(d, SIN_D1 + high(d2, SIN_D3)); /* q32 */
    return (brace_sincos_t){near.sin + high_sum(near.sin, cos_d_less_1, near.cos, sin_d),
                            near.cos + high_sum(near.cos, cos_d_less_1, near.sin, -sin_d)};
}

/* Within 1e-9. */
static inline brace_sincos_t sincos_of(uint32_t turn)
{
    const int32_t d = (int32_t)(turn << 6), d2 = high(d, d);
    return add_angle(nearest(turn), d, d2, high(d2, COS_D2 + high(d2, COS_D4)));
}

/* To turn a vector by: right in direction within 1e-9, and its length is one (2^31, not BRACE_FIXED_ONE)
 * within 1.1e-7 and never more. */
static inline brace_sincos_t direction_of(uint32_t turn)
{
    const int32_t d = (int32_t)(turn << 6), d2 = high(d, d);
    return add_angle(nearest(turn), d, d2, high(d2, COS_D2_ALONE) + LENGTHEN);
}

static inline int32_t harmonic(const brace_fixed_harmonic_t *h, brace_sincos_t at)
{
    const int32_t per_cos = (int32_t)(uint32_t)h->per_turn, per_sin = (int32_t)(uint32_t)(h->per_turn >> 32);
    return high_word(h->constant + (int64_t)per_cos * at.cos + (int64_t)per_sin * at.sin);
}

/* magnitude 2^(exponent field - 157) as an IEEE float's bits, truncated. magnitude is not zero. */
static inline uint32_t float_bits(uint32_t magnitude, uint32_t exponent)
{
    const uint32_t zeros = leading_zeros(magnitude);
    return exponent - (zeros << 23) + ((magnitude << zeros) >> 8);
}

static inline float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline uint32_t magnitude_of(int32_t value)
{
    return (uint32_t)(value ^ (value >> 31));
}

static inline uint32_t sign_of(int32_t value)
{
    return (uint32_t)value & 0x80000000u;
}

brace_status_t brace_planar_fixed_stiffness(const brace_planar_fixed_t *fixed, int32_t theta1_rad_q28,
                                            int32_t theta2_rad_q28, brace_stiffness_t *stiffness)
{
    if (fixed == NULL || stiffness == NULL) {
        return BRACE_E_NULL;
    }
    const uint32_t knee = brace_turn_from_q28(theta2_rad_q28);
    const uint32_t bisector2 = 2u * brace_turn_from_q28(theta1_rad_q28) - knee;

    const brace_sincos_t at = sincos_of(knee);
    const int32_t cross = harmonic(&fixed->cross, at), rest = harmonic(&fixed->rest, at);
    const uint64_t det = (uint64_t)((int64_t)cross * cross + (int64_t)rest * fixed->rest_weight);
    const uint32_t det_high = (uint32_t)(det >> 32), det_low = (uint32_t)det;
    const uint32_t det_zeros = leading_zeros(det_high);
    const uint32_t det_norm = (det_high << det_zeros) | ((det_low >> 1) >> (31u - det_zeros));

    const uint32_t mean_raw = (uint32_t)harmonic(&fixed->mean, at);
    const uint32_t zeros = leading_zeros(mean_raw);
    const uint32_t mean = mean_raw << zeros;
    const int32_t x = (int32_t)((uint32_t)harmonic(&fixed->minus_dev_x, at) << zeros);
    const int32_t y = (int32_t)((uint32_t)harmonic(&fixed->dev_y, at) << zeros);

    /* r = |dev| */
    const uint64_t square = (uint64_t)((int64_t)x * x + (int64_t)y * y);
    const uint32_t square_high = (uint32_t)(square >> 32), square_low = (uint32_t)square;
    const uint32_t shift = leading_zeros(square_high | 1u) >> 1;
    const uint32_t square_norm =
        ((square_high << shift) << shift) | ((square_low >> (16u - shift)) >> (16u - shift));
    const brace_fixed_seed_t seed = brace_fixed_seed[square_norm >> 26];
    const uint32_t guess = ((uint32_t)seed.at << 16) - (uint32_t)seed.slope * ((square_norm >> 10) & 0xffffu);
    const uint32_t excess = high_unsigned(high_unsigned(guess, guess), square_norm);
    const uint32_t per_r = high_unsigned(guess, (RSQRT_THREE - excess) << 4); /* q28 */
    const uint32_t r = (high_unsigned(square_norm, per_r) << 4) >> shift;

    const uint32_t largest = (mean >> 1) + r;
    const uint32_t product = high_unsigned(det_norm, largest);
    const uint32_t quotient = (0x80000000u / (product >> 16)) << 13;
    const uint32_t inverse = high_unsigned(quotient, (0x20000000u - high_unsigned(product, quotient)) << 3);
    const uint32_t per_det = high_unsigned(largest, inverse);
    const uint32_t per_largest = high_unsigned(det_norm, inverse);
    const uint32_t exponent_k = fixed->exponent_k + ((det_zeros - zeros) << 23);
    stiffness->lambda_max_n_per_mm =
        float_of(float_bits(high_unsigned(largest, per_det), exponent_k - (1u << 23)));
    stiffness->lambda_min_n_per_mm = float_of(float_bits(per_largest, fixed->exponent_min + (zeros << 23)));
    stiffness->flags = fixed->flags;

    /* direction of dev, as a unit vector in q27, to the nearest entry of the sine table and on from there */
    const uint32_t half = shift - 1u;
    const int32_t cosine = high((int32_t)((uint32_t)x << half), (int32_t)per_r);
    const int32_t sine = high((int32_t)((uint32_t)y << half), (int32_t)per_r);
    const uint32_t entry = brace_fixed_cell[((uint32_t)sine >> 24) & 15u][((uint32_t)cosine >> 24) & 15u];
    const brace_sincos_t opposite = brace_fixed_sincos[entry];
    const int32_t off = (int32_t)((uint32_t)high_sum(sine, opposite.cos, cosine, opposite.sin) << 6);
    const int32_t off_turn = high(off, ASIN_1 + high(high(off, off), ASIN_3));
    const int32_t axis = (int32_t)(bisector2 + (entry << 26) + (uint32_t)off_turn);
    stiffness->stiff_axis_rad =
        float_of(float_bits(high_unsigned(magnitude_of(axis), PI_Q30) | 1u, AXIS_EXPONENT) | sign_of(axis));

    const brace_sincos_t turn = direction_of(bisector2);
    const int32_t minus_xw = high_sum(x, turn.cos, y, turn.sin); /* in the world's frame */
    const int32_t minus_yw = high_sum(x, turn.sin, -y, turn.cos);
    const int32_t mean4 = (int32_t)(mean >> 2);
    stiffness->k_xx_n_per_mm =
        float_of(float_bits(high_unsigned((uint32_t)(mean4 + minus_xw), per_det), exponent_k));
    stiffness->k_zz_n_per_mm =
        float_of(float_bits(high_unsigned((uint32_t)(mean4 - minus_xw), per_det), exponent_k));
    stiffness->k_xz_n_per_mm = float_of(
        float_bits(high_unsigned(magnitude_of(minus_yw), per_det) | 1u, exponent_k) | sign_of(minus_yw));
    return BRACE_OK;
}
