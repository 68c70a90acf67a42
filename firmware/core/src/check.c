#include "check.h"

#include <float.h>
#include <stdbool.h>
#include <stddef.h>

#include "brace/kinematics.h"

#define LENGTH_LIMIT_MM 1e4f

/* Softer than any limb in range, and its inverse and its square still far from the ends of the format. */
#define SMALLEST_STIFFNESS_N_PER_MM 1e-12f

/* Comparisons with NaN are false, so NaN falls through to the last line. */
brace_status_t brace_check_magnitude(float value, float limit)
{
    const float magnitude = __builtin_fabsf(value);
    if (magnitude <= limit) {
        return BRACE_OK;
    }
    return magnitude <= FLT_MAX ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
}

brace_status_t brace_check_lengths(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    const bool possible = limb->coxa_mm >= 0.0f && limb->coxa_mm <= LENGTH_LIMIT_MM &&
                          limb->femur_mm >= 1.0f && limb->femur_mm <= LENGTH_LIMIT_MM &&
                          limb->tibia_mm >= 1.0f && limb->tibia_mm <= LENGTH_LIMIT_MM;
    return possible ? BRACE_OK : BRACE_E_PARAMETER;
}

brace_status_t brace_check_two(float a, float b, float limit)
{
    const brace_status_t status = brace_check_magnitude(a, limit);
    return status != BRACE_OK ? status : brace_check_magnitude(b, limit);
}

brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness)
{
    if (stiffness == NULL) {
        return BRACE_E_NULL;
    }
    const float smaller = stiffness->lambda_min_n_per_mm;
    const float larger = stiffness->lambda_max_n_per_mm;
    const brace_status_t status = brace_check_two(smaller, larger, 1.0f / SMALLEST_STIFFNESS_N_PER_MM);
    if (status != BRACE_OK) {
        return status;
    }
    if (smaller < SMALLEST_STIFFNESS_N_PER_MM || smaller > larger) {
        return BRACE_E_RANGE;
    }
    return brace_check_magnitude(stiffness->stiff_axis_rad, BRACE_ANGLE_LIMIT_RAD);
}
