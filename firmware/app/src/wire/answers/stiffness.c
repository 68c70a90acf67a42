/* Questions about K: where the limb is not, and what K and force of now mean at the contact. */
#include "wire/answers/answer.h"

static brace_k_question_t at_posture(brace_k_where_t where, float theta0_rad, float theta1_rad, float theta2_rad,
                                     brace_force_t tip_force, float force_across_n)
{
    return (brace_k_question_t){.where = (uint32_t)where,
                                .theta_rad = {theta0_rad, theta1_rad, theta2_rad},
                                .tip = {0.0f, 0.0f},
                                .knee = BRACE_KNEE_UP,
                                .tip_force = tip_force,
                                .force_across_n = force_across_n};
}

static brace_k_question_t at_tip(float x_mm, float z_mm, brace_knee_t knee, brace_force_t tip_force)
{
    return (brace_k_question_t){.where = BRACE_K_AT_TIP,
                                .theta_rad = {0.0f, 0.0f, 0.0f},
                                .tip = {x_mm, z_mm},
                                .knee = (uint32_t)knee,
                                .tip_force = tip_force,
                                .force_across_n = 0.0f};
}

/* Asks for K; what is asked again later says so. */
static int32_t ask(const request_t *request, const brace_k_question_t *question, brace_k_answer_t *found)
{
    const int32_t status = brace_app_ask_k(request->app, request->asker, question, found);
    return status == BRACE_APP_LATER ? (int32_t)ANSWER_AGAIN : status;
}

static const brace_force_t no_force = {0.0f, 0.0f};

/* Questions for K at a posture and at a tip have answers of one shape. */
static int32_t answer_k(const request_t *request, const brace_k_question_t *question,
                        brace_k_at_posture_answer_t *answer)
{
    brace_k_answer_t found;
    const int32_t status = ask(request, question, &found);
    const brace_stiffness_t *k = &found.k;
    if (status == BRACE_OK) {
        *answer = (brace_k_at_posture_answer_t){.k_xx_n_per_mm = k->k_xx_n_per_mm,
                                                .k_xz_n_per_mm = k->k_xz_n_per_mm,
                                                .k_zz_n_per_mm = k->k_zz_n_per_mm,
                                                .lambda_min_n_per_mm = k->lambda_min_n_per_mm,
                                                .lambda_max_n_per_mm = k->lambda_max_n_per_mm,
                                                .stiff_axis_rad = k->stiff_axis_rad,
                                                .flags = k->flags};
    }
    return status;
}

int32_t answer_k_at_posture(request_t *request, const brace_k_at_posture_request_t *asked,
                            brace_k_at_posture_answer_t *answer)
{
    const brace_k_question_t question =
        at_posture(BRACE_K_AT_POSTURE, 0.0f, asked->theta1_rad, asked->theta2_rad, no_force, 0.0f);
    return answer_k(request, &question, answer);
}

int32_t answer_k_at_tip_knee_up(request_t *request, const brace_k_at_tip_knee_up_request_t *asked,
                                brace_k_at_tip_knee_up_answer_t *answer)
{
    const brace_k_question_t question = at_tip(asked->x_mm, asked->z_mm, BRACE_KNEE_UP, no_force);
    return answer_k(request, &question, answer);
}

int32_t answer_k_at_tip_knee_down(request_t *request, const brace_k_at_tip_knee_down_request_t *asked,
                                  brace_k_at_tip_knee_down_answer_t *answer)
{
    const brace_k_question_t question = at_tip(asked->x_mm, asked->z_mm, BRACE_KNEE_DOWN, no_force);
    return answer_k(request, &question, answer);
}

int32_t answer_tip_force(request_t *request, const brace_tip_force_request_t *asked, brace_tip_force_answer_t *answer)
{
    request->asked_force->is_there = true;
    request->asked_force->force = (brace_force_t){asked->fx_n, asked->fz_n};
    *answer = (brace_tip_force_answer_t){asked->fx_n, asked->fz_n};
    return BRACE_OK;
}

/* Under the force that was asked before; the answer uses it up. */
static int32_t answer_k_under_load(request_t *request, const brace_k_question_t *question,
                                   brace_k_under_load_at_posture_answer_t *answer)
{
    brace_k_answer_t found;
    if (!request->asked_force->is_there) {
        return BRACE_REFUSED_ORDER;
    }
    const int32_t status = ask(request, question, &found);
    const brace_stiffness_t *k = &found.k;
    request->asked_force->is_there = status == ANSWER_AGAIN;
    if (status == BRACE_OK) {
        *answer = (brace_k_under_load_at_posture_answer_t){.k_xx_n_per_mm = k->k_xx_n_per_mm,
                                                           .k_xz_n_per_mm = k->k_xz_n_per_mm,
                                                           .k_zz_n_per_mm = k->k_zz_n_per_mm,
                                                           .lambda_min_n_per_mm = k->lambda_min_n_per_mm,
                                                           .lambda_max_n_per_mm = k->lambda_max_n_per_mm,
                                                           .stiff_axis_rad = k->stiff_axis_rad,
                                                           .dx_mm = found.moved_mm.x_mm,
                                                           .dz_mm = found.moved_mm.z_mm,
                                                           .buckling_factor = found.buckling_factor,
                                                           .flags = k->flags};
    }
    return status;
}

int32_t answer_k_under_load_at_posture(request_t *request, const brace_k_under_load_at_posture_request_t *asked,
                                       brace_k_under_load_at_posture_answer_t *answer)
{
    const brace_k_question_t question =
        at_posture(BRACE_K_AT_POSTURE, 0.0f, asked->theta1_rad, asked->theta2_rad, request->asked_force->force, 0.0f);
    return answer_k_under_load(request, &question, answer);
}

int32_t answer_k_under_load_at_tip_knee_up(request_t *request, const brace_k_under_load_at_tip_knee_up_request_t *asked,
                                           brace_k_under_load_at_tip_knee_up_answer_t *answer)
{
    const brace_k_question_t question = at_tip(asked->x_mm, asked->z_mm, BRACE_KNEE_UP, request->asked_force->force);
    return answer_k_under_load(request, &question, answer);
}

int32_t answer_k_under_load_at_tip_knee_down(request_t *request,
                                             const brace_k_under_load_at_tip_knee_down_request_t *asked,
                                             brace_k_under_load_at_tip_knee_down_answer_t *answer)
{
    const brace_k_question_t question = at_tip(asked->x_mm, asked->z_mm, BRACE_KNEE_DOWN, request->asked_force->force);
    return answer_k_under_load(request, &question, answer);
}

int32_t answer_tip_force_in_space(request_t *request, const brace_tip_force_in_space_request_t *asked,
                                  brace_tip_force_in_space_answer_t *answer)
{
    request->asked_force->is_there_in_space = true;
    request->asked_force->force_in_space = (brace_force_t){asked->fx_n, asked->fz_n};
    request->asked_force->across_n = asked->fy_n;
    *answer = (brace_tip_force_in_space_answer_t){asked->fx_n, asked->fy_n, asked->fz_n};
    return BRACE_OK;
}

/* Under the force that was asked before, which the answer uses up; without one, under the weight alone. */
int32_t answer_k_in_space_at_posture(request_t *request, const brace_k_in_space_at_posture_request_t *asked,
                                     brace_k_in_space_at_posture_answer_t *answer)
{
    asked_force_t *force = request->asked_force;
    const bool has_force = force->is_there_in_space;
    const brace_k_question_t question =
        at_posture(BRACE_K_IN_SPACE, asked->theta0_rad, asked->theta1_rad, asked->theta2_rad,
                   has_force ? force->force_in_space : no_force, has_force ? force->across_n : 0.0f);
    brace_k_answer_t found;
    const int32_t status = ask(request, &question, &found);
    force->is_there_in_space = has_force && status == ANSWER_AGAIN;
    const brace_stiffness_spatial_t *k = &found.in_space;
    if (status == BRACE_OK) {
        *answer = (brace_k_in_space_at_posture_answer_t){.k_xx_n_per_mm = k->k_xx_n_per_mm,
                                                         .k_xy_n_per_mm = k->k_xy_n_per_mm,
                                                         .k_xz_n_per_mm = k->k_xz_n_per_mm,
                                                         .k_yy_n_per_mm = k->k_yy_n_per_mm,
                                                         .k_yz_n_per_mm = k->k_yz_n_per_mm,
                                                         .k_zz_n_per_mm = k->k_zz_n_per_mm,
                                                         .lambda_1_n_per_mm = k->lambda_n_per_mm[0],
                                                         .lambda_2_n_per_mm = k->lambda_n_per_mm[1],
                                                         .lambda_3_n_per_mm = k->lambda_n_per_mm[2],
                                                         .flags = k->flags,
                                                         .force_is_told = has_force,
                                                         .dx_mm = found.moved_mm.x_mm,
                                                         .dy_mm = found.moved_across_mm,
                                                         .dz_mm = found.moved_mm.z_mm};
    }
    return status;
}

/* A refusal reports the flags of the present K, and whether there is none. */
static void refuse_without_k(request_t *request, brace_status_t status)
{
    request->detail = brace_app_snapshot(request->app)->stiffness.now.flags;
    request->is_of_now = status == BRACE_E_MODE;
}

int32_t answer_contact_force(request_t *request, const brace_contact_force_request_t *asked,
                             brace_contact_force_answer_t *answer)
{
    const brace_displacement_t displacement = {asked->dx_mm, asked->dz_mm};
    brace_contact_force_t contact;
    const brace_status_t status = brace_app_contact_force(request->app, displacement, &contact);
    if (status == BRACE_OK) {
        *answer = (brace_contact_force_answer_t){
            .fx_n = contact.force.x_n, .fz_n = contact.force.z_n, .low_n = contact.low_n, .high_n = contact.high_n};
    }
    refuse_without_k(request, status);
    return status;
}

int32_t answer_sag_for_load(request_t *request, const brace_sag_for_load_request_t *asked,
                            brace_sag_for_load_answer_t *answer)
{
    const brace_force_t load = {asked->fx_n, asked->fz_n};
    brace_displacement_t sag;
    const brace_status_t status = brace_app_sag(request->app, load, &sag);
    if (status == BRACE_OK) {
        *answer = (brace_sag_for_load_answer_t){.dx_mm = sag.x_mm, .dz_mm = sag.z_mm};
    }
    refuse_without_k(request, status);
    return status;
}

int32_t answer_friction_margin(request_t *request, const brace_friction_margin_request_t *asked,
                               brace_friction_margin_answer_t *answer)
{
    const brace_snapshot_t *now = brace_app_snapshot(request->app);
    brace_contact_grip_t grip;
    const brace_status_t status = brace_app_grip(request->app, asked->normal_rad, asked->friction_ratio, &grip);
    if (status == BRACE_OK) {
        *answer = (brace_friction_margin_answer_t){
            .margin_n = grip.margin_n, .angle_left_rad = grip.angle_left_rad, .contact = grip.state};
    }
    request->is_of_now = now->force_x_n != now->force_x_n || now->force_z_n != now->force_z_n;
    return status;
}
