/* K in the limb's plane under a load: the limb's equilibrium under the force of the ground and its own weight, and K
 * there.
 *
 * Force times lever turns with the deflection, so a load changes K: K is the slope of the force at the equilibrium,
 * J^-T (K_theta - K_G) J^-1, where K_G comes from the load (the conservative congruence transformation of Chen and Kao,
 * 2000; stiffness of loaded manipulators: Klimchik, Pashkevich, Chablat, 2014). docs/kernel.md has the formulas.
 *
 * The limb at finite deflections: joints' springs and the base's rotation turn by any angle. Of a link's bending
 * compliance the share moment_transfer is a uniform, geometrically exact beam with its axial spring at the root.
 * The rest is a spring at the link's end, which moves the end and turns nothing. A tilt turns the link's elastic axes
 * about its end. Base springs act in the robot's frame.
 *
 * A beam's curvature is linear along it, given by its values at the two Gauss points, which is exact at no load. Its
 * shape is summed at three points.
 *
 * Thread rule: pure functions of their arguments; any thread or interrupt that may use the FPU.
 */
#ifndef BRACE_LOADED_H
#define BRACE_LOADED_H

#include <stdbool.h>

#include "brace/contact.h"
#include "brace/limb.h"
#include "brace/loaded_types.h"
#include "brace/status.h"
#include "brace/stiffness.h"
#include "brace/vec.h"

/* One link in its own frame, x along it at no load. */
typedef struct {
    float length_mm;
    brace_vec_t to_beam_mm; /* from the joint to the root of the elastic line; zero where nothing is tilted */
    brace_vec_t beam_mm; /* from there to the link's end */
    float bend_rad_per_n_mm; /* each of the beam's two curvatures yields so; zero: the link stays straight */
    brace_vec_t root_root; /* axial spring at the root: this vector v adds v v' [sqrt(mm/N)] */
    brace_vec_t end_root; /* spring at the end: end_mm_per_n in every direction, and this vector */
    float end_mm_per_n;
    float weight_n;
} brace_loaded_link_t;

/* A collapsed limb. brace_loaded_collapse writes it; other code must not read its members. */
typedef struct {
    brace_loaded_link_t femur, tibia;
    float knee_n, weight_n; /* weight beyond the femur's end, and in all */
    float base_mm_per_n; /* in every direction */
    brace_vec_t base_root;
    float base_rotation_rad_per_n_mm;
} brace_loaded_t;

/* How a joint yields: how far its angle has left the commanded one for each N mm, and its slope there. They are equal
 * where the spring is linear. yields_by is 0 where the angle is measured behind the spring, so that it is known. */
typedef struct {
    float yields_by_rad_per_n_mm, slope_rad_per_n_mm;
} brace_loaded_joint_t;

typedef struct {
    brace_force_t tip; /* force of the ground on the tip [N], |x| + |z| at most 1e4 */
    brace_vec_t down; /* direction of the weight in the limb's plane; shorter than 1 where the plane leans */
    brace_loaded_joint_t hip, knee; /* the joints; the base's rotation is added to the hip */
} brace_load_t;

typedef struct {
    brace_stiffness_t stiffness; /* K at the equilibrium; flags: BRACE_FLAG_NEAR_SINGULAR as on other paths;
                                           brace_loaded_flags has those that tell how far the load goes */
    brace_displacement_t displacement; /* of the tip, from where it is at these angles without load */
    brace_vec_t tibia_mm; /* from the knee to the tip at the equilibrium */
    float hip_turn_rad, knee_turn_rad; /* how far the load has turned the joints, counter-clockwise, base included */
    float buckling_factor; /* see below; infinity where it is above 16, and where it may be above 11 */
} brace_loaded_stiffness_t;

/* An equilibrium. brace_loaded_settle writes it; other code must not read its members. */
typedef struct {
    brace_vec_t femur_commanded, tibia_commanded; /* directions; the tibia's seen from the femur */
    brace_loaded_seen_t femur, tibia;
    brace_loaded_shape_t femur_shape, tibia_shape;
    float hip_rad_per_n_mm, knee_rad_per_n_mm; /* slopes, base included */
    float unsettled_rad; /* how far the last step has turned a link's end, at most */
    brace_vec_t on_base_n; /* the whole load */
} brace_loaded_rest_t;

/* Where a limb has been bent to. brace_loaded_follow writes it; other code must not read its members. */
typedef struct {
    brace_loaded_shape_t femur_shape, tibia_shape;
    brace_vec_t on_base_n; /* the whole load */
} brace_loaded_place_t;

/* Collapses a limb. Call it when parameters change.
 * limb: one that brace_limb_check accepts. weights: each 0 to 1e6 N, not checked; the direction in which they pull is
 * the load's. No pointer may be null.
 * Cost on a Cortex-M4F: at most 500 instructions. */
void brace_loaded_collapse(const brace_limb_t *limb, const brace_gravity_t *weights, brace_loaded_t *loaded);

/* Equilibrium and K at commanded (or measured) true angles under a load.
 * No pointer may be null. theta1_rad, theta2_rad: theta1^2 + theta2^2 <= BRACE_REACH_RAD2.
 * load: the force is checked; direction and compliances are not.
 * result: written on success only. Its buckling factor is the smallest positive s for which diag(k) - s G is singular,
 * k the springs' stiffnesses, G the load's part, at this equilibrium with the posture held (linear buckling analysis).
 * It tells how far the load softens the limb, not at which load it collapses.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE, or BRACE_E_SINGULAR: there is no stable equilibrium near the
 *         commanded posture, four steps of Newton's method do not come to it, or nothing yields in some direction.
 *         The first step starts from the straight limb; a third and a fourth are taken where two are not enough.
 * Accuracy: where the buckling factor is at least 2 and the tip moves by at most a fifth of the reach, K within 0.6 %
 *         (Frobenius norm; median 1e-6), the buckling factor within 2 % below 10, the displacement within 0.5 mm; where
 *         a link bends by more than 0.25 rad within itself, result->stiffness.flags has BRACE_FLAG_NEAR_SINGULAR, and K
 *         may be off by some percent. At no load as brace/general.h. tests/judges/engine/test_core_under_load.py judges
 *         random limbs, and limbs pressed inward.
 * Cost on a Cortex-M4F: at most 3,500 instructions; 2,400 where two steps are enough; stack at most 800 bytes. */
brace_status_t brace_loaded_stiffness(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                      const brace_load_t *load, brace_loaded_stiffness_t *result);

/* The same in two steps, for a controller that cannot spend so much at once: the equilibrium, and K there.
 * No pointer may be null. rest: room to work in, and the equilibrium after BRACE_OK.
 * Both return what brace_loaded_stiffness returns.
 * Cost on a Cortex-M4F: at most 2,200 and 1,500 instructions. */
brace_status_t brace_loaded_settle(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                   const brace_load_t *load, brace_loaded_rest_t *rest);
brace_status_t brace_loaded_stiffness_at(const brace_loaded_t *loaded, const brace_loaded_rest_t *rest,
                                         brace_loaded_stiffness_t *result);

/* The same for who follows a limb from tick to tick: one step from where the tick before has bent it to, and K there.
 * Where is_bent is false, or the load has changed by more than half of itself, two steps from the straight limb. What
 * they do not reach is left to the next tick. So the rest of a standing limb is exact to rounding after a few ticks.
 * is_bent: `place` is of the same limb at a posture nearby, as this call has left it; after BRACE_E_SINGULAR too.
 * place (in, out): else room to work in. result: written on success only. No pointer may be null.
 * returns as brace_loaded_stiffness, for these steps: BRACE_E_SINGULAR also where the last step has turned a link's end
 *         by more than 0.05 rad, so that the next one may come near. A smaller one leaves less than 0.3 % of K.
 * Cost on a Cortex-M4F: at most 2,650 instructions; stack as brace_loaded_stiffness. */
brace_status_t brace_loaded_follow(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                   const brace_load_t *load, bool is_bent, brace_loaded_place_t *place,
                                   brace_loaded_stiffness_t *result);

#define BRACE_SOFTENED_FACTOR 3.0f /* of buckling: below it a limb is much softer than without load */
#define BRACE_PROMISED_FACTOR 2.0f /* of buckling: below it no accuracy is promised */
#define BRACE_PROMISED_MOVE 0.2f /* of the tip, as a share of the reach: beyond it no accuracy is promised */

/* What a user of this K has to know besides its own flags.
 * moved_mm2: square of the tip's displacement. reach_mm: lengths of femur and tibia added
 *   A buckling factor of NaN is not known and says nothing.
 * returns BRACE_FLAG_SOFTENED, and where no accuracy is promised BRACE_FLAG_NEAR_SINGULAR (the factor is below 2) and
 *   BRACE_FLAG_MOVED_FAR (the tip moves by more than a fifth of the reach); 0: none of them
 * Cost on a Cortex-M4F: 20 instructions. */
static inline uint32_t brace_loaded_flags(float buckling_factor, float moved_mm2, float reach_mm)
{
    const float most_mm = BRACE_PROMISED_MOVE * reach_mm;
    uint32_t flags = 0u;
    if (buckling_factor < BRACE_PROMISED_FACTOR) {
        flags |= BRACE_FLAG_NEAR_SINGULAR;
    }
    if (!(moved_mm2 <= most_mm * most_mm)) {
        flags |= BRACE_FLAG_MOVED_FAR;
    }
    if (buckling_factor < BRACE_SOFTENED_FACTOR) {
        flags |= BRACE_FLAG_SOFTENED;
    }
    return flags;
}

#endif
