#include "measure/questions.h"

#include "measure/hypothetical.h"

brace_status_t question_k_at_tip(brace_app_t *app, brace_point_t tip, brace_knee_t knee, brace_stiffness_t *stiffness)
{
    float theta1_rad, theta2_rad;
    if (app->configure_piece != 0u) {
        return BRACE_E_MODE; /* known before anything is worked out */
    }
    const brace_status_t status =
        brace_kinematics_inverse(&app->parameters.limb, tip, knee, &theta1_rad, &theta2_rad);
    return status == BRACE_OK ? hypothetical_stiffness(app, theta1_rad, theta2_rad, stiffness) : status;
}

brace_status_t question_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                      brace_contact_force_t *contact)
{
    const brace_snapshot_t *now = brace_app_snapshot(app);
    return now->k_is_valid ? brace_contact_force(&now->stiffness.now, displacement, contact) : BRACE_E_MODE;
}

brace_status_t question_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag)
{
    const brace_snapshot_t *now = brace_app_snapshot(app);
    return now->k_is_valid ? brace_contact_sag(&now->stiffness.now, load, sag) : BRACE_E_MODE;
}

brace_status_t question_grip(const brace_app_t *app, float normal_rad, float friction_ratio, brace_contact_grip_t *grip)
{
    /* cosine and sine of the normal's direction from a pose of the same angle: no libm here */
    static const brace_limb_t ruler = {.femur_mm = 1.0f, .tibia_mm = 1.0f};
    const brace_snapshot_t *now = brace_app_snapshot(app);
    const brace_force_t force = {now->force_x_n, now->force_z_n};
    brace_pose_t pose;
    if (force.x_n != force.x_n || force.z_n != force.z_n) {
        return BRACE_E_NOT_FINITE; /* as brace_contact_grip would say, before anything is worked out */
    }
    const brace_status_t status = brace_kinematics_forward(&ruler, normal_rad, 0.0f, &pose);
    return status == BRACE_OK ? brace_contact_grip(force, pose.knee.x_mm, pose.knee.z_mm, friction_ratio, grip)
                              : status;
}
