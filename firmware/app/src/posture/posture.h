/* Where the limb stands: true joint angles, levers of the plane's joints, and the statics that follow from the
 * levers.
 *
 * A load turns joints and bends links, so the limb stands elsewhere than its motors say. K's estimator finds where
 * (brace/loaded.h), but it needs the load first, and without a sensor at the tip the load follows from the levers. So
 * what the load moves is followed from tick to tick: the levers of a tick count what the load of the tick before has
 * moved. */
#ifndef BRACE_POSTURE_POSTURE_H
#define BRACE_POSTURE_POSTURE_H

#include <stdbool.h>

#include "brace/kinematics.h"
#include "brace/parameters.h"

typedef struct {
    float unbent_rad[BRACE_LINK_COUNT]; /* as the motors stand, nothing turned by the load; where an encoder behind the
                                           gear measures it, the true angle itself; NaN: not known */
    float theta_rad[BRACE_LINK_COUNT]; /* true angles, as far as the load is known; NaN: not known */
    bool is_measured[BRACE_LINK_COUNT]; /* by an encoder behind the gear: nothing turns that joint further */
    bool is_inside_travel; /* femur and tibia joint are within their drives' travel */
    bool has_levers; /* pose holds tip and levers */
    brace_pose_t unbent; /* of unbent_rad, with straight links */
    brace_pose_t pose; /* at the equilibrium, as far as the load is known */
    brace_vec_t tip_moved_mm, knee_moved_mm; /* from unbent to pose */
    float tip_across_mm, knee_across_mm; /* out of the plane in which the coxa joint stands unbent, to the left */
    float yaw_turn_rad; /* how far the load has turned the coxa joint, and the plane with it */
} posture_t;

/* How a load bends the limb, in its plane and, with a coxa joint, out of it to the left. */
typedef struct {
    brace_vec_t tip_mm; /* how far the tip moves */
    brace_vec_t tibia_mm; /* from the knee to the tip where the load has moved them */
    float tip_across_mm, tibia_across_mm; /* the same out of the plane; 0 without a coxa joint */
    float joint_turn_rad[BRACE_LINK_COUNT]; /* how far the joints themselves turn, in the sense of their angles */
} posture_bend_t;

/* No posture is known. */
void posture_start(posture_t *posture);

/* The posture of motor angles and backlash offsets.
 *   motor_rad, offset_rad: of each joint; a joint that is not known has NaN
 *   link_rad: of the encoders behind the gears; NaN: there is none. It measures the true angle, so that neither zero
 *     offset nor backlash is added
 * About 270 instructions. */
void posture_take(posture_t *posture, const brace_parameters_t *parameters, const float motor_rad[BRACE_LINK_COUNT],
                  const float offset_rad[BRACE_LINK_COUNT], const float link_rad[BRACE_LINK_COUNT]);

/* Goes to the equilibrium.
 *   bend: from unbent_rad; null: the load is not known, and nothing is moved */
void posture_settle(posture_t *posture, const posture_bend_t *bend);

/* Is an angle inside a drive's travel? */
bool posture_is_inside_travel(const brace_drive_t *drive, float theta_rad);

/* Torque that a motor needs to hold the links' weight at this posture [N mm], in the motor's sense.
 *   down: where the weight pulls, in the limb's plane
 *   joint_index: BRACE_FEMUR or BRACE_TIBIA */
float posture_gravity_n_mm(const posture_t *posture, const brace_gravity_t *weight, brace_vec3_t down, int joint_index);

/* Torque with which a tip force loads a joint [N mm], in the motor's sense. joint_index: BRACE_FEMUR or BRACE_TIBIA */
float posture_tip_load_n_mm(const posture_t *posture, float x_n, float z_n, int joint_index);

/* The tip force that explains the loads of both joints. Where a load has turned the coxa joint, these joints have
 * turned with it, and x_n is the force outwards in the turned plane: see posture_force_across_n.
 *   femur_n_mm, tibia_n_mm: loads in the motors' sense, weight included
 *   x_n, z_n (out): NaN where the levers do not allow it: near the straight and the folded knee */
void posture_force_of_loads(const posture_t *posture, const brace_parameters_t *parameters, brace_vec3_t down,
                            float femur_n_mm, float tibia_n_mm, float *x_n, float *z_n);

/* The tip force across the limb's plane, to the left, that explains the load of the coxa joint about its axis.
 *   coxa_n_mm: load in the motor's sense, weight included
 *   is_turned: x_n is the force outwards in the turned plane, as posture_force_of_loads gives it; it becomes the one in
 *     the plane of unbent_rad
 *   x_n (in, out): NaN: not known. A tip beside the plane turns the joint by it
 * returns NaN where the lever does not allow it: the tip near the coxa joint's axis */
float posture_force_across_n(const posture_t *posture, const brace_parameters_t *parameters, brace_vec3_t down,
                             float coxa_n_mm, bool is_turned, float *x_n);

#endif
