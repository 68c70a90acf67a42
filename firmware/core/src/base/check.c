#include "base/check.h"

#include <float.h>
#include <stddef.h>

#include "brace/kinematics.h"
#include "base/off_tick.h"

#define LENGTH_LIMIT_MM 1e4f

/* Softer than any limb in range, and its inverse and its square still far from the ends of the format. */
#define SMALLEST_STIFFNESS_N_PER_MM 1e-12f

/* Comparisons with NaN are false, so NaN falls through to the last line. */
BRACE_OFF_TICK
brace_status_t brace_check_magnitude(float value, float limit)
{
    const float magnitude = __builtin_fabsf(value);
    if (magnitude <= limit) {
        return BRACE_OK;
    }
    return magnitude <= FLT_MAX ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
}

BRACE_OFF_TICK
brace_status_t brace_check_two(float a, float b, float limit)
{
    return brace_check_magnitude(__builtin_fabsf(a) <= limit ? b : a, limit);
}

BRACE_OFF_TICK
brace_status_t brace_check_lengths(const brace_limb_t *limb)
{
    if (limb == NULL) {
        return BRACE_E_NULL;
    }
    const float *length = (const float *)limb; /* coxa, femur, tibia come first */
    float least = 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (!(length[i] >= least && length[i] <= LENGTH_LIMIT_MM)) {
            return BRACE_E_PARAMETER;
        }
        least = 1.0f;
    }
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness)
{
    if (stiffness == NULL) {
        return BRACE_E_NULL;
    }
    const float smaller = stiffness->lambda_min_n_per_mm;
    const float larger = stiffness->lambda_max_n_per_mm;
    brace_status_t status = brace_check_two(smaller, larger, 1.0f / SMALLEST_STIFFNESS_N_PER_MM);
    if (status == BRACE_OK && (smaller < SMALLEST_STIFFNESS_N_PER_MM || smaller > larger)) {
        status = BRACE_E_RANGE;
    }
    return status != BRACE_OK ? status
                              : brace_check_magnitude(stiffness->stiff_axis_rad, BRACE_ANGLE_LIMIT_RAD);
}
