#include "brace/kinematics.h"

#include <stdbool.h>
#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"

#define TIP_LIMIT_MM 1e6f

/* A tip this far outside the reach, as a fraction of the reach, is the rounding of one on its edge. */
#define EDGE_RATIO 5e-7f

void brace_kinematics_pose(const brace_limb_t *limb, float theta1_rad, float theta2_rad, brace_pose_t *pose)
{
    const uint32_t femur_turn = brace_turn(theta1_rad);
    const brace_vec_t femur = brace_direction(femur_turn);
    const brace_vec_t tibia = brace_direction(femur_turn - brace_turn(theta2_rad));
    const brace_point_t knee = {limb->femur_mm * femur.x, limb->femur_mm * femur.z};
    const brace_point_t shank = {limb->tibia_mm * tibia.x, limb->tibia_mm * tibia.z};
    const brace_point_t tip = {knee.x_mm + shank.x_mm, knee.z_mm + shank.z_mm};
    pose->knee = knee;
    pose->tip = tip;
    pose->lever_femur = (brace_point_t){-tip.z_mm, tip.x_mm};
    pose->lever_tibia = (brace_point_t){-shank.z_mm, shank.x_mm};
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_forward(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                        brace_pose_t *pose)
{
    if (pose == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_lengths(limb);
    if (status == BRACE_OK) {
        status = brace_check_two(theta1_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD);
    }
    if (status != BRACE_OK) {
        return status;
    }
    brace_kinematics_pose(limb, theta1_rad, theta2_rad, pose);
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_polar(brace_point_t point, brace_polar_t *polar)
{
    if (polar == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_two(point.x_mm, point.z_mm, TIP_LIMIT_MM);
    if (status == BRACE_OK) {
        polar->r_mm = brace_length(point.x_mm, point.z_mm);
        polar->phi_rad = brace_atan2(point.z_mm, point.x_mm);
    }
    return status;
}

/* The triangle femur, tibia, r by half angles: the tangents of half the flexion and of half the angle between
 * femur and tip are roots of ratios of four lengths, in which nothing cancels but lengths as they were given.
 * False where there is no such triangle. */
static bool solve_triangle(const brace_limb_t *limb, float r_mm, float *flexion_rad,
                           float *femur_from_tip_rad)
{
    const float reach = limb->femur_mm + limb->tibia_mm;
    const float surplus = limb->femur_mm - limb->tibia_mm;
    const float folded = __builtin_fabsf(surplus);
    float nearest = r_mm < reach ? r_mm : reach;
    nearest = nearest > folded ? nearest : folded;
    if (__builtin_fabsf(r_mm - nearest) > EDGE_RATIO * reach) {
        return false;
    }
    const float to_straight = reach - nearest;
    const float perimeter = reach + nearest;
    const float beyond_surplus = nearest - surplus;
    const float beyond_deficit = nearest + surplus;
    *flexion_rad =
        2.0f * brace_atan2(brace_sqrt(to_straight * perimeter), brace_sqrt(beyond_surplus * beyond_deficit));
    *femur_from_tip_rad =
        2.0f * brace_atan2(brace_sqrt(to_straight * beyond_surplus), brace_sqrt(perimeter * beyond_deficit));
    return true;
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_inverse_polar(const brace_limb_t *limb, brace_polar_t tip, brace_knee_t knee,
                                              float *theta1_rad, float *theta2_rad)
{
    if (theta1_rad == NULL || theta2_rad == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_check_lengths(limb);
    if (status == BRACE_OK) {
        status = brace_check_magnitude(tip.phi_rad, BRACE_ANGLE_LIMIT_RAD);
    }
    if (status == BRACE_OK) {
        status = brace_check_magnitude(tip.r_mm, 2.0f * TIP_LIMIT_MM);
    }
    if (status == BRACE_OK && (tip.r_mm < 0.0f || (knee != BRACE_KNEE_UP && knee != BRACE_KNEE_DOWN))) {
        status = BRACE_E_RANGE;
    }
    if (status != BRACE_OK) {
        return status;
    }
    float flexion_rad;
    float femur_from_tip_rad;
    if (!solve_triangle(limb, tip.r_mm, &flexion_rad, &femur_from_tip_rad)) {
        return BRACE_E_UNREACHABLE;
    }
    if (knee == BRACE_KNEE_DOWN) {
        flexion_rad = -flexion_rad;
        femur_from_tip_rad = -femur_from_tip_rad;
    }
    *theta1_rad = brace_turn_angle(brace_turn(tip.phi_rad) + brace_turn(femur_from_tip_rad));
    *theta2_rad = flexion_rad;
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_inverse(const brace_limb_t *limb, brace_point_t tip, brace_knee_t knee,
                                        float *theta1_rad, float *theta2_rad)
{
    brace_polar_t polar;
    const brace_status_t status = brace_kinematics_polar(tip, &polar);
    if (status != BRACE_OK) {
        return status;
    }
    return brace_kinematics_inverse_polar(limb, polar, knee, theta1_rad, theta2_rad);
}
