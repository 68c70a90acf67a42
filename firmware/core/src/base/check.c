#include "base/check.h"

#include <stddef.h>

#include "base/off_tick.h"
#include "brace/kinematics.h"

/* Softer than any limb in range, and its inverse and its square still far from the ends of the format. */
#define SMALLEST_STIFFNESS_N_PER_MM 1e-12f
#define LARGEST_STIFFNESS_N_PER_MM (1.0f / SMALLEST_STIFFNESS_N_PER_MM)

/* What brace_input_t counts in; runs overlap where their limits are the same. */
static const float limit[] = {
    LARGEST_STIFFNESS_N_PER_MM, LARGEST_STIFFNESS_N_PER_MM, LARGEST_STIFFNESS_N_PER_MM, LARGEST_STIFFNESS_N_PER_MM,
    LARGEST_STIFFNESS_N_PER_MM, BRACE_ANGLE_LIMIT_RAD,      BRACE_ANGLE_LIMIT_RAD,      2e6f,
    BRACE_ANGLE_LIMIT_RAD,      1e4f,                       1e4f,                       1e6f,
    1e6f,                       10.0f,                      10.0f,                      10.0f,
};

static inline brace_status_t judge(uint32_t magnitude, float most)
{
    return magnitude <= brace_magnitude_bits(most) ? BRACE_OK
           : magnitude < BRACE_INFINITE_BITS       ? BRACE_E_RANGE
                                                   : BRACE_E_NOT_FINITE;
}

BRACE_OFF_TICK
brace_status_t brace_check(const void *given, const float *value, brace_input_t what)
{
    if (given == NULL) {
        return BRACE_E_NULL;
    }
    const float *most = limit + (what >> 4);
    uint32_t left = what & 0xfu;
    brace_status_t status;
    do { /* at most six */
        status = judge(brace_magnitude_bits(*value++), *most++);
        left--;
    } while (status == BRACE_OK && left > 0u);
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_check_two(float a, float b, float most)
{
    const uint32_t of_a = brace_magnitude_bits(a), of_b = brace_magnitude_bits(b);
    return judge(of_a > of_b ? of_a : of_b, most);
}

BRACE_OFF_TICK
brace_status_t brace_check_magnitude(float value, float most)
{
    return brace_check_two(value, value, most);
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
