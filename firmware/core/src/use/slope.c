#include "brace/slope.h"

#include <float.h>
#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"

#define SMALLEST_STEP_MM 1e-6f
#define STEPS_LIMIT (1u << 24)

/* What a reading holds. */
enum { DISPLACEMENT_MM, FORCE_X_N, FORCE_Z_N, READING_COUNT };

/* Where a line holds its slopes, and what they leave. */
enum { SLOPE = 1, RESIDUAL = 3 };

_Static_assert(offsetof(brace_slope_line_t, slope) == SLOPE * sizeof(float) &&
                   offsetof(brace_slope_line_t, residual) == RESIDUAL * sizeof(float),
               "a line is five floats");

/* All three estimates are one thing, a weighted least-squares line through a point: through the preload point
 * with weight 1/displacement^2, the mean of ratios, or with weight one; or through the mean, where the weight
 * is what is left of a step once it has also moved the mean. A new step shifts the slope by its surprise, and
 * the residual grows by the part of the surprise that the shift does not explain: positive terms only. */
BRACE_OFF_TICK
static void extend_line(brace_slope_line_t *line, float weight, const float step[READING_COUNT])
{
    const float displacement = step[DISPLACEMENT_MM];
    const float moment = weight * displacement;
    const float spread = line->spread + moment * displacement;
    const float divisor = spread + FLT_MIN; /* while there is no spread nothing changes */
    const float gain = moment / divisor, unexplained = weight * line->spread / divisor;
    line->spread = spread;
    float *at = (float *)line + SLOPE;
    for (const float *force = step + FORCE_X_N; force < step + READING_COUNT; force++) { /* at most two */
        const float surprise = *force - *at * displacement;
        at[RESIDUAL - SLOPE] += unexplained * surprise * surprise;
        *at++ += gain * surprise;
    }
}

BRACE_OFF_TICK BRACE_LOOPS_STAY
brace_status_t brace_slope_start(brace_slope_t *slope, float displacement_mm, float force_x_n,
                                 float force_z_n)
{
    const float reading[READING_COUNT] = {displacement_mm, force_x_n, force_z_n};
    const brace_status_t status = brace_check(slope, reading, BRACE_INPUT_READING);
    if (status == BRACE_OK) {
        const float *end = (const float *)(slope->line + BRACE_SLOPE_METHOD_COUNT);
        for (float *field = slope->mean; field < end; field += 3) { /* at most six times */
            field[0] = field[1] = field[2] = 0.0f;
        }
        for (int i = 0; i < READING_COUNT; i++) {
            slope->preload[i] = reading[i];
        }
        slope->used = slope->skipped = 0;
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_slope_step(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n)
{
    struct {
        float from_preload[READING_COUNT], from_mean[READING_COUNT];
    } step;
    step.from_preload[DISPLACEMENT_MM] = displacement_mm;
    step.from_preload[FORCE_X_N] = force_x_n;
    step.from_preload[FORCE_Z_N] = force_z_n;
    const brace_status_t status = brace_check(slope, step.from_preload, BRACE_INPUT_READING);
    if (status != BRACE_OK) {
        return status;
    }
    if (slope->used + slope->skipped >= STEPS_LIMIT) {
        return BRACE_E_RANGE;
    }
    const float step_mm = step.from_preload[DISPLACEMENT_MM] - slope->preload[DISPLACEMENT_MM];
    if (brace_magnitude_bits(step_mm) < brace_magnitude_bits(SMALLEST_STEP_MM)) {
        slope->skipped++;
        return BRACE_OK;
    }
    slope->used++;
    const float newest = 1.0f / (float)slope->used;
    for (int i = 0; i < READING_COUNT; i++) {
        step.from_preload[i] -= slope->preload[i];
        step.from_mean[i] = step.from_preload[i] - slope->mean[i];
        slope->mean[i] += newest * step.from_mean[i];
    }
    extend_line(&slope->line[BRACE_SLOPE_MEAN_OF_RATIOS], 1.0f / (step_mm * step_mm), step.from_preload);
    extend_line(&slope->line[BRACE_SLOPE_LEAST_SQUARES], 1.0f, step.from_preload);
    extend_line(&slope->line[BRACE_SLOPE_FREE_INTERCEPT], 1.0f - newest, step.from_mean);
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
    if (freedom <= 0 || !(line->spread > 0.0f)) {
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
    brace_slope_column_t x;
    brace_slope_column_t z;
    brace_status_t status = brace_slope_column(along_x, method, &x);
    if (status == BRACE_OK) {
        status = brace_slope_column(along_z, method, &z);
    }
    if (status != BRACE_OK) {
        return status;
    }
    stiffness->k_xx_n_per_mm = x.k_x_n_per_mm;
    stiffness->k_xz_n_per_mm = z.k_x_n_per_mm;
    stiffness->k_zx_n_per_mm = x.k_z_n_per_mm;
    stiffness->k_zz_n_per_mm = z.k_z_n_per_mm;
    stiffness->sigma_k_xx_n_per_mm = x.sigma_k_x_n_per_mm;
    stiffness->sigma_k_xz_n_per_mm = z.sigma_k_x_n_per_mm;
    stiffness->sigma_k_zx_n_per_mm = x.sigma_k_z_n_per_mm;
    stiffness->sigma_k_zz_n_per_mm = z.sigma_k_z_n_per_mm;
    stiffness->asymmetry_n_per_mm = z.k_x_n_per_mm - x.k_z_n_per_mm;
    const float variance_asymmetry = square(z.sigma_k_x_n_per_mm) + square(x.sigma_k_z_n_per_mm);
    stiffness->sigma_asymmetry_n_per_mm = brace_sqrt(variance_asymmetry);

    brace_stiffness_t *symmetric = &stiffness->symmetric;
    const float cross = 0.5f * (z.k_x_n_per_mm + x.k_z_n_per_mm);
    const float mean = 0.5f * (x.k_x_n_per_mm + z.k_z_n_per_mm);
    const float deviation = 0.5f * (x.k_x_n_per_mm - z.k_z_n_per_mm);
    const float radius = brace_length(deviation, cross);
    symmetric->k_xx_n_per_mm = x.k_x_n_per_mm;
    symmetric->k_xz_n_per_mm = cross;
    symmetric->k_zz_n_per_mm = z.k_z_n_per_mm;
    symmetric->lambda_min_n_per_mm = mean - radius;
    symmetric->lambda_max_n_per_mm = mean + radius;
    symmetric->stiff_axis_rad = 0.5f * brace_atan2(cross, deviation);
    const brace_vec_t stiff = brace_direction(brace_turn(symmetric->stiff_axis_rad));
    const float sigma = brace_sqrt(square(square(stiff.z) * x.sigma_k_x_n_per_mm) +
                                   square(square(stiff.x) * z.sigma_k_z_n_per_mm) +
                                   square(stiff.z * stiff.x) * variance_asymmetry);
    stiffness->sigma_lambda_min_n_per_mm = sigma;
    symmetric->flags = symmetric->lambda_min_n_per_mm > sigma ? 0u : (uint32_t)BRACE_FLAG_NEAR_SINGULAR;
    return BRACE_OK;
}
