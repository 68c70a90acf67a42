/* Questions about K: elsewhere, and what the one of now means at the contact. */
#include "brace/contact.h"
#include "can/request.h"
#include "measure/hypothetical.h"

/* The answer to both questions for K has one shape; only its first byte differs. */
static int32_t answer_k(brace_app_t *app, request_t *request, float theta1_rad, float theta2_rad)
{
    brace_stiffness_t k;
    const brace_status_t status = hypothetical_stiffness(app, theta1_rad, theta2_rad, &k);
    if (status != BRACE_OK) {
        return status;
    }
    uint8_t *part = answer_place(app);
    uint32_t limited = brace_can_pack_k_at_posture_answer_0(
        &(brace_can_k_at_posture_answer_0_t){request->token, k.k_xx_n_per_mm, k.k_xz_n_per_mm}, part);
    part[0] = (uint8_t)request->code;
    part = answer_place(app);
    limited += brace_can_pack_k_at_posture_answer_1(
        &(brace_can_k_at_posture_answer_1_t){request->token, k.k_zz_n_per_mm, k.lambda_min_n_per_mm}, part);
    part[0] = (uint8_t)(request->code + BRACE_ANSWER_PART);
    part = answer_place(app);
    brace_can_k_at_posture_answer_2_t last = {request->token, k.lambda_max_n_per_mm, k.stiff_axis_rad, k.flags};
    if (limited + brace_can_pack_k_at_posture_answer_2(&last, part) > 0u) {
        last.flags |= BRACE_FLAG_SATURATED;
        (void)brace_can_pack_k_at_posture_answer_2(&last, part);
    }
    part[0] = (uint8_t)(request->code + 2u * BRACE_ANSWER_PART);
    return BRACE_OK;
}

int32_t request_k_at_posture(brace_app_t *app, request_t *request)
{
    brace_can_k_at_posture_request_t asked;
    brace_can_unpack_k_at_posture_request(request->data, &asked);
    return answer_k(app, request, asked.theta1_rad, asked.theta2_rad);
}

int32_t request_k_at_tip(brace_app_t *app, request_t *request)
{
    brace_can_k_at_tip_knee_up_request_t asked;
    float theta1_rad, theta2_rad;
    brace_can_unpack_k_at_tip_knee_up_request(request->data, &asked);
    const brace_knee_t knee =
        request->code == BRACE_REQUEST_K_AT_TIP_KNEE_UP ? BRACE_KNEE_UP : BRACE_KNEE_DOWN;
    const brace_point_t tip = {asked.x_mm, asked.z_mm};
    const brace_status_t status =
        brace_kinematics_inverse(&app->parameters.limb, tip, knee, &theta1_rad, &theta2_rad);
    return status == BRACE_OK ? answer_k(app, request, theta1_rad, theta2_rad) : (int32_t)status;
}

int32_t request_contact_force(brace_app_t *app, request_t *request)
{
    const brace_snapshot_t *now = brace_app_snapshot(app);
    brace_can_contact_force_request_t asked;
    brace_contact_force_t contact;
    uint8_t data[8];
    brace_can_unpack_contact_force_request(request->data, &asked);
    request->detail = now->stiffness.now.flags;
    const brace_displacement_t displacement = {asked.dx_mm, asked.dz_mm};
    const brace_status_t status =
        now->k_is_valid ? brace_contact_force(&now->stiffness.now, displacement, &contact) : BRACE_E_MODE;
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_contact_force_answer_0(
        &(brace_can_contact_force_answer_0_t){request->token, contact.force.x_n, contact.force.z_n}, data);
    answer_put(app, data);
    (void)brace_can_pack_contact_force_answer_1(
        &(brace_can_contact_force_answer_1_t){request->token, contact.low_n, contact.high_n}, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_sag_for_load(brace_app_t *app, request_t *request)
{
    const brace_snapshot_t *now = brace_app_snapshot(app);
    brace_can_sag_for_load_request_t asked;
    brace_displacement_t sag;
    uint8_t data[8];
    brace_can_unpack_sag_for_load_request(request->data, &asked);
    request->detail = now->stiffness.now.flags;
    const brace_force_t load = {asked.fx_n, asked.fz_n};
    const brace_status_t status =
        now->k_is_valid ? brace_contact_sag(&now->stiffness.now, load, &sag) : BRACE_E_MODE;
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_sag_for_load_answer_0(
        &(brace_can_sag_for_load_answer_0_t){request->token, sag.x_mm, sag.z_mm}, data);
    answer_put(app, data);
    return BRACE_OK;
}

int32_t request_friction_margin(brace_app_t *app, request_t *request)
{
    /* cosine and sine of the normal's direction from a pose of the same angle: no libm here */
    static const brace_limb_t ruler = {.femur_mm = 1.0f, .tibia_mm = 1.0f};
    const brace_snapshot_t *now = brace_app_snapshot(app);
    brace_can_friction_margin_request_t asked;
    brace_contact_grip_t grip;
    brace_pose_t pose;
    uint8_t data[8];
    brace_can_unpack_friction_margin_request(request->data, &asked);
    brace_status_t status = brace_kinematics_forward(&ruler, asked.normal_rad, 0.0f, &pose);
    if (status == BRACE_OK) {
        const brace_force_t force = {now->force_x_n, now->force_z_n};
        status = brace_contact_grip(force, pose.knee.x_mm, pose.knee.z_mm, asked.friction_ratio, &grip);
    }
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_friction_margin_answer_0(
        &(brace_can_friction_margin_answer_0_t){request->token, grip.margin_n, grip.angle_left_rad,
                                                grip.state},
        data);
    answer_put(app, data);
    return BRACE_OK;
}
