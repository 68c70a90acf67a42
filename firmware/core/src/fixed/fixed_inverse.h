/* K, its eigenvalues and the stiff axis from C, in integers; IEEE floats at the end. */
#ifndef BRACE_CORE_FIXED_INVERSE_H
#define BRACE_CORE_FIXED_INVERSE_H

#include "brace/stiffness.h"
#include "fixed/fixed_roots.h"
#include "fixed/fixed_sincos.h"
#include "fixed/fixed_word.h"

/* C in a frame of its own: its trace shifted so that it fills its word, and its deviator in the same unit,
 * C = trace/2 I - [[x, -z], [-z, -x]] with x = minus_dev_x, z = dev_z. */
typedef struct {
    uint32_t trace;
    int32_t minus_dev_x, dev_z;
    uint32_t det_leading;              /* the leading 32 bits of det C */
    uint32_t exponent_k, exponent_min; /* exponent fields of IEEE floats: entries of K, its least eigenvalue */
    uint32_t twice_turn;               /* twice the angle of C's frame */
} fixed_circle_t;

/* The length of a vector, and 2^(32 - shift) over it. */
typedef struct {
    uint32_t length, per_length_q27, shift;
} fixed_length_t;

/* By the leading bits of its square, shifted by an even number. */
static inline fixed_length_t fixed_length_of(int32_t x, int32_t z)
{
    const uint64_t square = (uint64_t)whole_sum(x, x, z, z);
    const uint32_t square_high = (uint32_t)(square >> 32), square_low = (uint32_t)square;
    const uint32_t shift = leading_zeros(square_high | 1u) >> 1;
    const uint32_t square_from_low = (square_low >> (16u - shift)) >> (16u - shift);
    const uint32_t square_leading = ((square_high << shift) << shift) | square_from_low;
    const uint32_t per_length_q27 = fixed_per_root_q27(square_leading);
    return (fixed_length_t){(high_unsigned(square_leading, per_length_q27) << 5) >> shift, per_length_q27, shift};
}

/* Half the angle of (x, -z), of that length, and half of another angle: an axis, [-pi/2, pi/2]. The highest bits of the
 * unit vector choose the nearest entry of the sine table, and an arcsine adds the rest. The angle of the vector is
 * twice that of the axis, so a turn of 2^32 is read as half a turn. */
static inline float fixed_axis_rad(int32_t x, int32_t z, const fixed_length_t *length, uint32_t twice_turn)
{
    const uint32_t half_shift = length->shift - 1u;
    uint32_t entry;
    const int32_t per_length_q27 = (int32_t)length->per_length_q27;
    const int32_t cosine_q26 = high((int32_t)((uint32_t)x << half_shift), per_length_q27);
    const int32_t sine_q26 = high((int32_t)((uint32_t)z << half_shift), per_length_q27);
    const int32_t sine_off_q32 = fixed_off_entry_q32(cosine_q26, sine_q26, &entry);
    const int32_t off_turn = high(sine_off_q32, ASIN_1 + high(high(sine_off_q32, sine_off_q32), ASIN_3));
    const int32_t axis_twice_turn = (int32_t)(twice_turn + (entry << 26) + (uint32_t)off_turn);
    const uint32_t axis = high_unsigned(magnitude_of(axis_twice_turn), PI_Q30) | 1u;
    return float_of(float_bits(axis, AXIS_EXPONENT) | sign_of(axis_twice_turn));
}

/* Writes all of a stiffness except its flags. */
static inline void stiffness_of_circle(const fixed_circle_t *c, brace_stiffness_t *stiffness)
{
    const uint32_t trace = c->trace;
    const int32_t minus_dev_x = c->minus_dev_x, dev_z = c->dev_z;

    const fixed_length_t deviator = fixed_length_of(minus_dev_x, dev_z);
    const uint32_t radius = deviator.length;

    /* One division serves both 1/det and 1/(mean + radius): it inverts their product. */
    const uint32_t longest = (trace >> 1) + radius;
    const uint32_t inverse = fixed_per_product(high_unsigned(c->det_leading, longest));
    const uint32_t per_det = high_unsigned(longest, inverse);
    const uint32_t per_longest = high_unsigned(c->det_leading, inverse);
    stiffness->lambda_max_n_per_mm = float_of(float_bits(high_unsigned(longest, per_det), c->exponent_k - (1u << 23)));
    stiffness->lambda_min_n_per_mm = float_of(float_bits(per_longest, c->exponent_min));

    stiffness->stiff_axis_rad = fixed_axis_rad(minus_dev_x, dev_z, &deviator, c->twice_turn);

    /* K = (mean I - dev)/det, the deviator turned into the world's frame. */
    const brace_sincos_t to_world = direction_of(c->twice_turn);
    const int32_t minus_world_x = high_sum(minus_dev_x, to_world.cos_q31, dev_z, to_world.sin_q31);
    const int32_t minus_world_z = high_sum(minus_dev_x, to_world.sin_q31, -dev_z, to_world.cos_q31);
    const int32_t mean_quarter = (int32_t)(trace >> 2);
    stiffness->k_xx_n_per_mm =
        float_of(float_bits(high_unsigned((uint32_t)(mean_quarter + minus_world_x), per_det) | 1u, c->exponent_k));
    stiffness->k_zz_n_per_mm =
        float_of(float_bits(high_unsigned((uint32_t)(mean_quarter - minus_world_x), per_det) | 1u, c->exponent_k));
    stiffness->k_xz_n_per_mm = float_of(
        float_bits(high_unsigned(magnitude_of(minus_world_z), per_det) | 1u, c->exponent_k) | sign_of(minus_world_z));
}

#endif
