#include "brace/slope.h"

#include <float.h>
#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"
#include "chain/tensor.h"

#define SMALLEST_STEP_MM 1e-6f
#define STEPS_LIMIT (1u << 24)

/* What a test's sums begin with: a line of no spread can be divided by it, and nothing is changed by that. */
#define NEARLY_NOTHING FLT_MIN

/* What a reading holds. */
enum { DISPLACEMENT_MM, FORCE_X_N, FORCE_Z_N, READING_COUNT };

/* Where a line holds its slopes, and what they leave. */
enum { SLOPE = 1, RESIDUAL = 3 };

_Static_assert(offsetof(brace_slope_line_t, slope) == SLOPE * sizeof(float) &&
                   offsetof(brace_slope_line_t, residual) == RESIDUAL * sizeof(float),
               "a line is five floats");

BRACE_OFF_TICK
brace_status_t brace_slope_start(brace_slope_t *slope, float displacement_mm, float force_x_n,
                                 float force_z_n)
{
    const float reading[READING_COUNT] = {displacement_mm, force_x_n, force_z_n};
    const brace_status_t status = brace_check(slope, reading, BRACE_INPUT_READING);
    if (status == BRACE_OK) {
        const float *end = (const float *)(slope->line + BRACE_SLOPE_METHOD_COUNT);
        for (float *field = slope->mean; field < end; field++) { /* at most eighteen */
            *field = NEARLY_NOTHING;
        }
        for (int i = 0; i < READING_COUNT; i++) {
            slope->preload[i] = reading[i];
        }
        slope->used = slope->skipped = 0;
    }
    return status;
}

/* All three estimates are one thing, a least-squares line through the origin of what each makes of a step: least
 * squares takes it as it is from the preload point, the mean of ratios divides it by its displacement, and the free
 * intercept takes it from the mean, shrunk by the root of what is left of a step once it has also moved the mean. A new
 * step shifts the slope by its surprise, and the residual grows by the part of the surprise that the shift does not
 * explain: positive terms only. */
static inline void extend_line(brace_slope_line_t *line, const float step[READING_COUNT])
{
    const float displacement = step[DISPLACEMENT_MM];
    const float spread = line->spread + displacement * displacement;
    const float gain = displacement / spread, unexplained = line->spread / spread;
    line->spread = spread;
    float *at = line->slope;
    for (const float *force = step + FORCE_X_N; force < step + READING_COUNT; force++) { /* at most two */
        const float surprise = *force - *at * displacement;
        at[RESIDUAL - SLOPE] += unexplained * surprise * surprise;
        *at++ += gain * surprise;
    }
}

BRACE_OFF_TICK
brace_status_t brace_slope_step(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n)
{
    float seen[BRACE_SLOPE_METHOD_COUNT][READING_COUNT];
    float *reading = seen[0];
    reading[DISPLACEMENT_MM] = displacement_mm;
    reading[FORCE_X_N] = force_x_n;
    reading[FORCE_Z_N] = force_z_n;
    const brace_status_t status = brace_check(slope, reading, BRACE_INPUT_READING);
    if (status != BRACE_OK) {
        return status;
    }
    if (slope->used + slope->skipped >= STEPS_LIMIT) {
        return BRACE_E_RANGE;
    }
    const float step_mm = reading[DISPLACEMENT_MM] - slope->preload[DISPLACEMENT_MM];
    if (brace_magnitude_bits(step_mm) < brace_magnitude_bits(SMALLEST_STEP_MM)) {
        slope->skipped++;
        return BRACE_OK;
    }
    slope->used++;
    const float newest = 1.0f / (float)slope->used, left = brace_sqrt(1.0f - newest);
    for (int i = 0; i < READING_COUNT; i++) {
        const float from_preload = reading[i] - slope->preload[i], from_mean = from_preload - slope->mean[i];
        slope->mean[i] += newest * from_mean;
        seen[BRACE_SLOPE_LEAST_SQUARES][i] = from_preload;
        seen[BRACE_SLOPE_MEAN_OF_RATIOS][i] = from_preload / step_mm;
        seen[BRACE_SLOPE_FREE_INTERCEPT][i] = from_mean * left;
    }
    for (int method = 0; method < BRACE_SLOPE_METHOD_COUNT; method++) {
        extend_line(&slope->line[method], seen[method]);
    }
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_slope_column(const brace_slope_t *slope, brace_slope_method_t method,
                                  brace_slope_column_t *column)
{
    if (slope == NULL || column == NULL) {
        return BRACE_E_NULL;
    }
    if ((unsigned)method >= BRACE_SLOPE_METHOD_COUNT) {
        return BRACE_E_RANGE;
    }
    const brace_slope_line_t *line = &slope->line[method];
    const int32_t freedom = (int32_t)slope->used - (method == BRACE_SLOPE_FREE_INTERCEPT ? 2 : 1);
    if (freedom <= 0 || brace_bits(line->spread) <= brace_bits(NEARLY_NOTHING)) {
        return BRACE_E_TOO_FEW;
    }
    const float spread = (float)freedom * line->spread;
    column->k_x_n_per_mm = line->slope[0];
    column->k_z_n_per_mm = line->slope[1];
    column->sigma_k_x_n_per_mm = brace_sqrt(line->residual[0] / spread);
    column->sigma_k_z_n_per_mm = brace_sqrt(line->residual[1] / spread);
    column->used = slope->used;
    column->skipped = slope->skipped;
    return BRACE_OK;
}

static float square(float value)
{
    return value * value;
}

BRACE_OFF_TICK
brace_status_t brace_slope_stiffness(const brace_slope_t *along_x, const brace_slope_t *along_z,
                                     brace_slope_method_t method, brace_slope_stiffness_t *stiffness)
{
    if (stiffness == NULL) {
        return BRACE_E_NULL;
    }
    brace_slope_column_t along[2];
    brace_status_t status = brace_slope_column(along_x, method, &along[0]);
    if (status == BRACE_OK) {
        status = brace_slope_column(along_z, method, &along[1]);
    }
    if (status != BRACE_OK) {
        return status;
    }
    const float *x = &along[0].k_x_n_per_mm, *z = &along[1].k_x_n_per_mm;
    float *entry = &stiffness->k_xx_n_per_mm; /* row by row, then their sigmas */
    for (int row = 0; row < 4; row++) {
        *entry++ = x[row];
        *entry++ = z[row];
    }
    const float k_xx = stiffness->k_xx_n_per_mm, k_xz = stiffness->k_xz_n_per_mm;
    const float k_zx = stiffness->k_zx_n_per_mm, k_zz = stiffness->k_zz_n_per_mm;
    stiffness->asymmetry_n_per_mm = k_xz - k_zx;
    stiffness->sigma_asymmetry_n_per_mm =
        brace_length(stiffness->sigma_k_xz_n_per_mm, stiffness->sigma_k_zx_n_per_mm);

    brace_stiffness_t *symmetric = &stiffness->symmetric;
    brace_stiffness_of_circle(0.5f * (k_xz + k_zx), 0.5f * (k_xx - k_zz), 0.5f * (k_xx + k_zz), symmetric);
    const brace_vec_t stiff = brace_direction(brace_turn(symmetric->stiff_axis_rad));
    const float sigma = brace_sqrt(square(square(stiff.z) * stiffness->sigma_k_xx_n_per_mm) +
                                   square(square(stiff.x) * stiffness->sigma_k_zz_n_per_mm) +
                                   square(stiff.z * stiff.x * stiffness->sigma_asymmetry_n_per_mm));
    stiffness->sigma_lambda_min_n_per_mm = sigma;
    const bool is_determined = brace_bits(symmetric->lambda_min_n_per_mm) > brace_bits(sigma);
    symmetric->flags = is_determined ? 0u : (uint32_t)BRACE_FLAG_NEAR_SINGULAR;
    return BRACE_OK;
}
