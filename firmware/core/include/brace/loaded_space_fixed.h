/* K in space under a load, on a controller without a floating-point unit: brace/loaded_space.h in 32-bit integers. The
 * same limb, the same equations, the same steps, the same result types.
 *
 * Lengths are in units of a power of two above the limb's reach, forces in units of a power of two above the sum of the
 * loads. docs/kernel.md ("In space without FPU") says why every number then fits into its word, and what is refused
 * because it would not.
 *
 * Frames as in brace/loaded_space.h.
 * Thread rule: pure functions of their arguments; safe from any context once they are not written.
 */
#ifndef BRACE_LOADED_SPACE_FIXED_H
#define BRACE_LOADED_SPACE_FIXED_H

#include <stdbool.h>

#include "brace/buckling_search.h"
#include "brace/loaded_space_fixed_types.h"
#include "brace/loaded_space_types.h"
#include "brace/status.h"

/* The limb's constants as scaled integers.
 * loaded: from brace_loaded_space_collapse. No pointer may be null.
 * Cost: once per parameter change; float and double, in software where there is no FPU. */
void brace_loaded_space_fixed_collapse(const brace_loaded_space_t *loaded, brace_loaded_space_fixed_t *fixed);

/* As brace_loaded_space_settle, also in what it refuses, except that
 *   BRACE_E_RANGE: also where a component of `down` is beyond 1 by more than a thousandth, or not a number;
 *   BRACE_E_SINGULAR: also where something yields so much under this load, or is so softened by it, that a word does
 *     not hold it: where a joint or link would turn by 32 rad under the whole force at the whole reach, a joint, a link
 *     about itself or all before a joint turns by more than 1 rad, a spring moves by more than a quarter of the reach
 *     or, at the end of a beam, of about its length, a pivot is below 1/16 (the buckling factor is near 1), a beam is
 *     shorter than a millionth of the limb, or the limb is not 1 mm to 1 km long. One of 600 random
 *     limbs within the promise is refused for that.
 * No pointer may be null.
 * Cost on a Cortex-M3: 6,441 instructions, the same for every posture and load; stack at most 1,000 bytes. */
brace_status_t brace_loaded_space_fixed_settle(const brace_loaded_space_fixed_t *fixed, float theta1_rad,
                                               float theta2_rad, const brace_space_load_t *load,
                                               brace_space_fixed_rest_t *rest);

/* As brace_loaded_space_stiffness. fixed, rest: what brace_loaded_space_fixed_settle was given and left.
 * returns BRACE_E_SINGULAR also where the least eigenvalue of C is below some 2e-7 of the largest.
 * Accuracy: as brace_loaded_space_stiffness, and at most 1e-4 of K's norm more for the rounding (600 random limbs). At
 *         no load K within 2e-7 of itself for each unit of C's condition number.
 * Cost on a Cortex-M3: 7,611 instructions, the same for every posture and load; stack at most 1,700 bytes. */
brace_status_t brace_loaded_space_fixed_stiffness(const brace_loaded_space_fixed_t *fixed,
                                                  const brace_space_fixed_rest_t *rest,
                                                  brace_space_result_t *result);

/* The buckling factor in at most five steps, as brace_loaded_space_buckling_step, with links that are one part each:
 * step until one returns true. A step after that begins a new search.
 * factor: 1 where the limb buckles near the present load; NaN where a word does not hold what the search meets (1 of
 *         600 random limbs). From 2 to 10, median 0.1 %, nine of ten within 0.9 %, 96 of 100 within 2 %, the worst of
 *         600 13 %: a short, soft coxa link is one part.
 * Cost on a Cortex-M3: a step at most 6,700 instructions, the last 8,500. */
void brace_loaded_space_fixed_buckling_begin(brace_buckling_search_t *search);
bool brace_loaded_space_fixed_buckling_step(const brace_loaded_space_fixed_t *fixed,
                                            const brace_space_fixed_rest_t *rest, brace_buckling_search_t *search,
                                            float *factor);

/* As brace_loaded_space_in_plane and brace_loaded_space_turn, in integers; eigenvalues within 4e-7 of the largest one's
 * size. BRACE_E_SINGULAR also where K's largest entry is not within 1e-15 to 1e15, and where an eigenvalue is below
 * 4e-9 of it. Cost on a Cortex-M3: 202 and 1,555 instructions, the same for every K. */
brace_status_t brace_loaded_space_fixed_in_plane(const brace_k3_t *k, brace_stiffness_t *plane);
brace_status_t brace_loaded_space_fixed_turn(float theta0_rad, const brace_k3_t *k,
                                             brace_stiffness_spatial_t *stiffness);

#endif
