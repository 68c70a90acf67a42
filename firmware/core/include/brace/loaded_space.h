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

#include "brace/loaded.h"

/* One link. Its own frame: x along it, y across it in the limb's plane, counter-clockwise, z = x cross y. */
typedef struct {
    float length_mm;
    brace_vec_t stretch_root;  /* axial spring: this vector v adds v v' [sqrt(mm/N)] */
    brace_vec_t across;        /* direction of the bending in the plane, turned by the tilt */
    float twist_rad_per_n_mm, sideways_rad_per_n_mm, bend_rad_per_n_mm; /* the link's own turns about x, y and z */
    float across_mm_per_n, sideways_mm_per_n; /* what moves its end and turns nothing */
    float end_share, stretch_end_share; /* the part of the link's turn that these springs, and the axial one, follow,
                                           less one half */
    float curl_per_mm;         /* twist for each mm of these springs and each radian of bending */
    float across_spread_per_n_mm, sideways_spread_per_n_mm; /* twist's compliance for each squared radian of bending */
    float shortens_per_mm;     /* by those springs */
    brace_vec_t tilt_mm;       /* how the end moves with the turn in the plane, */
    brace_vec_t bow_mm;        /* and with its square */
    float twelfth_mm;          /* of the length */
    float own_share;           /* of the link's weight, on those springs */
    float weight_n;
} brace_space_link_t;

/* A collapsed limb. brace_loaded_space_collapse writes it; other code must not read its members. */
typedef struct {
    brace_space_link_t coxa, femur, tibia;
    float beyond_coxa_n, beyond_femur_n; /* weight that these links' ends carry */
    float base_x_mm_per_n, base_z_mm_per_n, base_rotation_rad_per_n_mm;
} brace_loaded_space_t;

/* In the limb's plane's frame: x outwards, y to the left, z up. */
typedef struct {
    float xx_n_per_mm, xy_n_per_mm, xz_n_per_mm, yy_n_per_mm, yz_n_per_mm, zz_n_per_mm;
} brace_k3_t;

typedef struct {
    brace_vec3_t tip_n;  /* force of the ground on the tip [-1e4 to 1e4] */
    brace_vec3_t down;   /* direction of the weight, a unit vector */
    brace_loaded_joint_t yaw, hip, knee; /* without the base's rotation */
} brace_space_load_t;

/* Turns of a limb's links and joints from their commanded angles [rad]; a link's about its own axes. */
typedef struct {
    brace_vec3_t coxa, femur, tibia;
    float base, yaw, hip, knee;
} brace_space_pose_t;

/* Cosine and sine (x, z) of the turns from the base to the tip. A link turns half way, then its own half about y, which
 * leads to its frame, its twist about x, and the other half about y. */
typedef struct {
    brace_vec_t base, yaw, coxa_z, coxa_y, coxa_x, hip, femur_y, femur_x, knee, tibia_y;
} brace_space_turns_t;

/* A bent link in its frame. */
typedef struct {
    brace_vec3_t chord_mm;             /* from its root to its end */
    brace_vec3_t across, sideways;     /* how the end's springs move it */
    brace_vec_t by_bend_mm;            /* how the chord changes with the turn about z, */
    float by_sideways_mm;              /* and about y */
    float across_curl, sideways_curl;  /* how far the axes of the turns about y and z lean to -x */
    brace_vec3_t beyond_n, own_n;      /* the force that the end carries, and the link's own weight */
} brace_space_bent_t;

/* An equilibrium, for brace_loaded_space_buckling_factor. Other code must not read its members. */
typedef struct {
    brace_space_pose_t pose;
    brace_space_turns_t turns;
    brace_space_bent_t coxa, femur, tibia;
    brace_vec3_t whole_n; /* force on the base, in the limb's plane's frame */
    float base_rad_per_n_mm, yaw_rad_per_n_mm, hip_rad_per_n_mm, knee_rad_per_n_mm;
} brace_space_rest_t;

/* K at the equilibrium and how the limb stands there, in the limb's plane's frame. */
typedef struct {
    brace_k3_t k;
    brace_vec3_t displacement_mm; /* of the tip, from where it is at these angles without load */
    float yaw_turn_rad, hip_turn_rad, knee_turn_rad; /* how far the load has turned the joints, without the base */
} brace_space_result_t;

/* Collapses a limb. Call it when parameters change.
 * limb: one that brace_limb_check accepts. weights: each 0 to 1e6 N, not checked. No pointer may be null.
 * Cost on a Cortex-M4F: at most 600 instructions. */
void brace_loaded_space_collapse(const brace_limb_t *limb, const brace_weights_t *weights,
                                 brace_loaded_space_t *loaded);

/* Equilibrium and K at commanded (or measured) true angles under a load.
 * No pointer may be null. theta1_rad, theta2_rad: theta1^2 + theta2^2 <= BRACE_REACH_RAD2.
 * load: the force is checked; direction and compliances are not.
 * rest: room to work in, and the equilibrium after BRACE_OK. result: written on success only.
 * returns BRACE_OK, BRACE_E_RANGE, BRACE_E_NOT_FINITE, or BRACE_E_SINGULAR: there is no stable equilibrium near the
 *         commanded posture, or nothing yields in some direction.
 * Accuracy: where the buckling factor is at least 2 and the tip moves by at most a fifth of the reach, K within 1 %
 *         (Frobenius norm; median 0.03 %), the displacement within 2 mm (median 0.004 mm). At a tenth of such a load
 *         K within 0.07 %, at no load within 2e-7 of itself for each unit of C's condition number (3e-5 for random
 *         limbs). tests/engine/test_core_in_space_under_load.py judges 600 random limbs. Of 6,500 others, 32 were
 *         off by more than 1 %, nearly all because of a short, soft coxa link, most of which turn by 0.2 rad and more
 *         within themselves. One of them, off by 61 %, did not reach its equilibrium.
 * Cost on a Cortex-M4F: at most 6,000 instructions, the same for every posture; stack at most 1,800 bytes. */
brace_status_t brace_loaded_space_in_plane(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                           const brace_space_load_t *load, brace_space_rest_t *rest,
                                           brace_space_result_t *result);

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
 * loaded, rest: what brace_loaded_space_in_plane was given and left; neither may be null.
 * Accuracy: where it is below 10, median 0.3 %, nine of ten within 4 %. It overlooks a beam that buckles within
 *         itself, between its ends: where a short, soft coxa link does, it may tell a multiple of the true factor.
 * Cost on a Cortex-M4F: at most 7,200 instructions; stack at most 700 bytes. */
float brace_loaded_space_buckling_factor(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest);

#endif
