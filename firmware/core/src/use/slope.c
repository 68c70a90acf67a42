#include "brace/slope.h"

#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"

#define DISPLACEMENT_LIMIT_MM 1e4f
#define FORCE_LIMIT_N 1e6f
#define SMALLEST_STEP_MM 1e-6f
#define STEPS_LIMIT (1u << 24)

/* What a reading holds. */
enum { DISPLACEMENT_MM, FORCE_X_N, FORCE_Z_N, READING_COUNT };

/* All three estimates are one thing, a weighted least-squares line through a point: through the preload point
 * with weight 1/displacement^2, the mean of ratios, or with weight one; or through the mean, where the weight
 * is what is left of a step once it has also moved the mean. A new step shifts the slope by its surprise, and
 * the residual grows by the part of the surprise that the shift does not explain: positive terms only. */
BRACE_OFF_TICK
static void extend_line(brace_slope_line_t *line, float weight, const float step[READING_COUNT])
{
    const float displacement = step[DISPLACEMENT_MM];
    float gain = weight * displacement;
    const float spread = line->spread + gain * displacement;
    if (!(spread > 0.0f)) {
        return;
    }
    gain /= spread;
    const float unexplained = weight * line->spread / spread;
    for (int i = 0; i < 2; i++) {
        const float surprise = step[FORCE_X_N + i] - line->slope[i] * displacement;
        line->residual[i] += unexplained * surprise * surprise;
        line->slope[i] += gain * surprise;
    }
    line->spread = spread;
}

BRACE_OFF_TICK
static brace_status_t check_reading(const brace_slope_t *slope, const float reading[READING_COUNT])
{
    if (slope == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_magnitude(reading[DISPLACEMENT_MM], DISPLACEMENT_LIMIT_MM);
    return status != BRACE_OK ? status
                              : brace_check_two(reading[FORCE_X_N], reading[FORCE_Z_N], FORCE_LIMIT_N);
}

BRACE_OFF_TICK
brace_status_t brace_slope_start(brace_slope_t *slope, float displacement_mm, float force_x_n,
                                 float force_z_n)
{
    const float reading[READING_COUNT] = {displacement_mm, force_x_n, force_z_n};
    const brace_status_t status = check_reading(slope, reading);
    if (status != BRACE_OK) {
        return status;
    }
    slope->preload[DISPLACEMENT_MM] = reading[DISPLACEMENT_MM];
    slope->preload[FORCE_X_N] = reading[FORCE_X_N];
    slope->preload[FORCE_Z_N] = reading[FORCE_Z_N];
    slope->used = slope->skipped = 0;
    slope->mean[0] = slope->mean[1] = slope->mean[2] = 0.0f;
    for (brace_slope_line_t *line = slope->line; line < slope->line + BRACE_SLOPE_METHOD_COUNT; line++) {
        /* one by one: all at once would be a call of the C library's memset */
        line->spread = line->slope[0] = line->slope[1] = line->residual[0] = line->residual[1] = 0.0f;
    }
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_slope_step(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n)
{
    const float reading[READING_COUNT] = {displacement_mm, force_x_n, force_z_n};
    const brace_status_t status = check_reading(slope, reading);
    if (status != BRACE_OK) {
        return status;
    }
    if (slope->used + slope->skipped >= STEPS_LIMIT) {
        return BRACE_E_RANGE;
    }
    const float step_mm = reading[DISPLACEMENT_MM] - slope->preload[DISPLACEMENT_MM];
    if (__builtin_fabsf(step_mm) < SMALLEST_STEP_MM) {
        slope->skipped++;
        return BRACE_OK;
    }
    slope->used++;
    const float newest = 1.0f / (float)slope->used;
    float step[READING_COUNT];
    float from_mean[READING_COUNT];
    for (int i = 0; i < READING_COUNT; i++) {
        step[i] = reading[i] - slope->preload[i];
        from_mean[i] = step[i] - slope->mean[i];
        slope->mean[i] += newest * from_mean[i];
    }
    extend_line(&slope->line[BRACE_SLOPE_MEAN_OF_RATIOS], 1.0f / (step_mm * step_mm), step);
    extend_line(&slope->line[BRACE_SLOPE_LEAST_SQUARES], 1.0f, step);
    extend_line(&slope->line[BRACE_SLOPE_FREE_INTERCEPT], 1.0f - newest, from_mean);
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
    const uint32_t fitted = method == BRACE_SLOPE_FREE_INTERCEPT ? 2 : 1;
    if (slope->used <= fitted || !(line->spread > 0.0f)) {
        return BRACE_E_TOO_FEW;
    }
    const float per_freedom = 1.0f / ((float)(slope->used - fitted) * line->spread);
    column->k_x_n_per_mm = line->slope[0];
    column->k_z_n_per_mm = line->slope[1];
    column->sigma_k_x_n_per_mm = brace_sqrt(line->residual[0] * per_freedom);
    column->sigma_k_z_n_per_mm = brace_sqrt(line->residual[1] * per_freedom);
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
    const float cross = 0.5f * (z.k_x_n_per_mm + x.k_z_n_per_mm);
    const float mean = 0.5f * (x.k_x_n_per_mm + z.k_z_n_per_mm);
    const float deviation = 0.5f * (x.k_x_n_per_mm - z.k_z_n_per_mm);
    const float radius = brace_sqrt(square(deviation) + square(cross));
    const float axis_rad = 0.5f * brace_atan2(cross, deviation);
    const brace_vec_t stiff = brace_direction(brace_turn(axis_rad));
    const float variance_asymmetry = square(z.sigma_k_x_n_per_mm) + square(x.sigma_k_z_n_per_mm);
    const float sigma_lambda_min = brace_sqrt(square(square(stiff.z) * x.sigma_k_x_n_per_mm) +
                                              square(square(stiff.x) * z.sigma_k_z_n_per_mm) +
                                              square(stiff.z * stiff.x) * variance_asymmetry);

    stiffness->k_xx_n_per_mm = x.k_x_n_per_mm;
    stiffness->k_xz_n_per_mm = z.k_x_n_per_mm;
    stiffness->k_zx_n_per_mm = x.k_z_n_per_mm;
    stiffness->k_zz_n_per_mm = z.k_z_n_per_mm;
    stiffness->sigma_k_xx_n_per_mm = x.sigma_k_x_n_per_mm;
    stiffness->sigma_k_xz_n_per_mm = z.sigma_k_x_n_per_mm;
    stiffness->sigma_k_zx_n_per_mm = x.sigma_k_z_n_per_mm;
    stiffness->sigma_k_zz_n_per_mm = z.sigma_k_z_n_per_mm;
    stiffness->asymmetry_n_per_mm = z.k_x_n_per_mm - x.k_z_n_per_mm;
    stiffness->sigma_asymmetry_n_per_mm = brace_sqrt(variance_asymmetry);
    stiffness->sigma_lambda_min_n_per_mm = sigma_lambda_min;
    stiffness->symmetric = (brace_stiffness_t){
        .k_xx_n_per_mm = x.k_x_n_per_mm,
        .k_xz_n_per_mm = cross,
        .k_zz_n_per_mm = z.k_z_n_per_mm,
        .lambda_min_n_per_mm = mean - radius,
        .lambda_max_n_per_mm = mean + radius,
        .stiff_axis_rad = axis_rad,
        .flags = mean - radius > sigma_lambda_min ? 0u : (uint32_t)BRACE_FLAG_NEAR_SINGULAR,
    };
    return BRACE_OK;
}
