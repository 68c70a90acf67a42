/* Questions of brace/requests.h: K where the limb is not, and what K and force of now mean at the contact. */
#include <stddef.h>

#include "brace/requests.h"
#include "controller.h"

static brace_status_t k_elsewhere(controller_t *controller, float theta1_rad, float theta2_rad,
                                  brace_stiffness_t *stiffness, float *across_n_per_mm)
{
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    float temp_degc[BRACE_LINK_COUNT];
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    joints_temperatures(&controller->joints, temp_degc);
    model_springs_at_rest(parameters, temp_degc, springs);
    const brace_status_t status = model_stiffness(&controller->model, parameters, theta1_rad, theta2_rad,
                                                  springs, stiffness, across_n_per_mm);
    if (status == BRACE_OK) {
        const bool inside = posture_is_inside_travel(&parameters->drive[BRACE_FEMUR], theta1_rad) &&
                            posture_is_inside_travel(&parameters->drive[BRACE_TIBIA], theta2_rad);
        const bool is_default = controller->parameters.origin == BRACE_PARAMETERS_DEFAULT;
        stiffness->flags |= (inside ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE) |
                            (is_default ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u);
    }
    return status;
}

brace_status_t brace_app_k_at_posture(brace_app_t *app, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness)
{
    float across_n_per_mm;
    return app == NULL || stiffness == NULL
               ? BRACE_E_NULL
               : k_elsewhere(controller_of(app), theta1_rad, theta2_rad, stiffness, &across_n_per_mm);
}

brace_status_t brace_app_k_at_tip(brace_app_t *app, brace_point_t tip, brace_knee_t knee,
                                  brace_stiffness_t *stiffness)
{
    float theta1_rad, theta2_rad;
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status =
        brace_kinematics_inverse(&brace_app_parameters(app)->limb, tip, knee, &theta1_rad, &theta2_rad);
    return status == BRACE_OK ? brace_app_k_at_posture(app, theta1_rad, theta2_rad, stiffness) : status;
}

brace_status_t brace_app_k_in_space(brace_app_t *app, float theta0_rad, float theta1_rad, float theta2_rad,
                                    brace_stiffness_spatial_t *stiffness)
{
    brace_stiffness_t plane;
    float across_n_per_mm;
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    if (!controller->model.is_spatial) {
        return BRACE_E_UNSUPPORTED;
    }
    const brace_status_t status = k_elsewhere(controller, theta1_rad, theta2_rad, &plane, &across_n_per_mm);
    return status == BRACE_OK ? brace_spatial_turn(theta0_rad, &plane, across_n_per_mm, stiffness) : status;
}

brace_status_t brace_app_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                       brace_contact_force_t *contact)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_snapshot_t *now = brace_app_snapshot(app);
    return now->k_is_valid ? brace_contact_force(&now->stiffness.now, displacement, contact) : BRACE_E_MODE;
}

brace_status_t brace_app_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_snapshot_t *now = brace_app_snapshot(app);
    return now->k_is_valid ? brace_contact_sag(&now->stiffness.now, load, sag) : BRACE_E_MODE;
}

brace_status_t brace_app_grip(const brace_app_t *app, float normal_rad, float friction_ratio,
                              brace_contact_grip_t *grip)
{
    brace_vec_t normal;
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_snapshot_t *now = brace_app_snapshot(app);
    const brace_force_t force = {now->force_x_n, now->force_z_n};
    if (force.x_n != force.x_n || force.z_n != force.z_n) {
        return BRACE_E_NOT_FINITE;
    }
    const brace_status_t status = brace_kinematics_direction(normal_rad, &normal);
    return status == BRACE_OK ? brace_contact_grip(force, normal.x, normal.z, friction_ratio, grip) : status;
}
