#include "brace/slope.h"

#include <stddef.h>

#include "check.h"
#include "trig.h"

#define DISPLACEMENT_LIMIT_MM 1e4f
#define FORCE_LIMIT_N 1e6f
#define SMALLEST_STEP_MM 1e-6f
#define STEPS_LIMIT (1u << 24)

/* All three estimates are one thing, a least-squares line through a point, fed differently: the ratio with
 * displacement one, the step from the preload point, or the step from the mean. The share is what is left of
 * a step once it has also moved the mean. A new step shifts the slope by its surprise, and the residual grows
 * by the part of the surprise that the shift does not explain: positive terms only. */
static void extend_line(brace_slope_line_t *line, float share, float displacement, float force_x,
                        float force_z)
{
    const float gain = share * displacement;
    const float spread = line->spread + gain * displacement;
    if (!(spread > 0.0f)) {
        return;
    }
    const float per_spread = 1.0f / spread;
    const float surprise_x = force_x - line->slope[0] * displacement;
    const float surprise_z = force_z - line->slope[1] * displacement;
    const float unexplained = share * line->spread * per_spread;
    line->residual[0] += unexplained * surprise_x * surprise_x;
    line->residual[1] += unexplained * surprise_z * surprise_z;
    line->slope[0] += gain * per_spread * surprise_x;
    line->slope[1] += gain * per_spread * surprise_z;
    line->spread = spread;
}

static brace_status_t check_reading(const brace_slope_t *slope, float displacement_mm, float force_x_n,
                                    float force_z_n)
{
    if (slope == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_magnitude(displacement_mm, DISPLACEMENT_LIMIT_MM);
    if (status == BRACE_OK) {
        status = brace_check_two(force_x_n, force_z_n, FORCE_LIMIT_N);
    }
    return status;
}

brace_status_t brace_slope_start(brace_slope_t *slope, float displacement_mm, float force_x_n,
                                 float force_z_n)
{
    const brace_status_t status = check_reading(slope, displacement_mm, force_x_n, force_z_n);
    if (status == BRACE_OK) {
        *slope = (brace_slope_t){.preload_mm = displacement_mm, .preload_n = {force_x_n, force_z_n}};
    }
    return status;
}

brace_status_t brace_slope_step(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n)
{
    const brace_status_t status = check_reading(slope, displacement_mm, force_x_n, force_z_n);
    if (status != BRACE_OK) {
        return status;
    }
    if (slope->used >= STEPS_LIMIT || slope->skipped >= STEPS_LIMIT) {
        return BRACE_E_RANGE;
    }
    const float step_mm = displacement_mm - slope->preload_mm;
    if (step_mm > -SMALLEST_STEP_MM && step_mm < SMALLEST_STEP_MM) {
        slope->skipped++;
        return BRACE_OK;
    }
    slope->used++;
    const float step_x_n = force_x_n - slope->preload_n[0];
    const float step_z_n = force_z_n - slope->preload_n[1];
    const float from_mean_mm = step_mm - slope->mean_mm;
    const float from_mean_x_n = step_x_n - slope->mean_n[0];
    const float from_mean_z_n = step_z_n - slope->mean_n[1];
    const float newest = 1.0f / (float)slope->used;
    const float per_mm = 1.0f / step_mm;

    extend_line(&slope->line[BRACE_SLOPE_MEAN_OF_RATIOS], 1.0f, 1.0f, step_x_n * per_mm, step_z_n * per_mm);
    extend_line(&slope->line[BRACE_SLOPE_LEAST_SQUARES], 1.0f, step_mm, step_x_n, step_z_n);
    extend_line(&slope->line[BRACE_SLOPE_FREE_INTERCEPT], 1.0f - newest, from_mean_mm, from_mean_x_n,
                from_mean_z_n);
    slope->mean_mm += newest * from_mean_mm;
    slope->mean_n[0] += newest * from_mean_x_n;
    slope->mean_n[1] += newest * from_mean_z_n;
    return BRACE_OK;
}

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
