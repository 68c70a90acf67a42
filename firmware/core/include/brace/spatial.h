/* K in space: K in the limb's plane and K across that plane, turned by theta0.
 *
 * In the frame of the limb's plane C falls into two parts: the plane's own 2 by 2 block (femur, tibia, joints 1 and
 * 2, the coxa link's bending and stretching, the base), and one compliance across the plane (joint 0, lateral bending
 * and torsion of the links). So K in space takes two steps: brace_spatial_in_plane computes both parts, and
 * brace_spatial_turn turns them by theta0. Between the two steps a caller may replace a part, for instance by K while a
 * gap is open (brace/gap_stiffness.h).
 *
 * Thread rule: pure functions of their arguments; safe from any context once the arguments are not written.
 */
#ifndef BRACE_SPATIAL_H
#define BRACE_SPATIAL_H

#include "brace/general.h"
#include "brace/limb.h"
#include "brace/status.h"
#include "brace/stiffness.h"

/* A link's compliance across the plane under a force at the tip. Moment transfer grows with the tip's distance along
 * the link and its square, torsion with the square of the tip's distance beside the link. */
typedef struct {
    float per_mm, per_mm2, torsion_rad_per_n_mm;
} brace_aside_t;

/* A collapsed limb. brace_spatial_collapse and brace_spatial_set_springs write it; other code must not read its
 * members. */
typedef struct {
    brace_general_t plane;           /* its base vector is that of base and coxa link together */
    brace_vec_t coxa_moment;         /* the coxa link's moment transfer in the plane, constant part [sqrt(mm/N)] */
    float coxa_moment_per_lever_mm;  /* added to it for each mm of the tip's lever about the hip */
    float coxa_mm;
    float across_mm_per_n;           /* lateral bending of the three links */
    brace_aside_t coxa_aside;        /* by the tip's distance from the hip and its height */
    brace_aside_t femur_aside;       /* by the tip's distance from the knee */
    float yaw_rad_per_n_mm;          /* joint 0 */
    float hip_root, knee_root;       /* roots of the compliances of joint 1 with the base's rotation, and joint 2 */
} brace_spatial_t;

/* The limb's constants; call it whenever its parameters change.
 * limb: any that brace_limb_check accepts. spatial: written on success only.
 * returns BRACE_OK, BRACE_E_NULL or what brace_limb_check says.
 * Cost on a Cortex-M4F: at most 2,000 instructions; stack 168 bytes. */
brace_status_t brace_spatial_collapse(const brace_limb_t *limb, brace_spatial_t *spatial);

/* Replaces the limb's own springs by the joints' present compliances (temperature, hardening).
 * yaw: joint 0; hip: joint 1 and the base's rotation; knee: joint 2 [rad/(N mm), >= 0; not checked: this is the tick]
 * Cost on a Cortex-M4F: 10 instructions. */
void brace_spatial_set_springs(brace_spatial_t *spatial, float yaw_rad_per_n_mm, float hip_rad_per_n_mm,
                               float knee_rad_per_n_mm);

/* K in the limb's plane, coxa link included, and K across the plane.
 * theta1_rad, theta2_rad: true angles [rad, -7.9 to 7.9].
 * plane, across_n_per_mm: written on success only. across is NaN where nothing yields across the plane: K in space does
 *         not exist then, but the plane's does. flags of plane: as brace_general_stiffness says.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE, or
 *         BRACE_E_SINGULAR: nothing yields in some direction of the plane.
 * Cost on a Cortex-M4F: at most 400 instructions; stack 144 bytes.
 * Accuracy: the plane's as brace_general_stiffness says; across within 2e-6 of itself.
 * Formula: docs/physics.md, moment transfer across the plane included. */
brace_status_t brace_spatial_in_plane(const brace_spatial_t *spatial, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *plane, float *across_n_per_mm);

/* K in the robot's frame, from the two parts of K in the plane's frame.
 * theta0_rad: true angle [rad, -7.9 to 7.9].
 * plane: K in the plane; it may be singular, as it is while a gap is open. Its entries are not checked.
 * across_n_per_mm: >= 0; zero while the gap of joint 0 is open.
 * stiffness: written on success only. lambda_n_per_mm ascends. stiff_axis is a unit vector that points outwards in the
 *            limb's plane or, if the limb is stiffest across it, to the left. flags are the plane's.
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE (theta0), or
 *         BRACE_E_SINGULAR: across is NaN, because nothing yields across the plane.
 * Cost on a Cortex-M4F: at most 120 instructions; stack 40 bytes. */
brace_status_t brace_spatial_turn(float theta0_rad, const brace_stiffness_t *plane, float across_n_per_mm,
                                  brace_stiffness_spatial_t *stiffness);

/* Calls brace_spatial_in_plane and then brace_spatial_turn.
 * returns as they do.
 * Cost on a Cortex-M4F: at most 500 instructions; stack 200 bytes. Meant for controllers with an FPU: without one it is
 *         right, but slow.
 * Accuracy: K within 4e-6 of lambda_max and each eigenvalue within 4e-6 of itself (1e-5 promised), the axis as exact as
 *         an eigenvector for the same errors, unless flagged. */
brace_status_t brace_spatial_stiffness(const brace_spatial_t *spatial, float theta0_rad, float theta1_rad,
                                       float theta2_rad, brace_stiffness_spatial_t *stiffness);

#endif
