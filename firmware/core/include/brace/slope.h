/* Stiffness from a loading test: slopes of force over displacement, one step at a time.
 *
 * A test displaces the tip along one axis and reads both components of the force on the tip, so it gives one column of
 * K. Displacement and force count from the preload point, which is the reading taken once the backlash is taken up. The
 * state has a fixed size and stores no steps. Each step updates every sum by its own contribution, so neither a large
 * preload nor a long test costs accuracy.
 *
 * There are three estimates from the same steps:
 *   mean of ratios - the paper's: mean of force/displacement. Small steps weigh as much as large ones. For eight equal
 *     steps its variance is 4.9 times that of least squares, and backlash left in the joints biases it by
 *     -17 / -34 / -55 % for half a step, one step and two;
 *   least squares through the preload point - the best for a straight line and even noise; the default;
 *   least squares with a free intercept - for a preload reading that is not trusted. Backlash or a wrong preload
 *     changes only the intercept, if the tip has crossed the backlash before the first step.
 *
 * Thread rule: one caller per brace_slope_t; different ones are independent. No loop depends on data.
 */
#ifndef BRACE_SLOPE_H
#define BRACE_SLOPE_H

#include "brace/stiffness.h"

typedef enum {
    BRACE_SLOPE_LEAST_SQUARES = 0,
    BRACE_SLOPE_MEAN_OF_RATIOS = 1,
    BRACE_SLOPE_FREE_INTERCEPT = 2,
    BRACE_SLOPE_METHOD_COUNT = 3
} brace_slope_method_t;

/* A reading, or a difference of two. */
typedef struct {
    float displacement_mm, force_x_n, force_z_n;
} brace_slope_reading_t;

/* A least-squares line through the origin, of one force component over the displacement. */
typedef struct {
    float slope;    /* [N/mm] */
    float residual; /* sum of squares of the deviations from the line [N^2, or (N/mm)^2 for the mean of ratios] */
} brace_slope_line_t;

/* The lines of both components for one method, and their common sum of squares of displacement. */
typedef struct {
    float spread;
    brace_slope_line_t x, z;
} brace_slope_fit_t;

/* A test under way. brace_slope_start sets it up; read it through the functions below. */
typedef struct {
    brace_slope_reading_t preload;
    brace_slope_reading_t mean; /* mean of the steps so far, from the preload point */
    brace_slope_fit_t fit[BRACE_SLOPE_METHOD_COUNT];
    uint32_t used;
    uint32_t skipped;
} brace_slope_t;

/* A column of K with its one-sigma standard errors, from the steps' own scatter. Errors that all steps share (noise of
 * the preload reading, the sensor's gain) do not scatter, so the standard errors do not contain them. */
typedef struct {
    float k_x_n_per_mm; /* force along x per displacement along the test's axis */
    float k_z_n_per_mm;
    float sigma_k_x_n_per_mm;
    float sigma_k_z_n_per_mm;
    uint32_t used;    /* steps that count */
    uint32_t skipped; /* steps without displacement */
} brace_slope_column_t;

/* K from two tests. The first index is the force's axis, the second the displacement's. */
typedef struct {
    float k_xx_n_per_mm, k_xz_n_per_mm, k_zx_n_per_mm, k_zz_n_per_mm;
    float sigma_k_xx_n_per_mm, sigma_k_xz_n_per_mm, sigma_k_zx_n_per_mm, sigma_k_zz_n_per_mm;
    /* The cross-talk test: k_xz - k_zx is zero for an elastic limb and a true sensor (Maxwell-Betti). */
    float asymmetry_n_per_mm;
    float sigma_asymmetry_n_per_mm;
    float sigma_lambda_min_n_per_mm;
    /* Symmetrised K. Unlike a computed K it can have lambda_min <= 0. BRACE_FLAG_NEAR_SINGULAR: lambda_min is not
     * above its own sigma, so these tests do not determine it. */
    brace_stiffness_t symmetric;
} brace_slope_stiffness_t;

/* Begins a test at the preload point.
 *   displacement_mm [+-1e4]: along the test's axis; force_x_n, force_z_n [+-1e6]: on the limb's tip
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE; slope untouched unless BRACE_OK.
 * cost: at most 130 instructions on a Cortex-M4F; stack at most 50 bytes. */
brace_status_t brace_slope_start(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n);

/* Takes one reading, with the same arguments. A step within 1e-6 mm of the preload point says nothing about a slope:
 * it is counted as skipped, and the call returns BRACE_OK.
 * returns also BRACE_E_RANGE after 2^24 steps; slope untouched unless BRACE_OK.
 * cost: at most 240 instructions; stack at most 80 bytes. */
brace_status_t brace_slope_step(brace_slope_t *slope, float displacement_mm, float force_x_n, float force_z_n);

/* The column of K measured so far; the test may go on.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_RANGE (no such method), BRACE_E_TOO_FEW: fewer than two steps that
 *   count, with a free intercept fewer than three or all at one displacement; column untouched unless OK.
 * accuracy: slopes within 2e-6 relative to the largest ratio, up to a thousand steps.
 * cost: at most 50 instructions; stack at most 10 bytes. */
brace_status_t brace_slope_column(const brace_slope_t *slope, brace_slope_method_t method,
                                  brace_slope_column_t *column);

/* K from a test along x and a test along z.
 * returns as brace_slope_column; stiffness untouched unless BRACE_OK.
 * cost: at most 290 instructions; stack at most 150 bytes. */
brace_status_t brace_slope_stiffness(const brace_slope_t *along_x, const brace_slope_t *along_z,
                                     brace_slope_method_t method, brace_slope_stiffness_t *stiffness);

#endif
