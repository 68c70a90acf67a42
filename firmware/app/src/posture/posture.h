/* Where the limb stands: true joint angles, levers of the plane's joints, and the statics that follow from the
 * levers. */
#ifndef BRACE_POSTURE_POSTURE_H
#define BRACE_POSTURE_POSTURE_H

#include <stdbool.h>

#include "brace/kinematics.h"
#include "brace/parameters.h"

typedef struct {
    float theta_rad[BRACE_LINK_COUNT]; /* true angles; NaN: not known */
    bool is_inside_travel;             /* femur and tibia joint are within their drives' travel */
    bool has_levers;                   /* pose holds tip and levers */
    brace_pose_t pose;
} posture_t;

/* No posture is known. */
void posture_start(posture_t *posture);

/* The posture of motor angles and backlash offsets.
 *   motor_rad, offset_rad: of each joint; a joint that is not known has NaN
 * About 250 instructions. */
void posture_take(posture_t *posture, const brace_parameters_t *parameters, const float motor_rad[BRACE_LINK_COUNT],
                  const float offset_rad[BRACE_LINK_COUNT]);

/* Is an angle inside a drive's travel? */
bool posture_is_inside_travel(const brace_drive_t *drive, float theta_rad);

/* Torque that a motor needs to hold the links' weight at this posture [N mm], in the motor's sense.
 *   joint_index: BRACE_FEMUR or BRACE_TIBIA; the coxa joint's axis is vertical, so that joint carries no weight */
float posture_gravity_n_mm(const posture_t *posture, const brace_gravity_t *weight, int joint_index);

/* Torque with which a tip force loads a joint [N mm], in the motor's sense. joint_index: BRACE_FEMUR or BRACE_TIBIA */
float posture_tip_load_n_mm(const posture_t *posture, float x_n, float z_n, int joint_index);

/* The tip force that explains the loads of both joints.
 *   femur_n_mm, tibia_n_mm: loads in the motors' sense, weight included
 *   x_n, z_n (out): NaN where the levers do not allow it: near the straight and the folded knee */
void posture_force_of_loads(const posture_t *posture, const brace_parameters_t *parameters, float femur_n_mm,
                            float tibia_n_mm, float *x_n, float *z_n);

#endif
