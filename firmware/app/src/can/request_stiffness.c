/* Questions about K: elsewhere, and what the one of now means at the contact. */
#include "can/request.h"
#include "measure/hypothetical.h"
#include "measure/questions.h"

enum { FLAGS_BYTE = 7 }; /* of the answer's last part: all of it */

/* The answer to both questions for K has one shape; only its first byte differs. */
static int32_t answer_k(brace_app_t *app, const request_t *request, brace_status_t status, const brace_stiffness_t *k)
{
    if (status != BRACE_OK) {
        return status;
    }
    uint8_t *part = answer_place(app);
    uint32_t limited = brace_can_pack_k_at_posture_answer_0(
        &(brace_can_k_at_posture_answer_0_t){request->token, k->k_xx_n_per_mm, k->k_xz_n_per_mm}, part);
    part[0] = (uint8_t)request->code;
    part = answer_place(app);
    limited += brace_can_pack_k_at_posture_answer_1(
        &(brace_can_k_at_posture_answer_1_t){request->token, k->k_zz_n_per_mm, k->lambda_min_n_per_mm}, part);
    part[0] = (uint8_t)(request->code + BRACE_ANSWER_PART);
    part = answer_place(app);
    limited += brace_can_pack_k_at_posture_answer_2(
        &(brace_can_k_at_posture_answer_2_t){request->token, k->lambda_max_n_per_mm, k->stiff_axis_rad, k->flags},
        part);
    part[FLAGS_BYTE] |= limited > 0u ? (uint8_t)BRACE_FLAG_SATURATED : 0u; /* packed anew it would cost as much again */
    part[0] = (uint8_t)(request->code + 2u * BRACE_ANSWER_PART);
    return BRACE_OK;
}

int32_t request_k_at_posture(brace_app_t *app, request_t *request)
{
    brace_can_k_at_posture_request_t asked;
    brace_stiffness_t k;
    brace_can_unpack_k_at_posture_request(request->data, &asked);
    const brace_status_t status = hypothetical_stiffness(app, asked.theta1_rad, asked.theta2_rad, &k);
    return answer_k(app, request, status, &k);
}

int32_t request_k_at_tip(brace_app_t *app, request_t *request)
{
    brace_can_k_at_tip_knee_up_request_t asked;
    brace_stiffness_t k;
    brace_can_unpack_k_at_tip_knee_up_request(request->data, &asked);
    const brace_knee_t knee =
        request->code == BRACE_REQUEST_K_AT_TIP_KNEE_UP ? BRACE_KNEE_UP : BRACE_KNEE_DOWN;
    const brace_status_t status = question_k_at_tip(app, (brace_point_t){asked.x_mm, asked.z_mm}, knee, &k);
    return answer_k(app, request, status, &k);
}

int32_t request_contact_force(brace_app_t *app, request_t *request)
{
    brace_can_contact_force_request_t asked;
    brace_contact_force_t contact;
    brace_can_unpack_contact_force_request(request->data, &asked);
    request->detail = brace_app_snapshot(app)->stiffness.now.flags;
    const brace_status_t status =
        question_contact_force(app, (brace_displacement_t){asked.dx_mm, asked.dz_mm}, &contact);
    if (status != BRACE_OK) {
        return status;
    }
    (void)brace_can_pack_contact_force_answer_0(
        &(brace_can_contact_force_answer_0_t){request->token, contact.force.x_n, contact.force.z_n}, answer_place(app));
    (void)brace_can_pack_contact_force_answer_1(
        &(brace_can_contact_force_answer_1_t){request->token, contact.low_n, contact.high_n}, answer_place(app));
    return BRACE_OK;
}

int32_t request_sag_for_load(brace_app_t *app, request_t *request)
{
    brace_can_sag_for_load_request_t asked;
    brace_displacement_t sag;
    brace_can_unpack_sag_for_load_request(request->data, &asked);
    request->detail = brace_app_snapshot(app)->stiffness.now.flags;
    const brace_status_t status = question_sag(app, (brace_force_t){asked.fx_n, asked.fz_n}, &sag);
    if (status == BRACE_OK) {
        (void)brace_can_pack_sag_for_load_answer_0(
            &(brace_can_sag_for_load_answer_0_t){request->token, sag.x_mm, sag.z_mm}, answer_place(app));
    }
    return status;
}

int32_t request_friction_margin(brace_app_t *app, request_t *request)
{
    brace_can_friction_margin_request_t asked;
    brace_contact_grip_t grip;
    brace_can_unpack_friction_margin_request(request->data, &asked);
    const brace_status_t status = question_grip(app, asked.normal_rad, asked.friction_ratio, &grip);
    if (status == BRACE_OK) {
        (void)brace_can_pack_friction_margin_answer_0(
            &(brace_can_friction_margin_answer_0_t){request->token, grip.margin_n, grip.angle_left_rad, grip.state},
            answer_place(app));
    }
    return status;
}
