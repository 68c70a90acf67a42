/* How exactly K is known under a load and in space.
 *
 * brace/uncertainty.h has a formula for K in the limb's plane at no load. Under a load no formula of such a kind holds:
 * a load softens the limb, so that it makes more of every error, and it bends the limb into another posture. So here K
 * is worked out anew with one of its inputs changed at a time: what K changes by is what that input's error means. Each
 * such input is a cause. All causes are independent of each other:
 *   - the angles of femur and tibia joint, and in space of the coxa joint;
 *   - each length, with length_mm;
 *   - each compliance, with compliance_rel of itself: of links, joints and base. A link's moment transfer grows with
 *     its bending;
 *   - the gain of the force sensor that the calibration used, gain_rel: it changes all compliances alike;
 *   - where a sensor at the tip measures the load: that sensor's gain, with gain_rel as well.
 * Taken as exact: tilts, the strength of moment transfer, weights, the direction of down, and the chain itself.
 *
 * A job works the causes off one by one; brace_uncertainty_loaded and brace_uncertainty_loaded_space do all at once. At
 * no load in the plane they agree with brace_uncertainty_stiffness, where K is not nearly singular.
 *
 * Thread rule: pure functions of their arguments; any thread or interrupt that may use the FPU. */
#ifndef BRACE_UNCERTAINTY_CAUSES_H
#define BRACE_UNCERTAINTY_CAUSES_H

#include <stdbool.h>

#include "brace/limb.h"
#include "brace/loaded.h"
#include "brace/loaded_space.h"
#include "brace/uncertainty.h"

/* What K under a load is worked out from, and how exactly the angles and the load are known. */
typedef struct {
    brace_limb_t limb; /* its uncertainty has the sigmas of lengths, compliances and gain */
    float angle_rad[BRACE_LINK_COUNT]; /* without what the load turns */
    float angle_sigma_rad[BRACE_LINK_COUNT];
    brace_loaded_joint_t spring[BRACE_LINK_COUNT]; /* of the joints; those of `limb` do not count */
    brace_vec3_t tip_n; /* y: 0 for a limb in its plane */
    float sensor_gain_rel; /* one sigma of the gain that tip_n was measured with; 0: none */
} brace_k_inputs_t;

#define BRACE_CAUSE_COUNT 25u
#define BRACE_CAUSE_SIGMAS 0.25f /* an input is changed by so many of its sigmas: the change of K is linear there */

/* Changes one input.
 *   cause: [0, BRACE_CAUSE_COUNT); inputs: checked limb
 * returns false: it changes nothing, because the input is exact or zero, or plays no part in the plane; inputs are
 *   untouched then. At most 60 instructions. */
bool brace_cause_change(uint32_t cause, bool is_spatial, brace_k_inputs_t *inputs);

/* One sigma, or while they are summed up the variance, of every entry of K in the plane and in space. */
typedef struct {
    brace_stiffness_sigma_t plane; /* its flags are 0 */
    brace_space_sigma_t space; /* 0 for a limb in its plane */
} brace_k_sigma_t;

/* The K that the causes change. brace_k_base_find writes it; other code reads `plane` and `is_spatial` at most. */
typedef struct {
    brace_stiffness_t plane;
    bool is_spatial;
    brace_k3_t space; /* the rest only in space. In the frame of the limb's plane, as the axes */
    brace_vec_t theta0; /* direction of the limb's plane, for K in the robot's frame */
    brace_vec3_t axis[3]; /* of the eigenvalues, which ascend */
    bool is_near_next[2]; /* an eigenvalue is within a twentieth of the largest to the next: then they are not told
                             apart */
} brace_k_base_t;

/* plane, space: K with nothing changed; space is not read for a limb in its plane
 * At most 50 instructions in the plane, 650 in space. */
void brace_k_base_find(const brace_stiffness_t *plane, const brace_k3_t *space, float theta0_rad, bool is_spatial,
                       brace_k_base_t *base);

/* Begins a sum: the coxa joint's angle, which only turns K in space, is counted here.
 *   variance (out). At most 120 instructions. */
void brace_sigma_begin(const brace_k_base_t *base, float theta0_sigma_rad, brace_k_sigma_t *variance);

/* Adds to a variance what a changed K means.
 *   plane, space: K with one input changed; space is not read for a limb in its plane
 *   by_sigmas: by so many sigmas that input is changed, > 0
 * At most 100 instructions in the plane, 250 in space. */
void brace_sigma_add(const brace_k_base_t *base, const brace_stiffness_t *plane, const brace_k3_t *space,
                     float by_sigmas, brace_k_sigma_t *variance);

/* variance += factor * more. At most 60 instructions. */
void brace_sigma_add_scaled(const brace_k_sigma_t *more, float factor, brace_k_sigma_t *variance);

/* Roots of all variances; the axis's is at most BRACE_UNKNOWN_AXIS_RAD. At most 80 instructions. */
void brace_sigma_end(const brace_k_sigma_t *variance, brace_k_sigma_t *sigma);

/* One sigma of K in the limb's plane under a load that is known exactly. Everything is checked and returned as by
 * brace_limb_check and brace_loaded_stiffness; BRACE_E_SINGULAR also where a quarter of a sigma leads to a limb without
 * a K. sigma: written on success only; its flags are 0, or BRACE_FLAG_SATURATED as brace/uncertainty.h says.
 * Cost: some 20 times that of brace_loaded_stiffness: meant for a host. */
brace_status_t brace_uncertainty_loaded(const brace_limb_t *limb, const brace_gravity_t *weights, float theta1_rad,
                                        float theta2_rad, const brace_load_t *load, brace_stiffness_sigma_t *sigma);

/* The same in space. theta_rad: of the three joints [+-7.9 rad]. */
brace_status_t brace_uncertainty_loaded_space(const brace_limb_t *limb, const brace_gravity_t *weights,
                                              const float theta_rad[BRACE_LINK_COUNT], const brace_space_load_t *load,
                                              brace_k_sigma_t *sigma);

#endif
