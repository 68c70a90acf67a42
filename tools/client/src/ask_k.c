/* Questions about K elsewhere: at a posture or where the tip would be, with and without a force. */
#include "ask.h"
#include "client_can.h"
#include "client_modbus.h"
#include "refusal.h"

#include "brace/can_messages.h"
#include "brace/status.h"

static void take_k(const brace_question_t *question, brace_client_k_t *k)
{
    brace_can_k_at_posture_answer_0_t first;
    brace_can_k_at_posture_answer_1_t second;
    brace_can_k_at_posture_answer_2_t third;
    brace_can_k_at_posture_answer_3_t fourth;
    brace_can_unpack_k_at_posture_answer_0(question->answers[0], &first);
    brace_can_unpack_k_at_posture_answer_1(question->answers[1], &second);
    brace_can_unpack_k_at_posture_answer_2(question->answers[2], &third);
    brace_can_unpack_k_at_posture_answer_3(question->answers[3], &fourth);
    *k = (brace_client_k_t){.k_xx_n_per_mm = first.k_xx_n_per_mm,
                            .k_xz_n_per_mm = first.k_xz_n_per_mm,
                            .k_zz_n_per_mm = second.k_zz_n_per_mm,
                            .lambda_min_n_per_mm = second.lambda_min_n_per_mm,
                            .lambda_max_n_per_mm = third.lambda_max_n_per_mm,
                            .stiff_axis_rad = third.stiff_axis_rad,
                            .flags = fourth.flags};
}

static brace_client_status_t ask_modbus_for_k(brace_client_t *client, uint32_t first, const uint32_t *values,
                                              uint32_t count, int timeout_ms, brace_client_k_t *k)
{
    brace_answered_t a;
    const brace_client_status_t status =
        brace_modbus_ask(client, first, values, count, brace_client_deadline_after(timeout_ms), &a);
    if (status == BRACE_CLIENT_OK) {
        *k = (brace_client_k_t){.k_xx_n_per_mm = a.asked_k_xx_n_per_mm,
                                .k_xz_n_per_mm = a.asked_k_xz_n_per_mm,
                                .k_zz_n_per_mm = a.asked_k_zz_n_per_mm,
                                .lambda_min_n_per_mm = a.asked_lambda_min_n_per_mm,
                                .lambda_max_n_per_mm = a.asked_lambda_max_n_per_mm,
                                .stiff_axis_rad = a.asked_stiff_axis_rad,
                                .flags = a.asked_flags};
    }
    return status;
}

brace_client_status_t brace_client_k_at_posture(brace_client_t *client, float theta1_rad, float theta2_rad,
                                                int timeout_ms, brace_client_k_t *k)
{
    const brace_can_k_at_posture_request_t request = {.theta1_rad = theta1_rad, .theta2_rad = theta2_rad};
    brace_question_t question;
    const uint32_t limited =
        brace_can_pack_k_at_posture_request(&request, question.data) + !is_number(theta1_rad) + !is_number(theta2_rad);
    if (client->bus == NULL && limited == 0u) {
        const uint32_t values[] = {bits_of(theta1_rad), bits_of(theta2_rad)};
        return ask_modbus_for_k(client, BRACE_CLIENT_COMMAND_PLACE(asked_theta1_rad), values, 2u, timeout_ms, k);
    }
    const brace_client_status_t status =
        brace_client_ask(client, &question, BRACE_REQUEST_K_AT_POSTURE, limited, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        take_k(&question, k);
    }
    return status;
}

brace_client_status_t brace_client_k_at_tip(brace_client_t *client, float x_mm, float z_mm, bool knee_up,
                                            int timeout_ms, brace_client_k_t *k)
{
    const brace_can_k_at_tip_knee_up_request_t up = {.x_mm = x_mm, .z_mm = z_mm};
    const brace_can_k_at_tip_knee_down_request_t down = {.x_mm = x_mm, .z_mm = z_mm};
    brace_question_t question;
    const uint32_t limited = (knee_up ? brace_can_pack_k_at_tip_knee_up_request(&up, question.data)
                                      : brace_can_pack_k_at_tip_knee_down_request(&down, question.data)) +
                             !is_number(x_mm) + !is_number(z_mm);
    const uint32_t code = knee_up ? BRACE_REQUEST_K_AT_TIP_KNEE_UP : BRACE_REQUEST_K_AT_TIP_KNEE_DOWN;
    if (client->bus == NULL && limited == 0u) {
        const uint32_t values[] = {bits_of(x_mm), bits_of(z_mm), knee_up ? 0u : 1u};
        return ask_modbus_for_k(client, BRACE_CLIENT_COMMAND_PLACE(asked_tip_x_mm), values, 3u, timeout_ms, k);
    }
    const brace_client_status_t status = brace_client_ask(client, &question, code, limited, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        take_k(&question, k); /* the three answers have the same layout */
    }
    return status;
}

/* ------------------------------------------------------------------------------------------ under a force -- */

static void take_loaded_k(const brace_question_t *question, brace_client_loaded_k_t *k)
{
    brace_can_k_under_load_at_posture_answer_3_t moved;
    brace_can_k_under_load_at_posture_answer_4_t last;
    take_k(question, &k->k); /* parts 0 to 2 are those of K without a force, but for the flags */
    brace_can_unpack_k_under_load_at_posture_answer_3(question->answers[3], &moved);
    brace_can_unpack_k_under_load_at_posture_answer_4(question->answers[4], &last);
    k->k.flags = last.flags;
    k->moved_x_mm = moved.dx_mm;
    k->moved_z_mm = moved.dz_mm;
    k->buckling_factor = last.buckling_factor;
}

/* Asks for K at a place under a force. The question and the Modbus values hold the place; the first two values
 * are left for the force. */
static brace_client_status_t ask_under_force(brace_client_t *client, brace_question_t *question, uint32_t limited,
                                             uint32_t first, uint32_t *values, uint32_t count, float fx_n, float fz_n,
                                             int timeout_ms, brace_client_loaded_k_t *k)
{
    const brace_can_tip_force_request_t force = {.fx_n = fx_n, .fz_n = fz_n};
    brace_question_t under = {.code = BRACE_REQUEST_TIP_FORCE};
    if (limited + brace_can_pack_tip_force_request(&force, under.data) + !is_number(fx_n) + !is_number(fz_n) != 0u) {
        return brace_client_out_of_range(client);
    }
    if (client->bus != NULL) {
        const brace_client_status_t status =
            brace_can_ask_under_force(client, &under, question, brace_client_deadline_after(timeout_ms));
        if (status == BRACE_CLIENT_OK) {
            take_loaded_k(question, k);
        }
        return status;
    }
    brace_answered_t a;
    values[0] = bits_of(fx_n);
    values[1] = bits_of(fz_n);
    const brace_client_status_t status =
        brace_modbus_ask(client, first, values, count, brace_client_deadline_after(timeout_ms), &a);
    if (status == BRACE_CLIENT_OK && !is_number(a.asked_loaded_k_xx_n_per_mm)) { /* over CAN this is a refusal */
        client->refusal = BRACE_E_SINGULAR;
        return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u has no K there: " BRACE_CLIENT_FOLDS,
                                 client->url, (unsigned)client->unit);
    }
    if (status == BRACE_CLIENT_OK) {
        *k = (brace_client_loaded_k_t){.k = {.k_xx_n_per_mm = a.asked_loaded_k_xx_n_per_mm,
                                             .k_xz_n_per_mm = a.asked_loaded_k_xz_n_per_mm,
                                             .k_zz_n_per_mm = a.asked_loaded_k_zz_n_per_mm,
                                             .lambda_min_n_per_mm = a.asked_loaded_lambda_min_n_per_mm,
                                             .lambda_max_n_per_mm = a.asked_loaded_lambda_max_n_per_mm,
                                             .stiff_axis_rad = a.asked_loaded_stiff_axis_rad,
                                             .flags = a.asked_loaded_flags},
                                       .moved_x_mm = a.asked_moved_x_mm,
                                       .moved_z_mm = a.asked_moved_z_mm,
                                       .buckling_factor = a.asked_buckling_factor};
    }
    return status;
}

brace_client_status_t brace_client_k_under_load_at_posture(brace_client_t *client, float theta1_rad, float theta2_rad,
                                                           float fx_n, float fz_n, int timeout_ms,
                                                           brace_client_loaded_k_t *k)
{
    const brace_can_k_under_load_at_posture_request_t request = {.theta1_rad = theta1_rad, .theta2_rad = theta2_rad};
    uint32_t values[4] = {0u, 0u, bits_of(theta1_rad), bits_of(theta2_rad)};
    brace_question_t question = {.code = BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE};
    const uint32_t limited = brace_can_pack_k_under_load_at_posture_request(&request, question.data) +
                             !is_number(theta1_rad) + !is_number(theta2_rad);
    return ask_under_force(client, &question, limited, BRACE_CLIENT_COMMAND_PLACE(asked_posture_force_x_n), values, 4u,
                           fx_n, fz_n, timeout_ms, k);
}

brace_client_status_t brace_client_k_under_load_at_tip(brace_client_t *client, float x_mm, float z_mm, bool knee_up,
                                                       float fx_n, float fz_n, int timeout_ms,
                                                       brace_client_loaded_k_t *k)
{
    const brace_can_k_under_load_at_tip_knee_up_request_t up = {.x_mm = x_mm, .z_mm = z_mm};
    const brace_can_k_under_load_at_tip_knee_down_request_t down = {.x_mm = x_mm, .z_mm = z_mm};
    uint32_t values[5] = {0u, 0u, bits_of(x_mm), bits_of(z_mm), knee_up ? 0u : 1u};
    brace_question_t question = {.code = knee_up ? BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP
                                                 : BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN};
    const uint32_t limited = (knee_up ? brace_can_pack_k_under_load_at_tip_knee_up_request(&up, question.data)
                                      : brace_can_pack_k_under_load_at_tip_knee_down_request(&down, question.data)) +
                             !is_number(x_mm) + !is_number(z_mm);
    return ask_under_force(client, &question, limited, BRACE_CLIENT_COMMAND_PLACE(asked_tip_force_x_n), values, 5u,
                           fx_n, fz_n, timeout_ms, k);
}

/* ----------------------------------------------------------------------------------------------- in space -- */

static void take_space_k(const brace_question_t *question, brace_client_loaded_space_k_t *k)
{
    brace_can_k_in_space_at_posture_answer_0_t x;
    brace_can_k_in_space_at_posture_answer_1_t xz_yy;
    brace_can_k_in_space_at_posture_answer_2_t z;
    brace_can_k_in_space_at_posture_answer_3_t lower;
    brace_can_k_in_space_at_posture_answer_4_t largest;
    brace_can_unpack_k_in_space_at_posture_answer_0(question->answers[0], &x);
    brace_can_unpack_k_in_space_at_posture_answer_1(question->answers[1], &xz_yy);
    brace_can_unpack_k_in_space_at_posture_answer_2(question->answers[2], &z);
    brace_can_unpack_k_in_space_at_posture_answer_3(question->answers[3], &lower);
    brace_can_unpack_k_in_space_at_posture_answer_4(question->answers[4], &largest);
    brace_can_k_in_space_at_posture_answer_5_t moved;
    brace_can_unpack_k_in_space_at_posture_answer_5(question->answers[5], &moved);
    k->moved_x_mm = moved.dx_mm;
    k->moved_y_mm = moved.dy_mm;
    k->moved_z_mm = moved.dz_mm;
    k->k = (brace_client_space_k_t){
        .k_xx_n_per_mm = x.k_xx_n_per_mm,
        .k_xy_n_per_mm = x.k_xy_n_per_mm,
        .k_xz_n_per_mm = xz_yy.k_xz_n_per_mm,
        .k_yy_n_per_mm = xz_yy.k_yy_n_per_mm,
        .k_yz_n_per_mm = z.k_yz_n_per_mm,
        .k_zz_n_per_mm = z.k_zz_n_per_mm,
        .lambda_n_per_mm = {lower.lambda_1_n_per_mm, lower.lambda_2_n_per_mm, largest.lambda_3_n_per_mm},
        .flags = largest.flags};
}

/* A limb without a coxa joint has no theta0. */
static brace_client_status_t fail_without_space_k(brace_client_t *client, uint64_t deadline_us)
{
    float theta0_rad;
    const brace_client_status_t status =
        brace_client_entry_f32(client, BRACE_CLIENT_ENTRY(theta0_rad), brace_bus_left_ms(deadline_us), &theta0_rad);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    client->refusal = is_number(theta0_rad) ? BRACE_E_SINGULAR : BRACE_E_UNSUPPORTED;
    return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u has no K there: %s", client->url,
                             (unsigned)client->unit, is_number(theta0_rad) ? BRACE_CLIENT_FOLDS : BRACE_CLIENT_NO_COXA);
}

static brace_client_status_t ask_modbus_for_space_k(brace_client_t *client, const float theta_rad[3],
                                                    const float force_n[3], uint64_t deadline_us,
                                                    brace_client_loaded_space_k_t *k)
{
    const uint32_t values[] = {bits_of(force_n[0]),   bits_of(force_n[1]),   bits_of(force_n[2]),
                               bits_of(theta_rad[0]), bits_of(theta_rad[1]), bits_of(theta_rad[2])};
    brace_answered_t a;
    const brace_client_status_t status =
        brace_modbus_ask(client, BRACE_CLIENT_COMMAND_PLACE(asked_space_force_x_n), values, 6u, deadline_us, &a);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    if (!is_number(a.asked_space_k_xx_n_per_mm) && a.asked_space_flags == UINT32_MAX) {
        return fail_without_space_k(client, deadline_us);
    }
    *k = (brace_client_loaded_space_k_t){
        .k = {.k_xx_n_per_mm = a.asked_space_k_xx_n_per_mm,
              .k_xy_n_per_mm = a.asked_space_k_xy_n_per_mm,
              .k_xz_n_per_mm = a.asked_space_k_xz_n_per_mm,
              .k_yy_n_per_mm = a.asked_space_k_yy_n_per_mm,
              .k_yz_n_per_mm = a.asked_space_k_yz_n_per_mm,
              .k_zz_n_per_mm = a.asked_space_k_zz_n_per_mm,
              .lambda_n_per_mm = {a.asked_space_lambda_1_n_per_mm, a.asked_space_lambda_2_n_per_mm,
                                  a.asked_space_lambda_3_n_per_mm},
              .flags = a.asked_space_flags},
        .moved_x_mm = a.asked_space_moved_x_mm,
        .moved_y_mm = a.asked_space_moved_y_mm,
        .moved_z_mm = a.asked_space_moved_z_mm};
    return BRACE_CLIENT_OK;
}

brace_client_status_t brace_client_k_in_space_under_load(brace_client_t *client, const float theta_rad[3],
                                                         const float force_n[3], int timeout_ms,
                                                         brace_client_loaded_space_k_t *k)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    const brace_can_k_in_space_at_posture_request_t request = {
        .theta0_rad = theta_rad[0], .theta1_rad = theta_rad[1], .theta2_rad = theta_rad[2]};
    const brace_can_tip_force_in_space_request_t force = {.fx_n = force_n[0], .fy_n = force_n[1], .fz_n = force_n[2]};
    brace_question_t under = {.code = BRACE_REQUEST_TIP_FORCE_IN_SPACE};
    brace_question_t question = {.code = BRACE_REQUEST_K_IN_SPACE_AT_POSTURE};
    uint32_t limited = brace_can_pack_k_in_space_at_posture_request(&request, question.data) +
                       brace_can_pack_tip_force_in_space_request(&force, under.data);
    for (int i = 0; i < 3; i++) {
        limited += (uint32_t)!is_number(theta_rad[i]) + (uint32_t)!is_number(force_n[i]);
    }
    if (limited != 0u) {
        return brace_client_out_of_range(client);
    }
    if (client->bus == NULL) {
        return ask_modbus_for_space_k(client, theta_rad, force_n, deadline_us, k);
    }
    const brace_client_status_t status = brace_can_ask_under_force(client, &under, &question, deadline_us);
    if (status == BRACE_CLIENT_OK) {
        take_space_k(&question, k);
    }
    return status;
}

brace_client_status_t brace_client_k_in_space(brace_client_t *client, float theta0_rad, float theta1_rad,
                                              float theta2_rad, int timeout_ms, brace_client_space_k_t *k)
{
    const float theta_rad[3] = {theta0_rad, theta1_rad, theta2_rad}, none_n[3] = {0.0f, 0.0f, 0.0f};
    brace_client_loaded_space_k_t found;
    const brace_client_status_t status =
        brace_client_k_in_space_under_load(client, theta_rad, none_n, timeout_ms, &found);
    if (status == BRACE_CLIENT_OK) {
        *k = found.k;
    }
    return status;
}
