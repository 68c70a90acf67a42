/* K in space under a load: the equilibrium of a limb with its coxa joint under the force of the ground and its own
 * weight, and K there.
 *
 * As brace/loaded.h, for a force from any side. What yields is what docs/physics.md lists under "Under load": base
 * slides and base rotation, coxa joint, coxa link, femur joint, femur, knee, tibia. Links bend in the plane and across
 * it, twist and stretch. docs/kernel.md ("In space under a load") has the formulas.
 *
 * Frames: all is in the frame of the commanded limb's plane: x outwards, y to the left, z up. brace_loaded_space_turn
 * carries K into the robot's frame.
 *
 * Thread rule: pure functions of their arguments; any thread or interrupt that may use the FPU.
 */
#ifndef BRACE_LOADED_SPACE_H
#define BRACE_LOADED_SPACE_H

#include <stdbool.h>

#include "brace/limb.h"
#include "brace/loaded_space_types.h"
#include "brace/status.h"

/* Collapses a limb. Call it when parameters change.
 * limb: one that brace_limb_check accepts. weights: each 0 to 1e6 N, not checked. No pointer may be null.
 * Cost on a Cortex-M4F: at most 700 instructions. */
void brace_loaded_space_collapse(const brace_limb_t *limb, const brace_gravity_t *weights,
                                 brace_loaded_space_t *loaded);

/* The equilibrium at commanded (or measured) true angles under a load. Then brace_loaded_space_stiffness tells K there.
 * No pointer may be null. theta1_rad, theta2_rad: theta1^2 + theta2^2 <= BRACE_REACH_RAD2.
 * load: the force is checked; direction and compliances are not.
 * rest: room to work in, and the equilibrium after BRACE_OK.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE, or BRACE_E_SINGULAR: four steps do not come near an equilibrium
 *         (they leave more than some 0.025 rad), or come to one far from the commanded posture: the links' own turns
 *         together beyond 1.5 rad, base and coxa joint beyond 1 rad, another joint beyond 1.5 rad. The third is taken
 *         where two steps leave more than 0.001 rad, and the fourth where the third leaves more than that.
 * Cost on a Cortex-M4F: 3,100 instructions where two steps are enough, 4,900 after three, at most 6,300; stack at most
 *         900 bytes. */
brace_status_t brace_loaded_space_settle(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                         const brace_space_load_t *load, brace_space_rest_t *rest);

/* The same for who has the time: goes on from where brace_loaded_space_settle left `rest` after BRACE_OK, to what is
 * rounded away, or after BRACE_E_SINGULAR. Where further steps lead nowhere, it raises the load from none, share by
 * share. loaded: the same. returns as brace_loaded_space_settle, without its refusals of inputs.
 * Cost on a Cortex-M4F: mostly 3,500 instructions, at most 800,000. Not for the tick; stack at most 1,500 bytes. */
brace_status_t brace_loaded_space_settle_on(const brace_loaded_space_t *loaded, brace_space_rest_t *rest);

/* The same for who follows a limb from tick to tick: takes one step from the rest of the tick before, and leaves what
 * that does not reach to the next tick. So the rest of a standing limb is exact to rounding after a few ticks. Where
 * is_rest is false, or the load has changed by more than half of itself, two steps are taken from the straight limb.
 * is_rest: `rest` is of the same limb at a posture nearby, as this call or brace_loaded_space_settle has left it; after
 *         BRACE_E_SINGULAR too. rest (in, out): else room to work in.
 * returns as brace_loaded_space_settle, for these steps: BRACE_E_SINGULAR also where the next ones may come near.
 * Cost on a Cortex-M4F: at most 3,500 instructions; stack at most 900 bytes. */
brace_status_t brace_loaded_space_follow(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                         const brace_space_load_t *load, bool is_rest, brace_space_rest_t *rest);

/* K at an equilibrium, and how the limb stands there.
 * loaded, rest: what brace_loaded_space_settle was given and left. result: written on success only.
 * returns BRACE_OK, or BRACE_E_SINGULAR: the equilibrium is not stable, or nothing yields in some direction.
 * Accuracy: where the buckling factor is at least 2 and the tip moves by at most a fifth of the reach, K within 1 %
 *         (Frobenius norm; median 0.01 %) without a flag after brace_loaded_space_settle_on; after
 *         brace_loaded_space_settle alone in all but one of 5,700 random limbs, that one within 1.1 %, as after
 *         brace_loaded_space_follow. The displacement
 *         within 2 mm. result->flags has BRACE_FLAG_NEAR_SINGULAR where a link bends by more than 0.3 rad within
 *         itself, or where the steps have left more than 0.005 rad. At a tenth of such a load K within 0.08 %, at no
 *         load within 2e-7 of itself for each unit of C's condition number (3e-5 for random limbs).
 *         tests/judges/engine/test_core_in_space_under_load.py judges.
 * Cost on a Cortex-M4F: at most 3,300 instructions, the same for every posture; stack at most 950 bytes. */
brace_status_t brace_loaded_space_stiffness(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest,
                                            brace_space_result_t *result);

/* Both together in steps, for a controller that cannot spend so much at once. Begin; after BRACE_OK step with the same
 * loaded and work until a step, the ninth at the latest, returns true: the sixth where two steps towards the
 * equilibrium are enough, the eighth after three. The same bits come out.
 * No pointer may be null. status (out): as the two calls above. result: written by the last step, on BRACE_OK only.
 * brace_loaded_space_begin returns as brace_loaded_space_settle.
 * Cost on a Cortex-M4F: to begin 140 instructions, a step at most 1,150; stack at most 600 bytes. */
brace_status_t brace_loaded_space_begin(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                        const brace_space_load_t *load, brace_space_work_t *work);
bool brace_loaded_space_step(const brace_loaded_space_t *loaded, brace_space_work_t *work, brace_space_result_t *result,
                             brace_status_t *status);

/* K in the limb's plane, the tip held across it.
 * No pointer may be null; plane: written on success only.
 * returns BRACE_OK, or BRACE_E_SINGULAR: nothing is stiff in some direction. Cost: 120 instructions. */
brace_status_t brace_loaded_space_in_plane(const brace_k3_t *k, brace_stiffness_t *plane);

/* K in the robot's frame, its eigenvalues and its stiff axis, from any K in the limb's plane's frame.
 * No pointer may be null. theta0_rad: true angle [-7.9, 7.9].
 * stiffness: written on success only. lambda_n_per_mm ascends, each within 3e-7 of the largest one's size. stiff_axis
 *            is a unit vector that points outwards in the limb's plane or, if the limb is stiffest across it, to the
 *            left. flags: BRACE_FLAG_NEAR_SINGULAR where the least eigenvalue is below 1e-4 of the largest.
 * returns BRACE_OK, BRACE_E_NOT_FINITE or BRACE_E_RANGE (theta0), or BRACE_E_SINGULAR: an eigenvalue is not positive.
 * Cost on a Cortex-M4F: at most 550 instructions. */
brace_status_t brace_loaded_space_turn(float theta0_rad, const brace_k3_t *k, brace_stiffness_spatial_t *stiffness);

/* The smallest positive s for which diag(k) - s G is singular at this equilibrium with the posture held, as
 * brace/loaded.h says; infinity where it is above 16, and where it may be above 11.
 * loaded, rest: what brace_loaded_space_settle was given and left; neither may be null.
 * Accuracy: of 600 random limbs with a factor from 2 to 10, median 0.05 %, nine of ten within 0.4 %, 99 of 100 within
 *         1.7 %, 0.7 % of them beyond 2 %, the worst 8.7 %. Those are limbs whose short coxa link bends by large angles
 *         within itself.
 *         tests/judges/engine/test_core_in_space_under_load.py judges.
 * Cost on a Cortex-M4F: at most 13,000 instructions; stack at most 950 bytes. */
float brace_loaded_space_buckling_factor(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest);

/* The same in steps, for a controller that cannot spend so much at once. Begin, which writes the shape; then step with
 * the same loaded and shape until a step, the fifteenth, returns true; factor is written then. No pointer may be null.
 * Cost on a Cortex-M4F: to begin 1,200 instructions, a step at most 1,300. */
void brace_loaded_space_buckling_begin(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest,
                                       brace_space_shape_t *shape, brace_space_search_t *search);
bool brace_loaded_space_buckling_step(const brace_loaded_space_t *loaded, const brace_space_shape_t *shape,
                                      brace_space_search_t *search, float *factor);

#endif
