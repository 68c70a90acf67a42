#include "base/check.h"

#include <stddef.h>

#include "base/off_tick.h"
#include "brace/kinematics.h"

/* Softer than any limb in range, and its inverse and its square still far from the ends of the format. */
#define SMALLEST_STIFFNESS_N_PER_MM 1e-12f
#define LARGEST_STIFFNESS_N_PER_MM (1.0f / SMALLEST_STIFFNESS_N_PER_MM)

#define LONGEST_MM 1e4f

/* By the digits of brace_input_t, which begin with one. */
static const float limit[] = {BRACE_ANGLE_LIMIT_RAD, 10.0f, 1e4f, 1e6f, 2e6f, LARGEST_STIFFNESS_N_PER_MM};

/* Of a magnitude that is beyond its limit. */
static inline brace_status_t beyond(uint32_t magnitude)
{
    return magnitude < BRACE_INFINITE_BITS ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
}

/* Small rather than fast, though questions to the controller pass here on its tick. */
BRACE_OFF_TICK
brace_status_t brace_check(const void *given, const float *value, brace_input_t what)
{
    if (given == NULL) {
        return BRACE_E_NULL;
    }
    for (uint32_t digits = what; digits > 0u; digits /= 16u) { /* at most six */
        const uint32_t magnitude = brace_magnitude_bits(*value++);
        if (magnitude > brace_magnitude_bits(limit[digits % 16u - 1u])) {
            return beyond(magnitude);
        }
    }
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_check_two(float a, float b, float most)
{
    const uint32_t of_a = brace_magnitude_bits(a), of_b = brace_magnitude_bits(b);
    const uint32_t larger = of_a > of_b ? of_a : of_b;
    return larger <= brace_magnitude_bits(most) ? BRACE_OK : beyond(larger);
}

BRACE_OFF_TICK
brace_status_t brace_check_magnitude(float value, float most)
{
    return brace_check_two(value, value, most);
}

/* Not below one, nor above the most: one comparison, for what lies below wraps round to above all. */
static bool is_length(float length)
{
    const uint32_t one = (uint32_t)brace_bits(1.0f), most = (uint32_t)brace_bits(LONGEST_MM);
    return (uint32_t)brace_bits(length) - one <= most - one;
}

BRACE_OFF_TICK
brace_status_t brace_check_lengths(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    return !brace_is_negative(limb->coxa_mm) && brace_magnitude_bits(limb->coxa_mm) <= brace_magnitude_bits(LONGEST_MM) &&
                   is_length(limb->femur_mm) && is_length(limb->tibia_mm)
               ? BRACE_OK
               : BRACE_E_PARAMETER;
}

BRACE_OFF_TICK
brace_status_t brace_check_limb(const void *given, const float *value, brace_input_t what, const brace_limb_t *limb)
{
    const brace_status_t status = brace_check(limb != NULL ? given : NULL, value, what);
    return status == BRACE_OK ? brace_check_lengths(limb) : status;
}

BRACE_OFF_TICK
brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness, const void *given, const float *value,
                                     brace_input_t what)
{
    brace_status_t status = brace_check(given, value, what);
    if (status == BRACE_OK) {
        status = brace_check(stiffness, (const float *)stiffness, BRACE_INPUT_STIFFNESS);
    }
    if (status == BRACE_OK) {
        const int32_t smaller = brace_bits(stiffness->lambda_min_n_per_mm); /* below all others when negative */
        if (smaller < brace_bits(SMALLEST_STIFFNESS_N_PER_MM) || smaller > brace_bits(stiffness->lambda_max_n_per_mm)) {
            status = BRACE_E_RANGE;
        }
    }
    return status;
}
