#include "brace/slope.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "base/vec.h"

#define DISPLACEMENT_LIMIT_MM 1e4f
#define FORCE_LIMIT_N 1e6f
#define SMALLEST_STEP_MM 1e-6f
#define STEPS_LIMIT (1u << 24)

/* First value of a fit's spread. It keeps divisions finite, and is too small to change a sum with a step in it. */
#define NEARLY_NOTHING FLT_MIN

static float square(float value)
{
    return value * value;
}

static brace_status_t check_reading(float displacement_mm, float force_x_n, float force_z_n)
{
    return brace_first_refusal(brace_check_magnitude(displacement_mm, DISPLACEMENT_LIMIT_MM),
                               brace_check_two(force_x_n, force_z_n, FORCE_LIMIT_N));
}

brace_status_t brace_slope_start(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n)
{
    if (slope == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_reading(displacement_mm, force_x_n, force_z_n);
    if (status != BRACE_OK) {
        return status;
    }
    *slope = (brace_slope_t){.preload = {displacement_mm, force_x_n, force_z_n}};
    for (int method = 0; method < BRACE_SLOPE_METHOD_COUNT; method++) {
        slope->fit[method].spread = NEARLY_NOTHING;
    }
    return BRACE_OK;
}

static brace_slope_reading_t minus(brace_slope_reading_t a, brace_slope_reading_t b)
{
    return (brace_slope_reading_t){a.displacement_mm - b.displacement_mm, a.force_x_n - b.force_x_n,
                                   a.force_z_n - b.force_z_n};
}

static brace_slope_reading_t scaled(brace_slope_reading_t a, float by)
{
    return (brace_slope_reading_t){a.displacement_mm * by, a.force_x_n * by, a.force_z_n * by};
}

/* Takes one step into a line. The surprise is the step's deviation from the line; the slope moves by gain times the
 * surprise. The residual grows by the share of the surprise that the new slope leaves unexplained, so only positive
 * terms are added. */
static void extend_line(brace_slope_line_t *line, float displacement, float force, float gain, float unexplained)
{
    const float surprise = force - line->slope * displacement;
    line->residual += unexplained * surprise * surprise;
    line->slope += gain * surprise;
}

static void extend(brace_slope_fit_t *fit, brace_slope_reading_t step)
{
    const float spread = fit->spread + square(step.displacement_mm);
    const float gain = step.displacement_mm / spread, unexplained = fit->spread / spread;
    extend_line(&fit->x, step.displacement_mm, step.force_x_n, gain, unexplained);
    extend_line(&fit->z, step.displacement_mm, step.force_z_n, gain, unexplained);
    fit->spread = spread;
}

/* All three methods are a least-squares line through the origin; they differ in what counts as a step.
 * - Least squares takes the step from the preload point.
 * - The mean of ratios divides that step by its displacement.
 * - The free intercept takes the step from the mean of the steps before it. The new step moves that mean too, by 1/n,
 * so
 *   the step counts with the root of the remaining share, 1 - 1/n. */
brace_status_t brace_slope_step(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n)
{
    if (slope == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_reading(displacement_mm, force_x_n, force_z_n);
    if (status != BRACE_OK) {
        return status;
    }
    if (slope->used + slope->skipped >= STEPS_LIMIT) {
        return BRACE_E_RANGE;
    }
    const brace_slope_reading_t reading = {displacement_mm, force_x_n, force_z_n};
    const brace_slope_reading_t step = minus(reading, slope->preload);
    if (fabsf(step.displacement_mm) < SMALLEST_STEP_MM) {
        slope->skipped++;
        return BRACE_OK;
    }
    slope->used++;
    const float share = 1.0f / (float)slope->used;
    const brace_slope_reading_t from_mean = minus(step, slope->mean);
    extend(&slope->fit[BRACE_SLOPE_LEAST_SQUARES], step);
    extend(&slope->fit[BRACE_SLOPE_MEAN_OF_RATIOS],
           (brace_slope_reading_t){1.0f, step.force_x_n / step.displacement_mm, step.force_z_n / step.displacement_mm});
    extend(&slope->fit[BRACE_SLOPE_FREE_INTERCEPT], scaled(from_mean, sqrtf(1.0f - share)));
    slope->mean.displacement_mm += share * from_mean.displacement_mm;
    slope->mean.force_x_n += share * from_mean.force_x_n;
    slope->mean.force_z_n += share * from_mean.force_z_n;
    return BRACE_OK;
}

brace_status_t brace_slope_column(const brace_slope_t *slope, brace_slope_method_t method, brace_slope_column_t *column)
{
    if (slope == NULL || column == NULL) {
        return BRACE_E_NULL;
    }
    if ((unsigned)method >= BRACE_SLOPE_METHOD_COUNT) {
        return BRACE_E_RANGE;
    }
    const brace_slope_fit_t *fit = &slope->fit[method];
    const int32_t freedom = (int32_t)slope->used - (method == BRACE_SLOPE_FREE_INTERCEPT ? 2 : 1);
    if (freedom <= 0 || fit->spread <= NEARLY_NOTHING) {
        return BRACE_E_TOO_FEW;
    }
    const float spread = (float)freedom * fit->spread;
    *column = (brace_slope_column_t){
        .k_x_n_per_mm = fit->x.slope,
        .k_z_n_per_mm = fit->z.slope,
        .sigma_k_x_n_per_mm = sqrtf(fit->x.residual / spread),
        .sigma_k_z_n_per_mm = sqrtf(fit->z.residual / spread),
        .used = slope->used,
        .skipped = slope->skipped,
    };
    return BRACE_OK;
}

/* The symmetric part of a measured K. lambda_min is a difference here and may be negative, because a measured K, unlike
 * a computed one, need not be positive definite. */
static brace_stiffness_t symmetric_part(const brace_slope_stiffness_t *measured)
{
    const float xz = 0.5f * (measured->k_xz_n_per_mm + measured->k_zx_n_per_mm);
    const float mean = 0.5f * (measured->k_xx_n_per_mm + measured->k_zz_n_per_mm);
    const float dev_x = 0.5f * (measured->k_xx_n_per_mm - measured->k_zz_n_per_mm);
    const float radius = vec_length((brace_vec_t){dev_x, xz});
    return (brace_stiffness_t){
        .k_xx_n_per_mm = measured->k_xx_n_per_mm,
        .k_xz_n_per_mm = xz,
        .k_zz_n_per_mm = measured->k_zz_n_per_mm,
        .lambda_min_n_per_mm = mean - radius,
        .lambda_max_n_per_mm = mean + radius,
        .stiff_axis_rad = 0.5f * brace_atan2(xz, dev_x),
    };
}

/* One sigma of lambda_min = soft' K soft, where soft is the unit vector across the stiff axis. The entry K_xz of the
 * symmetric part has half of the asymmetry's sigma, and counts twice. */
static float sigma_of_lambda_min(const brace_slope_stiffness_t *measured, brace_vec_t stiff)
{
    return sqrtf(square(square(stiff.z) * measured->sigma_k_xx_n_per_mm) +
                 square(square(stiff.x) * measured->sigma_k_zz_n_per_mm) +
                 square(stiff.z * stiff.x * measured->sigma_asymmetry_n_per_mm));
}

brace_status_t brace_slope_stiffness(const brace_slope_t *along_x, const brace_slope_t *along_z,
                                     brace_slope_method_t method, brace_slope_stiffness_t *stiffness)
{
    if (stiffness == NULL) {
        return BRACE_E_NULL;
    }
    brace_slope_column_t by_x, by_z;
    const brace_status_t status =
        brace_first_refusal(brace_slope_column(along_x, method, &by_x), brace_slope_column(along_z, method, &by_z));
    if (status != BRACE_OK) {
        return status;
    }
    *stiffness = (brace_slope_stiffness_t){
        .k_xx_n_per_mm = by_x.k_x_n_per_mm,
        .k_xz_n_per_mm = by_z.k_x_n_per_mm,
        .k_zx_n_per_mm = by_x.k_z_n_per_mm,
        .k_zz_n_per_mm = by_z.k_z_n_per_mm,
        .sigma_k_xx_n_per_mm = by_x.sigma_k_x_n_per_mm,
        .sigma_k_xz_n_per_mm = by_z.sigma_k_x_n_per_mm,
        .sigma_k_zx_n_per_mm = by_x.sigma_k_z_n_per_mm,
        .sigma_k_zz_n_per_mm = by_z.sigma_k_z_n_per_mm,
    };
    stiffness->asymmetry_n_per_mm = stiffness->k_xz_n_per_mm - stiffness->k_zx_n_per_mm;
    stiffness->sigma_asymmetry_n_per_mm =
        vec_length((brace_vec_t){stiffness->sigma_k_xz_n_per_mm, stiffness->sigma_k_zx_n_per_mm});
    stiffness->symmetric = symmetric_part(stiffness);
    stiffness->sigma_lambda_min_n_per_mm =
        sigma_of_lambda_min(stiffness, brace_direction(stiffness->symmetric.stiff_axis_rad));
    const bool is_determined = stiffness->symmetric.lambda_min_n_per_mm > stiffness->sigma_lambda_min_n_per_mm;
    stiffness->symmetric.flags = is_determined ? 0u : (uint32_t)BRACE_FLAG_NEAR_SINGULAR;
    return BRACE_OK;
}
