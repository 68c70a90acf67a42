/* Questions of brace/requests.h: K where the limb is not, and what K and force of now mean at the contact. */
#include <stddef.h>

#include "brace/requests.h"
#include "controller.h"
#include "stiffness/stiffness.h"
#include "tip_load.h"

#define HALF_TURN_RAD 3.14159265f

int32_t brace_app_ask_k(brace_app_t *app, brace_asker_t asker, const brace_k_question_t *question,
                        brace_k_answer_t *answer)
{
    return app == NULL || question == NULL || answer == NULL
               ? (int32_t)BRACE_E_NULL
               : question_job_ask(&controller_of(app)->question, asker, question, answer);
}

bool brace_app_k_is_coming(brace_app_t *app, brace_asker_t asker)
{
    return app != NULL && question_job_is_coming(&controller_of(app)->question, asker);
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
    const brace_status_t status = brace_kinematics_direction(normal_rad, &normal);
    return status == BRACE_OK ? brace_contact_grip(force, normal.x, normal.z, friction_ratio, grip) : status;
}

/* How far a joint's load may be from the load that the controller tells [N mm], with a sign. The mean lags behind, and
 * the motor's friction carries a part of the load. Both are bounds and independent. NaN: not known */
static float load_off_n_mm(const controller_t *controller, int index)
{
    const brace_drive_t *drive = &controller->parameters.in_force.drive[index];
    const float lag_n_mm = flank_lag_n_mm(&controller->flank, &controller->joints, index);
    const float friction_n_mm = drive->motor_friction_n_mm * (1.0f + drive->motor_friction_tolerance_ratio);
    return __builtin_copysignf(__builtin_sqrtf(lag_n_mm * lag_n_mm + friction_n_mm * friction_n_mm), lag_n_mm);
}

/* K if one joint's load were off_n_mm larger than told. The deflections that the model keeps between ticks are
 * left unchanged.
 * returns as model_loaded */
static brace_status_t k_if_off(controller_t *controller, int index, float off_n_mm, brace_stiffness_t *stiffness)
{
    const brace_snapshot_load_t *told = &controller->snapshot[controller->newest].load;
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    float load_n_mm[BRACE_LINK_COUNT], temp_degc[BRACE_LINK_COUNT], deflection_rad[BRACE_LINK_COUNT];
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    model_t *model = &controller->model;
    model_place_t place;
    model_rest_t rest;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        load_n_mm[i] = controller->flank.joint[i].out.load_n_mm;
        deflection_rad[i] = model->deflection_rad[i];
    }
    const brace_vec3_t before = tip_load_n(controller, load_n_mm);
    load_n_mm[index] += off_n_mm;
    const brace_vec3_t after = tip_load_n(controller, load_n_mm);
    const brace_vec3_t tip_n = {told->force_x_n + (after.x - before.x), told->force_y_n + (after.y - before.y),
                                told->force_z_n + (after.z - before.z)};
    joints_temperatures(&controller->joints, temp_degc);
    model_springs(model, parameters, load_n_mm, temp_degc, springs);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        model->deflection_rad[i] = deflection_rad[i];
    }
    stiffness_hold_measured_joints(&controller->posture, springs);
    const brace_status_t status = model_loaded(model, &parameters->limb, controller->posture.unbent_rad, springs, tip_n,
                                               controller->gravity.down, &place, &rest);
    if (status == BRACE_OK) {
        *stiffness = rest.plane;
    }
    return status;
}

/* A sigma, and the sigma of a value that may be anywhere within a span to either side, together. */
static float with_span(float sigma, float span)
{
    return __builtin_sqrtf(sigma * sigma + span * span * (1.0f / 3.0f));
}

/* The angle between two axes, each in [-pi/2, pi/2]. */
static float between_axes_rad(float one_rad, float other_rad)
{
    const float apart_rad = __builtin_fabsf(one_rad - other_rad);
    return apart_rad > HALF_TURN_RAD - apart_rad ? HALF_TURN_RAD - apart_rad : apart_rad;
}

/* Adds to sigma that K may lie anywhere from k to other. */
static void count_span(brace_stiffness_sigma_t *sigma, const brace_stiffness_t *k, const brace_stiffness_t *other)
{
    const float axis_rad = with_span(sigma->stiff_axis_rad, between_axes_rad(k->stiff_axis_rad, other->stiff_axis_rad));
    const bool is_known = axis_rad < BRACE_UNKNOWN_AXIS_RAD;
    sigma->k_xx_n_per_mm = with_span(sigma->k_xx_n_per_mm, other->k_xx_n_per_mm - k->k_xx_n_per_mm);
    sigma->k_xz_n_per_mm = with_span(sigma->k_xz_n_per_mm, other->k_xz_n_per_mm - k->k_xz_n_per_mm);
    sigma->k_zz_n_per_mm = with_span(sigma->k_zz_n_per_mm, other->k_zz_n_per_mm - k->k_zz_n_per_mm);
    sigma->lambda_min_n_per_mm =
        with_span(sigma->lambda_min_n_per_mm, other->lambda_min_n_per_mm - k->lambda_min_n_per_mm);
    sigma->lambda_max_n_per_mm =
        with_span(sigma->lambda_max_n_per_mm, other->lambda_max_n_per_mm - k->lambda_max_n_per_mm);
    sigma->stiff_axis_rad = is_known ? axis_rad : BRACE_UNKNOWN_AXIS_RAD;
    sigma->flags |= is_known ? 0u : (uint32_t)BRACE_FLAG_SATURATED;
}

/* The limb in force; where a flank is not known, its joint stands anywhere in its gap. */
static brace_limb_t limb_as_known(const controller_t *controller, uint32_t flags)
{
    brace_limb_t limb = controller->parameters.in_force.limb;
    float *angle_rad = &limb.uncertainty.angle_rad;
    for (int i = BRACE_FEMUR; i <= BRACE_TIBIA && (flags & (uint32_t)BRACE_FLAG_GAP_OPEN) != 0u; i++) {
        const float stands_rad = 0.5f * limb.joint[i].gap_rad;
        *angle_rad = __builtin_sqrtf(*angle_rad * *angle_rad + stands_rad * stands_rad);
    }
    return limb;
}

brace_status_t brace_app_uncertainty(brace_app_t *app, brace_stiffness_sigma_t *sigma)
{
    if (app == NULL || sigma == NULL) {
        return BRACE_E_NULL;
    }
    controller_t *controller = controller_of(app);
    const brace_snapshot_t *now = brace_app_snapshot(app);
    if (!now->k_is_valid) {
        return BRACE_E_MODE;
    }
    const brace_stiffness_t *k = &now->stiffness.engaged;
    const brace_limb_t limb = limb_as_known(controller, now->stiffness.now.flags);
    const brace_status_t status =
        brace_uncertainty_known(&limb, now->theta_rad[BRACE_FEMUR], now->theta_rad[BRACE_TIBIA], k, sigma);
    if (status != BRACE_OK || !now->load.is_counted) {
        return status;
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (!controller->joints.joint[i].sound) {
            continue; /* the coxa joint, where its force counts in no K */
        }
        brace_stiffness_t other;
        if (k_if_off(controller, i, load_off_n_mm(controller, i), &other) == BRACE_OK) {
            count_span(sigma, k, &other);
        } else {
            const float unknown = __builtin_inff();
            *sigma = (brace_stiffness_sigma_t){unknown, unknown, unknown, unknown, unknown, BRACE_UNKNOWN_AXIS_RAD,
                                               sigma->flags | (uint32_t)BRACE_FLAG_SATURATED};
        }
    }
    return BRACE_OK;
}
