#include "stiffness/questions.h"

#include "posture/posture.h"

static brace_status_t k_elsewhere(const question_limb_t *limb, float theta1_rad, float theta2_rad,
                                  brace_stiffness_t *stiffness, float *across_n_per_mm)
{
    float temp_degc[BRACE_LINK_COUNT], springs_rad_per_n_mm[BRACE_LINK_COUNT];
    joints_temperatures(limb->joints, temp_degc);
    model_springs_at_rest(limb->parameters, temp_degc, springs_rad_per_n_mm);
    const brace_status_t status = model_stiffness(limb->model, limb->parameters, theta1_rad, theta2_rad,
                                                  springs_rad_per_n_mm, stiffness, across_n_per_mm);
    if (status == BRACE_OK) {
        const brace_drive_t *drive = limb->parameters->drive;
        const bool inside = posture_is_inside_travel(&drive[BRACE_FEMUR], theta1_rad) &&
                            posture_is_inside_travel(&drive[BRACE_TIBIA], theta2_rad);
        stiffness->flags |= (inside ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE) |
                            (limb->origin == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u);
    }
    return status;
}

brace_status_t question_k_at_posture(const question_limb_t *limb, float theta1_rad, float theta2_rad,
                                     brace_stiffness_t *stiffness)
{
    float across_n_per_mm;
    return k_elsewhere(limb, theta1_rad, theta2_rad, stiffness, &across_n_per_mm);
}

brace_status_t question_k_at_tip(const question_limb_t *limb, brace_point_t tip, brace_knee_t knee,
                                 brace_stiffness_t *stiffness)
{
    float theta1_rad, theta2_rad;
    const brace_status_t status =
        brace_kinematics_inverse(&limb->parameters->limb, tip, knee, &theta1_rad, &theta2_rad);
    return status == BRACE_OK ? question_k_at_posture(limb, theta1_rad, theta2_rad, stiffness) : status;
}

brace_status_t question_k_in_space(const question_limb_t *limb, float theta0_rad, float theta1_rad, float theta2_rad,
                                   brace_stiffness_spatial_t *stiffness)
{
    brace_stiffness_t plane;
    float across_n_per_mm;
    if (!limb->model->is_spatial) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = k_elsewhere(limb, theta1_rad, theta2_rad, &plane, &across_n_per_mm);
    return status == BRACE_OK ? brace_spatial_turn(theta0_rad, &plane, across_n_per_mm, stiffness) : status;
}

brace_status_t question_contact_force(const brace_snapshot_t *now, brace_displacement_t displacement,
                                      brace_contact_force_t *contact)
{
    return now->k_is_valid ? brace_contact_force(&now->stiffness.now, displacement, contact) : BRACE_E_MODE;
}

brace_status_t question_sag(const brace_snapshot_t *now, brace_force_t load, brace_displacement_t *sag)
{
    return now->k_is_valid ? brace_contact_sag(&now->stiffness.now, load, sag) : BRACE_E_MODE;
}

brace_status_t question_grip(const brace_snapshot_t *now, float normal_rad, float friction_ratio,
                             brace_contact_grip_t *grip)
{
    /* The knee of a limb with links of 1 mm stands at (cos, sin) of theta1. This gives cosine and sine without libm. */
    static const brace_limb_t unit_limb = {.femur_mm = 1.0f, .tibia_mm = 1.0f};
    const brace_force_t force = {now->force_x_n, now->force_z_n};
    brace_pose_t pose;
    if (force.x_n != force.x_n || force.z_n != force.z_n) {
        return BRACE_E_NOT_FINITE;
    }
    const brace_status_t status = brace_kinematics_forward(&unit_limb, normal_rad, 0.0f, &pose);
    return status == BRACE_OK ? brace_contact_grip(force, pose.knee.x_mm, pose.knee.z_mm, friction_ratio, grip)
                              : status;
}
