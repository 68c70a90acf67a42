/* K in the limb's plane under a load, on a controller without a floating-point unit: brace/loaded.h in 32-bit integers.
 * The same limb, the same equations, the same steps, the same result type.
 *
 * Lengths are in units of a power of two above the limb's reach, forces in units of a power of two above the sum of the
 * loads. docs/kernel.md says why every number then fits into its word, and what is refused because it would not.
 *
 * Thread rule: pure functions of their arguments; safe from any context once they are not written.
 */
#ifndef BRACE_LOADED_FIXED_H
#define BRACE_LOADED_FIXED_H

#include "brace/loaded.h"
#include "brace/loaded_fixed_types.h"

/* The limb's constants as scaled integers. Where a number of `loaded` is NaN or does not fit its scaled
 * integer, or a weight is negative, `fixed` is marked as unusable, and brace_loaded_fixed_stiffness returns
 * BRACE_E_SINGULAR.
 * loaded: from brace_loaded_collapse. No pointer may be null.
 * Cost: once per parameter change; float and double, in software where there is no FPU. */
void brace_loaded_fixed_collapse(const brace_loaded_t *loaded, brace_loaded_fixed_t *fixed);

/* As brace_loaded_stiffness, also in what it refuses, except that
 *   BRACE_E_RANGE: also where a component of `down` is beyond 1 by more than a thousandth, or not a number;
 *   BRACE_E_SINGULAR: also where a spring or a joint yields so much under this load, or is so softened by it, that a
 *     word does not hold it: a joint that would turn by 2 rad under the whole force at the whole reach, a spring that
 *     would move by a quarter of the reach, a pivot below 1/16 or a lever of 8 times the reach (its limb's buckling
 *     factor is near 1), det C below 3e-8 of its squared mean, and a limb of which nothing yields by 1e-12 mm/N.
 * result: written on success only.
 * Accuracy: as brace_loaded_stiffness, and at most 1e-4 of lambda_max more for the rounding. At no load K within 2e-6
 *         of lambda_max where det C is above 1e-3 of its squared mean, less exact the more slender the limb.
 *         tests/judges/engine/test_core_under_load.py judges random limbs.
 * Cost on a Cortex-M3: at most 6,000 instructions, 5,859 to 5,990 on the bench: the search for the buckling factor
 *         differs from posture to posture. Stack at most 700 bytes. */
brace_status_t brace_loaded_fixed_stiffness(const brace_loaded_fixed_t *fixed, float theta1_rad, float theta2_rad,
                                            const brace_load_t *load, brace_loaded_stiffness_t *result);

/* The same for who follows a limb from tick to tick, as brace_loaded_follow.
 * is_bent: `place` is of the same limb at a posture nearby, as this call has left it; after BRACE_E_SINGULAR too.
 * place (in, out): else room to work in. result: written on success only.
 * returns as brace_loaded_fixed_stiffness, for these steps, as brace_loaded_follow.
 * Cost on a Cortex-M3: at most 6,500 instructions; stack at most 750 bytes. */
brace_status_t brace_loaded_fixed_follow(const brace_loaded_fixed_t *fixed, float theta1_rad, float theta2_rad,
                                         const brace_load_t *load, bool is_bent, brace_loaded_fixed_place_t *place,
                                         brace_loaded_stiffness_t *result);

#endif
