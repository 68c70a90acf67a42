/* Questions about K: where the limb is not, and what the one of now means at the contact. */
#include "wire/can/request.h"

/* Questions for K at a posture and at a tip have answers of one shape. */
static void tell_k(const brace_stiffness_t *k, brace_can_k_at_posture_answer_t *answer)
{
    *answer = (brace_can_k_at_posture_answer_t){.k_xx_n_per_mm = k->k_xx_n_per_mm,
                                                .k_xz_n_per_mm = k->k_xz_n_per_mm,
                                                .k_zz_n_per_mm = k->k_zz_n_per_mm,
                                                .lambda_min_n_per_mm = k->lambda_min_n_per_mm,
                                                .lambda_max_n_per_mm = k->lambda_max_n_per_mm,
                                                .stiff_axis_rad = k->stiff_axis_rad,
                                                .flags = k->flags};
}

int32_t can_answer_k_at_posture(can_request_t *request, const brace_can_k_at_posture_request_t *asked,
                                brace_can_k_at_posture_answer_t *answer)
{
    brace_stiffness_t k;
    const brace_status_t status =
        brace_app_k_at_posture(request->tick->app, asked->theta1_rad, asked->theta2_rad, &k);
    if (status == BRACE_OK) {
        tell_k(&k, answer);
    }
    return status;
}

static int32_t answer_k_at_tip(can_request_t *request, brace_point_t tip, brace_knee_t knee,
                               brace_can_k_at_posture_answer_t *answer)
{
    brace_stiffness_t k;
    const brace_status_t status = brace_app_k_at_tip(request->tick->app, tip, knee, &k);
    if (status == BRACE_OK) {
        tell_k(&k, answer);
    }
    return status;
}

int32_t can_answer_k_at_tip_knee_up(can_request_t *request, const brace_can_k_at_tip_knee_up_request_t *asked,
                                    brace_can_k_at_tip_knee_up_answer_t *answer)
{
    return answer_k_at_tip(request, (brace_point_t){asked->x_mm, asked->z_mm}, BRACE_KNEE_UP, answer);
}

int32_t can_answer_k_at_tip_knee_down(can_request_t *request, const brace_can_k_at_tip_knee_down_request_t *asked,
                                      brace_can_k_at_tip_knee_down_answer_t *answer)
{
    return answer_k_at_tip(request, (brace_point_t){asked->x_mm, asked->z_mm}, BRACE_KNEE_DOWN, answer);
}

int32_t can_answer_k_in_space_at_posture(can_request_t *request, const brace_can_k_in_space_at_posture_request_t *asked,
                                         brace_can_k_in_space_at_posture_answer_t *answer)
{
    brace_stiffness_spatial_t k;
    const brace_status_t status = brace_app_k_in_space(request->tick->app, asked->theta0_rad, asked->theta1_rad,
                                                     asked->theta2_rad, &k);
    if (status == BRACE_OK) {
        *answer = (brace_can_k_in_space_at_posture_answer_t){.k_xx_n_per_mm = k.k_xx_n_per_mm,
                                                             .k_xy_n_per_mm = k.k_xy_n_per_mm,
                                                             .k_xz_n_per_mm = k.k_xz_n_per_mm,
                                                             .k_yy_n_per_mm = k.k_yy_n_per_mm,
                                                             .k_yz_n_per_mm = k.k_yz_n_per_mm,
                                                             .k_zz_n_per_mm = k.k_zz_n_per_mm,
                                                             .lambda_1_n_per_mm = k.lambda_n_per_mm[0],
                                                             .lambda_2_n_per_mm = k.lambda_n_per_mm[1],
                                                             .lambda_3_n_per_mm = k.lambda_n_per_mm[2],
                                                             .flags = k.flags};
    }
    return status;
}

/* A refusal tells what the K of now is worth. */
static uint32_t flags_of_now(const can_request_t *request)
{
    return brace_app_snapshot(request->tick->app)->stiffness.now.flags;
}

int32_t can_answer_contact_force(can_request_t *request, const brace_can_contact_force_request_t *asked,
                                 brace_can_contact_force_answer_t *answer)
{
    brace_contact_force_t contact;
    request->detail = flags_of_now(request);
    const brace_status_t status = brace_app_contact_force(
        request->tick->app, (brace_displacement_t){asked->dx_mm, asked->dz_mm}, &contact);
    if (status == BRACE_OK) {
        *answer = (brace_can_contact_force_answer_t){
            .fx_n = contact.force.x_n, .fz_n = contact.force.z_n, .low_n = contact.low_n, .high_n = contact.high_n};
    }
    return status;
}

int32_t can_answer_sag_for_load(can_request_t *request, const brace_can_sag_for_load_request_t *asked,
                                brace_can_sag_for_load_answer_t *answer)
{
    brace_displacement_t sag;
    request->detail = flags_of_now(request);
    const brace_status_t status =
        brace_app_sag(request->tick->app, (brace_force_t){asked->fx_n, asked->fz_n}, &sag);
    if (status == BRACE_OK) {
        *answer = (brace_can_sag_for_load_answer_t){.dx_mm = sag.x_mm, .dz_mm = sag.z_mm};
    }
    return status;
}

int32_t can_answer_friction_margin(can_request_t *request, const brace_can_friction_margin_request_t *asked,
                                   brace_can_friction_margin_answer_t *answer)
{
    brace_contact_grip_t grip;
    const brace_status_t status =
        brace_app_grip(request->tick->app, asked->normal_rad, asked->friction_ratio, &grip);
    if (status == BRACE_OK) {
        *answer = (brace_can_friction_margin_answer_t){
            .margin_n = grip.margin_n, .angle_left_rad = grip.angle_left_rad, .contact = grip.state};
    }
    return status;
}
