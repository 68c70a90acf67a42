#include "brace/kinematics.h"

#include <stddef.h>

#include "base/check.h"
#include "base/off_tick.h"
#include "base/trig.h"

/* A tip this far outside the reach, as a fraction of the reach, is the rounding of one on its edge. */
#define EDGE_RATIO 5e-7f

void brace_kinematics_pose(const brace_limb_t *limb, float theta1_rad, float theta2_rad, brace_pose_t *pose)
{
    const uint32_t femur_turn = brace_turn(theta1_rad), tibia_turn = femur_turn - brace_turn(theta2_rad);
    const brace_vec_t femur = brace_direction(femur_turn);
    const float knee_x = limb->femur_mm * femur.x, knee_z = limb->femur_mm * femur.z;
    const brace_vec_t tibia = brace_direction(tibia_turn);
    const float shank_x = limb->tibia_mm * tibia.x, shank_z = limb->tibia_mm * tibia.z;
    const float x = knee_x + shank_x, z = knee_z + shank_z;
    *pose = (brace_pose_t){{knee_x, knee_z}, {x, z}, {-z, x}, {-shank_z, shank_x}};
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_forward(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                        brace_pose_t *pose)
{
    const float theta_rad[] = {theta1_rad, theta2_rad};
    const brace_status_t status = brace_check_limb(pose, theta_rad, BRACE_INPUT_ANGLES, limb);
    if (status == BRACE_OK) {
        brace_kinematics_pose(limb, theta_rad[0], theta_rad[1], pose);
    }
    return status;
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_polar(brace_point_t point, brace_polar_t *polar)
{
    const brace_status_t status = brace_check(polar, &point.x_mm, BRACE_INPUT_POINT);
    if (status == BRACE_OK) {
        polar->r_mm = brace_length(point.x_mm, point.z_mm);
        polar->phi_rad = brace_atan2(point.z_mm, point.x_mm);
    }
    return status;
}

/* The triangle femur, tibia, r, by the sums and differences of its sides. reach^2 - r^2 and r^2 - surplus^2 are
 * 2 femur tibia (1 -+ cos flexion), so the former over the root of their product is the tangent of half the flexion;
 * that of half the angle between femur and tip is to_straight beyond_surplus over the same root. Nothing cancels but
 * lengths as they were given. */
BRACE_OFF_TICK
brace_status_t brace_kinematics_inverse_polar(const brace_limb_t *limb, brace_polar_t tip, brace_knee_t knee,
                                              float *theta1_rad, float *theta2_rad)
{
    const void *given = theta1_rad != NULL ? theta2_rad : NULL;
    const brace_status_t status = brace_check_limb(given, &tip.r_mm, BRACE_INPUT_POLAR, limb);
    if (status != BRACE_OK) {
        return status;
    }
    if (brace_is_negative(tip.r_mm) || (knee != BRACE_KNEE_UP && knee != BRACE_KNEE_DOWN)) {
        return BRACE_E_RANGE;
    }
    const float reach = limb->femur_mm + limb->tibia_mm;
    const float surplus = limb->femur_mm - limb->tibia_mm, least = __builtin_fabsf(surplus);
    float r_mm = tip.r_mm < least ? least : tip.r_mm;
    r_mm = r_mm > reach ? reach : r_mm;
    if (__builtin_fabsf(r_mm - tip.r_mm) > EDGE_RATIO * reach) {
        return BRACE_E_UNREACHABLE;
    }
    const float to_straight = reach - r_mm;
    const float perimeter = reach + r_mm;
    const float beyond_surplus = r_mm - surplus;
    const float beyond_deficit = r_mm + surplus;
    const float bent = to_straight * perimeter;
    const float root = brace_sqrt(bent * (beyond_surplus * beyond_deficit));
    float flexion_rad = 2.0f * brace_atan2(bent, root);
    uint32_t ahead_of_tip = 2u * brace_turn(brace_atan2(to_straight * beyond_surplus, root));
    if (knee == BRACE_KNEE_DOWN) {
        flexion_rad = -flexion_rad;
        ahead_of_tip = 0u - ahead_of_tip;
    }
    *theta1_rad = brace_turn_angle(brace_turn(tip.phi_rad) + ahead_of_tip);
    *theta2_rad = flexion_rad;
    return BRACE_OK;
}

BRACE_OFF_TICK
brace_status_t brace_kinematics_inverse(const brace_limb_t *limb, brace_point_t tip, brace_knee_t knee,
                                        float *theta1_rad, float *theta2_rad)
{
    brace_polar_t polar;
    const brace_status_t status = brace_kinematics_polar(tip, &polar);
    return status == BRACE_OK ? brace_kinematics_inverse_polar(limb, polar, knee, theta1_rad, theta2_rad) : status;
}
