#include "brace/kinematics.h"

#include <math.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "base/vec.h"

/* A tip outside the reach by less than this fraction of it is taken as the rounded tip of a limb at the edge. */
#define EDGE_RATIO 5e-7f

#define POINT_LIMIT_MM 1e6f
#define RADIUS_LIMIT_MM 2e6f

brace_status_t brace_kinematics_direction(float angle_rad, brace_vec_t *direction)
{
    const brace_status_t status = brace_check_magnitude(angle_rad, BRACE_ANGLE_LIMIT_RAD);
    if (status == BRACE_OK) {
        *direction = brace_direction(angle_rad);
    }
    return status;
}

void brace_kinematics_pose(const brace_limb_t *limb, float theta1_rad, float theta2_rad, brace_pose_t *pose)
{
    const brace_vec_t femur = brace_direction(theta1_rad);
    const brace_vec_t tibia = vec_turned_back(femur, brace_direction(theta2_rad));
    const brace_vec_t knee_mm = vec_scaled(femur, limb->femur_mm);
    const brace_vec_t shank_mm = vec_scaled(tibia, limb->tibia_mm);
    const brace_vec_t tip_mm = vec_plus(knee_mm, shank_mm);
    *pose = (brace_pose_t){
        .knee = {knee_mm.x, knee_mm.z},
        .tip = {tip_mm.x, tip_mm.z},
        .lever_femur = {-tip_mm.z, tip_mm.x},
        .lever_tibia = {-shank_mm.z, shank_mm.x},
    };
}

brace_status_t brace_kinematics_forward(const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                                        brace_pose_t *pose)
{
    if (limb == NULL || pose == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_first_refusal(brace_check_two(theta1_rad, theta2_rad, BRACE_ANGLE_LIMIT_RAD),
                                                      brace_limb_check_lengths(limb));
    if (status == BRACE_OK) {
        brace_kinematics_pose(limb, theta1_rad, theta2_rad, pose);
    }
    return status;
}

brace_status_t brace_kinematics_polar(brace_point_t point, brace_polar_t *polar)
{
    if (polar == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = brace_check_two(point.x_mm, point.z_mm, POINT_LIMIT_MM);
    if (status == BRACE_OK) {
        polar->r_mm = vec_length((brace_vec_t){point.x_mm, point.z_mm});
        polar->phi_rad = brace_atan2(point.z_mm, point.x_mm);
    }
    return status;
}

static brace_status_t check_polar(const brace_limb_t *limb, brace_polar_t tip, brace_knee_t knee)
{
    brace_status_t status = brace_first_refusal(brace_check_range(tip.r_mm, 0.0f, RADIUS_LIMIT_MM),
                                                brace_check_magnitude(tip.phi_rad, BRACE_ANGLE_LIMIT_RAD));
    status = brace_first_refusal(status, brace_limb_check_lengths(limb));
    if (status == BRACE_OK && knee != BRACE_KNEE_UP && knee != BRACE_KNEE_DOWN) {
        status = BRACE_E_RANGE;
    }
    return status;
}

/* The law of cosines, by the sums and differences of the triangle's sides femur, tibia and r, so that only lengths as
 * given are subtracted from one another. With root = sqrt((reach^2 - r^2) (r^2 - surplus^2)):
 *     tan(flexion / 2) = (reach^2 - r^2) / root
 *     tan(angle between femur and tip / 2) = (reach - r) (r - surplus) / root */
brace_status_t brace_kinematics_inverse_polar(const brace_limb_t *limb, brace_polar_t tip, brace_knee_t knee,
                                              float *theta1_rad, float *theta2_rad)
{
    if (limb == NULL || theta1_rad == NULL || theta2_rad == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check_polar(limb, tip, knee);
    if (status != BRACE_OK) {
        return status;
    }
    const float reach_mm = limb->femur_mm + limb->tibia_mm;
    const float surplus_mm = limb->femur_mm - limb->tibia_mm;
    const float least_mm = fabsf(surplus_mm);
    const float r_mm = tip.r_mm < least_mm ? least_mm : tip.r_mm > reach_mm ? reach_mm : tip.r_mm;
    if (fabsf(r_mm - tip.r_mm) > EDGE_RATIO * reach_mm) {
        return BRACE_E_UNREACHABLE;
    }
    const float to_straight_mm = reach_mm - r_mm;
    const float beyond_surplus_mm = r_mm - surplus_mm;
    const float bent = to_straight_mm * (reach_mm + r_mm);
    const float root = sqrtf(bent * (beyond_surplus_mm * (r_mm + surplus_mm)));
    const float flexion_rad = 2.0f * brace_atan2(bent, root);
    const float ahead_of_tip_rad = 2.0f * brace_atan2(to_straight_mm * beyond_surplus_mm, root);
    const float side = knee == BRACE_KNEE_UP ? 1.0f : -1.0f;
    *theta1_rad = brace_wrapped(brace_wrapped(tip.phi_rad) + side * ahead_of_tip_rad);
    *theta2_rad = side * flexion_rad;
    return BRACE_OK;
}

brace_status_t brace_kinematics_inverse(const brace_limb_t *limb, brace_point_t tip, brace_knee_t knee,
                                        float *theta1_rad, float *theta2_rad)
{
    brace_polar_t polar;
    const brace_status_t status = brace_kinematics_polar(tip, &polar);
    return status == BRACE_OK ? brace_kinematics_inverse_polar(limb, polar, knee, theta1_rad, theta2_rad) : status;
}
