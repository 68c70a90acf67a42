#include "brace/planar_fixed.h"

#include <stddef.h>
#include <string.h>

#include "fixed/fixed_table.h"
#include "fixed/fixed_turn.h"

/* Formats: _q31 is a number times 2^31 in 32 bits, _turn a fraction of a turn times 2^32. A name without a format is an
 * integer whose unit brace_planar_fixed_collapse has chosen (compliances), or a count of bits. A product of two words
 * keeps only its high word: q31 times q31 gives q30. */

static inline int32_t high(int32_t a, int32_t b)
{
    return brace_high_word((int64_t)a * b);
}

static inline uint32_t high_unsigned(uint32_t a, uint32_t b)
{
    return (uint32_t)(((uint64_t)a * b) >> 32);
}

/* The high word of a b + c d. */
static inline int32_t high_sum(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return brace_high_word((int64_t)a * b + (int64_t)c * d);
}

/* Number of leading zeros of a word that is not zero. */
static inline uint32_t leading_zeros(uint32_t word)
{
    return (uint32_t)__builtin_clz(word);
}

/* The entry of the sine table nearest to an angle: 64 entries to the turn. */
static inline brace_sincos_t nearest(uint32_t angle_turn)
{
    return brace_fixed_sincos[(angle_turn + 0x02000000u) >> 26];
}

/* The angle minus that of the nearest entry; 2^31 stands for half an entry, pi/64. */
static inline int32_t off_nearest(uint32_t angle_turn)
{
    return (int32_t)(angle_turn << 6);
}

/* Sine and cosine of an entry's angle plus d, by the angle sums. cos_d_less_1_q32: the cosine of d, minus one. */
static inline brace_sincos_t add_angle(brace_sincos_t near, int32_t d, int32_t d2, int32_t cos_d_less_1_q32)
{
    const int32_t sin_d_q32 = high(d, SIN_D1 + high(d2, SIN_D3));
    return (brace_sincos_t){near.sin_q31 + high_sum(near.sin_q31, cos_d_less_1_q32, near.cos_q31, sin_d_q32),
                            near.cos_q31 + high_sum(near.cos_q31, cos_d_less_1_q32, near.sin_q31, -sin_d_q32)};
}

/* Sine and cosine within 1e-9. */
static inline brace_sincos_t sincos_of(uint32_t angle_turn)
{
    const int32_t d = off_nearest(angle_turn), d2 = high(d, d);
    return add_angle(nearest(angle_turn), d, d2, high(d2, COS_D2 + high(d2, COS_D4)));
}

/* Sine and cosine for turning a vector, two instructions shorter. The direction is right within 1e-9. The length is one
 * (2^31, not BRACE_FIXED_ONE) within 1.1e-7 and never more, so that the turned vector fits into its word. */
static inline brace_sincos_t direction_of(uint32_t angle_turn)
{
    const int32_t d = off_nearest(angle_turn), d2 = high(d, d);
    return add_angle(nearest(angle_turn), d, d2, high(d2, COS_D2_ALONE) + LENGTHEN);
}

/* A harmonic's value, in the harmonic's own unit. */
static inline int32_t harmonic(const brace_fixed_harmonic_t *h, brace_sincos_t knee)
{
    return brace_high_word(h->constant_q32 + (int64_t)h->per_cos * knee.cos_q31 + (int64_t)h->per_sin * knee.sin_q31);
}

/* An IEEE float's bits from magnitude 2^(exponent field - 157), truncated. The magnitude is not zero. The shift brings
 * the magnitude's highest bit to bit 23, where it adds one to the exponent field; so the field here is one less. */
static inline uint32_t float_bits(uint32_t magnitude, uint32_t exponent_field)
{
    const uint32_t zeros = leading_zeros(magnitude);
    return exponent_field - (zeros << 23) + ((magnitude << zeros) >> 8);
}

static inline float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* |value|; one unit of the last place too small for a negative value. */
static inline uint32_t magnitude_of(int32_t value)
{
    return (uint32_t)(value ^ (value >> 31));
}

/* The sign bit of a float. */
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
    const uint32_t knee_turn = brace_turn_from_q28(theta2_rad_q28);
    const uint32_t bisector_twice_turn = 2u * brace_turn_from_q28(theta1_rad_q28) - knee_turn;
    const brace_sincos_t knee = sincos_of(knee_turn);

    /* det C = cross^2 + rest, and the leading 32 bits of det C. */
    const int32_t cross = harmonic(&fixed->cross, knee), rest = harmonic(&fixed->rest, knee);
    const uint64_t det = (uint64_t)((int64_t)cross * cross + (int64_t)rest * fixed->rest_weight);
    const uint32_t det_high = (uint32_t)(det >> 32), det_low = (uint32_t)det;
    const uint32_t det_zeros = leading_zeros(det_high);
    const uint32_t det_leading = (det_high << det_zeros) | ((det_low >> 1) >> (31u - det_zeros));

    /* Mean and deviator of C, shifted together so that the mean fills its word. */
    const uint32_t mean_as_is = (uint32_t)harmonic(&fixed->mean, knee);
    const uint32_t mean_zeros = leading_zeros(mean_as_is);
    const uint32_t mean = mean_as_is << mean_zeros;
    const int32_t minus_dev_x = (int32_t)((uint32_t)harmonic(&fixed->minus_dev_x, knee) << mean_zeros);
    const int32_t dev_z = (int32_t)((uint32_t)harmonic(&fixed->dev_z, knee) << mean_zeros);

    /* The deviator's length is the leading bits of its square, shifted by an even number, times the inverse root of
     * these bits. A table guesses the inverse root, and one step of Newton's method makes it exact. */
    const uint64_t square = (uint64_t)((int64_t)minus_dev_x * minus_dev_x + (int64_t)dev_z * dev_z);
    const uint32_t square_high = (uint32_t)(square >> 32), square_low = (uint32_t)square;
    const uint32_t shift = leading_zeros(square_high | 1u) >> 1;
    const uint32_t square_from_low = (square_low >> (16u - shift)) >> (16u - shift);
    const uint32_t square_leading = ((square_high << shift) << shift) | square_from_low;
    const brace_fixed_seed_t seed = brace_fixed_seed[square_leading >> 26];
    const uint32_t across_cell = (square_leading >> 10) & 0xffffu;
    const uint32_t guess_q29 = ((uint32_t)seed.at_q13 << 16) - (uint32_t)seed.slope_q13 * across_cell;
    const uint32_t excess_q26 = high_unsigned(high_unsigned(guess_q29, guess_q29), square_leading);
    const uint32_t per_radius_q28 = high_unsigned(guess_q29, (RSQRT_THREE_Q26 - excess_q26) << 4);
    const uint32_t radius = (high_unsigned(square_leading, per_radius_q28) << 4) >> shift;

    /* One division serves both 1/det and 1/(mean + radius): it inverts their product, by sixteen bits and one step of
     * Newton's method. */
    const uint32_t longest = (mean >> 1) + radius;
    const uint32_t product = high_unsigned(det_leading, longest);
    const uint32_t quotient = (0x80000000u / (product >> 16)) << 13;
    const uint32_t inverse = high_unsigned(quotient, (0x20000000u - high_unsigned(product, quotient)) << 3);
    const uint32_t per_det = high_unsigned(longest, inverse);
    const uint32_t per_longest = high_unsigned(det_leading, inverse);
    const uint32_t exponent_k = fixed->exponent_k + ((det_zeros - mean_zeros) << 23);
    stiffness->lambda_max_n_per_mm = float_of(float_bits(high_unsigned(longest, per_det), exponent_k - (1u << 23)));
    stiffness->lambda_min_n_per_mm = float_of(float_bits(per_longest, fixed->exponent_min + (mean_zeros << 23)));
    stiffness->flags = fixed->flags;

    /* Half the angle of minus the deviator, in the bisector's frame. The highest bits of its unit vector choose the
     * nearest entry of the sine table, and an arcsine adds the rest. The angle of the vector is twice that of the axis,
     * so a turn of 2^32 is read as half a turn below. */
    const uint32_t half_shift = shift - 1u;
    const int32_t cosine_q27 = high((int32_t)((uint32_t)minus_dev_x << half_shift), (int32_t)per_radius_q28);
    const int32_t sine_q27 = high((int32_t)((uint32_t)dev_z << half_shift), (int32_t)per_radius_q28);
    const uint32_t entry = brace_fixed_cell[((uint32_t)sine_q27 >> 24) & 15u][((uint32_t)cosine_q27 >> 24) & 15u];
    const brace_sincos_t opposite = brace_fixed_sincos[entry];
    const int32_t sine_off_q26 = high_sum(sine_q27, opposite.cos_q31, cosine_q27, opposite.sin_q31);
    const int32_t sine_off_q32 = (int32_t)((uint32_t)sine_off_q26 << 6);
    const int32_t off_turn = high(sine_off_q32, ASIN_1 + high(high(sine_off_q32, sine_off_q32), ASIN_3));
    const int32_t axis_twice_turn = (int32_t)(bisector_twice_turn + (entry << 26) + (uint32_t)off_turn);
    const uint32_t axis = high_unsigned(magnitude_of(axis_twice_turn), PI_Q30) | 1u;
    stiffness->stiff_axis_rad = float_of(float_bits(axis, AXIS_EXPONENT) | sign_of(axis_twice_turn));

    /* K = (mean I - dev)/det, the deviator turned into the world's frame. */
    const brace_sincos_t to_world = direction_of(bisector_twice_turn);
    const int32_t minus_world_x = high_sum(minus_dev_x, to_world.cos_q31, dev_z, to_world.sin_q31);
    const int32_t minus_world_z = high_sum(minus_dev_x, to_world.sin_q31, -dev_z, to_world.cos_q31);
    const int32_t mean_quarter = (int32_t)(mean >> 2);
    stiffness->k_xx_n_per_mm =
        float_of(float_bits(high_unsigned((uint32_t)(mean_quarter + minus_world_x), per_det), exponent_k));
    stiffness->k_zz_n_per_mm =
        float_of(float_bits(high_unsigned((uint32_t)(mean_quarter - minus_world_x), per_det), exponent_k));
    stiffness->k_xz_n_per_mm = float_of(
        float_bits(high_unsigned(magnitude_of(minus_world_z), per_det) | 1u, exponent_k) | sign_of(minus_world_z));
    return BRACE_OK;
}
