/* K of the planar limb from a table over the knee angle: where memory is cheaper than instructions.
 *
 * Eigenvalues, and the stiff axis as seen from the bisector of femur and tibia, depend on the knee angle alone. Each of
 * 256 equal stretches of a turn has a parabola or cubic for each; K follows with one division and one sine and cosine.
 * The table is the caller's memory, filled when parameters change; or built on a host and linked as a constant.
 */
#ifndef BRACE_PLANAR_TABLE_H
#define BRACE_PLANAR_TABLE_H

#include <stdint.h>

#include "brace/planar.h"

enum { BRACE_PLANAR_TABLE_ROWS = 256, BRACE_PLANAR_TABLE_SINES = 2560 };

/* One stretch; d in [-1, 1] is the place in it. value = c0 + c1 d + c2 d^2 (+ c3 d^3). */
typedef struct {
    int64_t axis_c0_c1; /* twice the axis, 2^32 to a turn; c0 in the high word */
    int32_t axis_c2;
    float lambda_min_n_per_mm[3];
    float least_compliance_mm_per_n[4]; /* 1/lambda_max */
} brace_planar_table_row_t;

typedef struct {
    float half_sine[BRACE_PLANAR_TABLE_SINES]; /* five quarters of a turn */
    brace_planar_table_row_t row[BRACE_PLANAR_TABLE_ROWS];
} brace_planar_table_t;

/* Fills a table from a collapsed limb and checks every stretch of it against the tick it replaces.
 * table: its contents are of no use unless BRACE_OK is returned.
 * returns BRACE_OK, BRACE_E_NULL, or
 *         BRACE_E_UNSUPPORTED: K changes too fast with the knee angle for the table's accuracy (very slender or nearly
 *         round compliance at some posture); use brace_planar_stiffness.
 * Cost on a Cortex-M4F: about 800,000 instructions; 256 bytes of stack. Not while a tick reads the table. */
brace_status_t brace_planar_table_build(const brace_planar_t *planar, brace_planar_table_t *table);

/* K with eigenvalues and stiff axis at a posture.
 * table, stiffness: not null (not checked). theta1_rad, theta2_rad: true angles, theta1^2 + theta2^2 <=
 * BRACE_PLANAR_REACH_RAD2. stiffness: written on success only; flags are 0.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE.
 * Accuracy: each entry of K within 2e-6 of lambda_max, eigenvalues within 2e-6 of themselves, stiff axis within 1.5e-6
 * rad times lambda_max / (lambda_max - lambda_min).
 * Cost on a Cortex-M4F: the same straight line of at most 80 instructions for every posture; 24 bytes of stack. */
brace_status_t brace_planar_table_stiffness(const brace_planar_table_t *table, float theta1_rad, float theta2_rad,
                                            brace_stiffness_t *stiffness);

#endif
