/* Kinematics in space: the limb's plane stands on the coxa and is turned by theta0. */
#include "brace/kinematics.h"

#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"

brace_status_t brace_kinematics_forward_spatial(const brace_limb_t *limb, float theta0_rad, float theta1_rad,
                                                float theta2_rad, brace_point_spatial_t *tip)
{
    if (tip == NULL) {
        return BRACE_E_NULL;
    }
    brace_pose_t pose;
    brace_status_t status = brace_kinematics_forward(limb, theta1_rad, theta2_rad, &pose);
    if (status == BRACE_OK) {
        status = brace_check_magnitude(theta0_rad, BRACE_ANGLE_LIMIT_RAD);
    }
    if (status != BRACE_OK) {
        return status;
    }
    const brace_vec_t yaw = brace_direction(theta0_rad);
    const float outwards_mm = limb->coxa_mm + pose.tip.x_mm;
    tip->x_mm = outwards_mm * yaw.x;
    tip->y_mm = outwards_mm * yaw.z;
    tip->z_mm = pose.tip.z_mm;
    return BRACE_OK;
}

brace_status_t brace_kinematics_inverse_spatial(const brace_limb_t *limb, brace_point_spatial_t tip, brace_yaw_t yaw,
                                                brace_knee_t knee, float *theta0_rad, float *theta1_rad,
                                                float *theta2_rad)
{
    if (limb == NULL || theta0_rad == NULL) {
        return BRACE_E_NULL;
    }
    if (yaw != BRACE_YAW_TOWARDS && yaw != BRACE_YAW_AWAY) {
        return BRACE_E_RANGE;
    }
    if (yaw == BRACE_YAW_AWAY) {
        tip.x_mm = -tip.x_mm;
        tip.y_mm = -tip.y_mm;
    }
    brace_polar_t plan; /* the tip, or its mirror image, seen from above */
    brace_status_t status = brace_kinematics_polar((brace_point_t){tip.x_mm, tip.y_mm}, &plan);
    if (status == BRACE_OK) {
        const float outwards_mm = yaw == BRACE_YAW_TOWARDS ? plan.r_mm : -plan.r_mm;
        const brace_point_t in_plane = {outwards_mm - limb->coxa_mm, tip.z_mm};
        status = brace_kinematics_inverse(limb, in_plane, knee, theta1_rad, theta2_rad);
    }
    if (status == BRACE_OK) {
        *theta0_rad = plan.phi_rad;
    }
    return status;
}
