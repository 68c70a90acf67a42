#include "brace/planar_fixed.h"

#include <stddef.h>

#include "fixed/fixed_harmonic.h"
#include "fixed/fixed_inverse.h"
#include "fixed/fixed_sincos.h"
#include "fixed/fixed_turn.h"
#include "fixed/fixed_word.h"

/* Formats: _q31 is a number times 2^31 in 32 bits, _turn a fraction of a turn times 2^32. A name without a format is an
 * integer whose unit brace_planar_fixed_collapse has chosen (compliances), or a count of bits. A product of two words
 * keeps only its high word: q31 times q31 gives q30. */

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
    const uint64_t det = (uint64_t)whole_sum(cross, cross, rest, fixed->rest_weight);
    const uint32_t det_high = (uint32_t)(det >> 32), det_low = (uint32_t)det;
    const uint32_t det_zeros = leading_zeros(det_high);
    const uint32_t det_leading = (det_high << det_zeros) | ((det_low >> 1) >> (31u - det_zeros));

    /* Mean and deviator of C, shifted together so that the mean fills its word. */
    const uint32_t mean_as_is = (uint32_t)harmonic(&fixed->mean, knee);
    const uint32_t mean_zeros = leading_zeros(mean_as_is);
    const uint32_t mean = mean_as_is << mean_zeros;
    const int32_t minus_dev_x = (int32_t)((uint32_t)harmonic(&fixed->minus_dev_x, knee) << mean_zeros);
    const int32_t dev_z = (int32_t)((uint32_t)harmonic(&fixed->dev_z, knee) << mean_zeros);

    const fixed_circle_t circle = {mean,
                                   minus_dev_x,
                                   dev_z,
                                   det_leading,
                                   fixed->exponent_k + ((det_zeros - mean_zeros) << 23),
                                   fixed->exponent_min + (mean_zeros << 23),
                                   bisector_twice_turn};
    stiffness_of_circle(&circle, stiffness);
    stiffness->flags = fixed->flags;
    return BRACE_OK;
}
