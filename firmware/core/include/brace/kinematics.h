/* Joint angles <-> tip, levers of the joints, polar form; in the limb's plane and in space.
 *
 * docs/physics.md defines frames and signs: the origin is on the femur joint's axis, x points outwards, z up; theta1 is
 * the femur's angle from +x; theta2 is the knee's flexion, and the tibia points along theta1 - theta2. In space theta0
 * turns the limb's plane, coxa included, about z; there the origin lies on the yaw axis.
 *
 * Angles are true joint angles; add zero offsets first (brace_limb_true_angle).
 *
 * Every function is pure and re-entrant, from any thread or interrupt; no loop over data; stack at most 170 bytes.
 * A refused call leaves its outputs untouched.
 */
#ifndef BRACE_KINEMATICS_H
#define BRACE_KINEMATICS_H

#include "brace/limb.h"
#include "brace/vec.h"

typedef struct {
    float x_mm;
    float z_mm;
} brace_point_t;

typedef struct {
    float x_mm;
    float y_mm;
    float z_mm;
} brace_point_spatial_t;

/* The paper's coordinates of the tip. */
typedef struct {
    float r_mm;    /* distance from the femur joint's axis, >= 0 */
    float phi_rad; /* direction from +x, [-pi, pi] */
} brace_polar_t;

typedef struct {
    brace_point_t knee;
    brace_point_t tip;
    /* The tip's shift for a unit turn (1 rad, counter-clockwise) of everything beyond the joint: the vector from
     * the joint to the tip, turned by +90 degrees. A force f at the tip loads the joint with lever . f. */
    brace_point_t lever_femur;
    brace_point_t lever_tibia;
} brace_pose_t;

/* Which of the two postures that reach a point. The knee lies on one side of the line from the origin to the tip. */
typedef enum {
    BRACE_KNEE_UP = 0,  /* theta2 in [0, pi]: knee to the left of the line, above it for a tip in front */
    BRACE_KNEE_DOWN = 1 /* theta2 in [-pi, 0] */
} brace_knee_t;

/* Which of the two yaw angles whose plane contains a point. */
typedef enum {
    BRACE_YAW_TOWARDS = 0, /* the limb's +x side faces the tip */
    BRACE_YAW_AWAY = 1     /* theta0 is half a turn further: the limb reaches back over the yaw axis */
} brace_yaw_t;

/* Cosine and sine of an angle, as the direction in which it points.
 *   angle_rad [+-7.9 rad]; direction (out): each component within 1e-7
 * returns BRACE_OK, BRACE_E_NOT_FINITE, BRACE_E_RANGE; cost: at most 80 instructions. */
brace_status_t brace_kinematics_direction(float angle_rad, brace_vec_t *direction);

/* Where knee and tip are, and the levers of both joints.
 *   theta1_rad, theta2_rad [+-7.9 rad]
 *   pose (out): accuracy 3e-7 of femur + tibia in every component
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER (a length no limb has), BRACE_E_NOT_FINITE, BRACE_E_RANGE
 * cost: at most 210 instructions on a Cortex-M4F. */
brace_status_t brace_kinematics_forward(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                        brace_pose_t *pose);

/* The same for the tick. It checks nothing: limb must have passed brace_limb_check, and angles must be within +-7.9
 * rad. At most 130 instructions. */
void brace_kinematics_pose(const brace_limb_t *limb, float theta1_rad, float theta2_rad, brace_pose_t *pose);

/* Distance and direction of a point; phi 0 for the origin itself.
 *   point [+-1e6 mm]; polar (out): r within 2e-7 relative, phi within 3e-7 rad (r above 1e-30 mm)
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_NOT_FINITE, BRACE_E_RANGE; at most 100 instructions. */
brace_status_t brace_kinematics_polar(brace_point_t point, brace_polar_t *polar);

/* The angles that put the tip at a point.
 *   tip [+-1e6 mm]
 *   knee: which of the two postures
 *   theta1_rad (out) [-pi, pi]; theta2_rad (out) [0, pi] knee up, [-pi, 0] knee down
 * returns BRACE_OK, BRACE_E_NULL, BRACE_E_PARAMETER, BRACE_E_NOT_FINITE, BRACE_E_RANGE (also for a knee that
 *   is neither), BRACE_E_UNREACHABLE: |tip| outside [|femur - tibia|, femur + tibia] by more than 5e-7
 *   of femur + tibia. A tip that is outside by less, such as the rounded tip of a straight limb, counts as straight
 *   or folded.
 * A tip at the origin is reached when both links are equally long, with theta2 = +-pi and theta1 = 0.
 * accuracy: the returned angles put the tip within 1e-6 of femur + tibia of the tip that was asked for, straight
 *   and folded included. The angles are as exact as the given tip allows: if the tip is known to e, theta2 is known to
 *   e r / (femur tibia |sin theta2|). At sin theta2 = 0 it is known to the root of twice that expression without the
 *   sine.
 * cost: at most 360 instructions.
 * source: half-angle form of the law of cosines; every factor is a difference of two given lengths. */
brace_status_t brace_kinematics_inverse(const brace_limb_t *limb, brace_point_t tip, brace_knee_t knee,
                                        float *theta1_rad, float *theta2_rad);

/* The same for a tip in the paper's coordinates; tip.r_mm [0, 2e6 mm], tip.phi_rad [+-7.9 rad].
 * returns the same; at most 250 instructions. */
brace_status_t brace_kinematics_inverse_polar(const brace_limb_t *limb, brace_polar_t tip, brace_knee_t knee,
                                              float *theta1_rad, float *theta2_rad);

/* Where the tip is in the robot's base frame, origin on the yaw axis at the height of the femur's axis.
 *   theta0_rad, theta1_rad, theta2_rad [+-7.9 rad]
 *   tip (out): accuracy 5e-7 of coxa + femur + tibia
 * returns as brace_kinematics_forward; at most 300 instructions. */
brace_status_t brace_kinematics_forward_spatial(const brace_limb_t *limb, float theta0_rad, float theta1_rad,
                                                float theta2_rad, brace_point_spatial_t *tip);

/* The three angles that put the tip at a point in space.
 *   tip [+-1e6 mm]; yaw, knee: which of the four postures
 *   theta0_rad (out) [-pi, pi]; 0 for a tip on the yaw axis, where any yaw angle reaches the tip
 *   theta1_rad, theta2_rad (out) as for brace_kinematics_inverse
 * returns as brace_kinematics_inverse; accuracy 1e-6 of coxa + femur + tibia at the tip; at most 490
 * instructions. */
brace_status_t brace_kinematics_inverse_spatial(const brace_limb_t *limb, brace_point_spatial_t tip, brace_yaw_t yaw,
                                                brace_knee_t knee, float *theta0_rad, float *theta1_rad,
                                                float *theta2_rad);

#endif
