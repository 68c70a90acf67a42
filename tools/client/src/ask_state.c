/* Questions about the limb as it is now: its load, contact, drift, take-up; and where gravity points. */
#include "ask.h"
#include "client_can.h"
#include "client_modbus.h"
#include "command.h"

#include "brace/can_messages.h"

brace_client_status_t brace_client_load(brace_client_t *client, int timeout_ms, brace_client_load_t *load)
{
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    if (client->bus == NULL) {
        return brace_modbus_load(client, deadline_us, load);
    }
    brace_client_load_t taken = {0};
    const struct {
        uint32_t index;
        float *value;
    } entries[] = {{BRACE_CLIENT_ENTRY(counted_force_x_n), &taken.force_x_n},
                   {BRACE_CLIENT_ENTRY(counted_force_z_n), &taken.force_z_n},
                   {BRACE_CLIENT_ENTRY(unloaded_k_xx_n_per_mm), &taken.unloaded_k_xx_n_per_mm},
                   {BRACE_CLIENT_ENTRY(unloaded_k_xz_n_per_mm), &taken.unloaded_k_xz_n_per_mm},
                   {BRACE_CLIENT_ENTRY(unloaded_k_zz_n_per_mm), &taken.unloaded_k_zz_n_per_mm},
                   {BRACE_CLIENT_ENTRY(moved_x_mm), &taken.moved_x_mm},
                   {BRACE_CLIENT_ENTRY(moved_z_mm), &taken.moved_z_mm},
                   {BRACE_CLIENT_ENTRY(buckling_factor), &taken.buckling_factor},
                   {BRACE_CLIENT_ENTRY(gravity_direction_rad), &taken.gravity_direction_rad},
                   {BRACE_CLIENT_ENTRY(gravity_lean_rad), &taken.gravity_lean_rad},
                   {BRACE_CLIENT_ENTRY(counted_force_y_n), &taken.force_y_n},
                   {BRACE_CLIENT_ENTRY(moved_y_mm), &taken.moved_y_mm},
                   {BRACE_CLIENT_ENTRY(unloaded_k_across_n_per_mm), &taken.unloaded_k_across_n_per_mm}};
    for (size_t i = 0u; i < sizeof entries / sizeof entries[0]; i++) {
        const brace_client_status_t status =
            brace_client_entry_f32(client, entries[i].index, brace_bus_left_ms(deadline_us), entries[i].value);
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
    }
    taken.is_counted = is_number(taken.force_x_n) && is_number(taken.force_z_n);
    *load = taken;
    return BRACE_CLIENT_OK;
}

brace_client_status_t brace_client_set_gravity(brace_client_t *client, float direction_rad, float lean_rad,
                                               int timeout_ms)
{
    const brace_can_set_gravity_request_t request = {.direction_rad = direction_rad, .lean_rad = lean_rad};
    const bool as_parameters_say = direction_rad != direction_rad && lean_rad != lean_rad;
    brace_command_t command = {.question = {.code = BRACE_REQUEST_SET_GRAVITY},
                               .place = BRACE_CLIENT_COMMAND_PLACE(asked_gravity_direction_rad),
                               .values = {bits_of(direction_rad), bits_of(lean_rad)},
                               .count = 2u};
    const uint32_t limited = brace_can_pack_set_gravity_request(&request, command.question.data);
    if (!as_parameters_say && (limited != 0u || !is_number(direction_rad) || !is_number(lean_rad))) {
        return brace_client_out_of_range(client);
    }
    return brace_client_command(client, &command, brace_client_deadline_after(timeout_ms));
}

brace_client_status_t brace_client_drift(brace_client_t *client, int timeout_ms, brace_client_drift_t *drift)
{
    const brace_can_drift_request_t request = {0};
    brace_question_t question;
    if (client->bus == NULL) {
        return brace_modbus_drift(client, brace_client_deadline_after(timeout_ms), drift);
    }
    const uint32_t limited = brace_can_pack_drift_request(&request, question.data);
    const brace_client_status_t status = brace_client_ask(client, &question, BRACE_REQUEST_DRIFT, limited, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        brace_can_drift_answer_0_t cause;
        brace_can_drift_answer_1_t loss;
        brace_can_drift_answer_2_t since;
        brace_can_unpack_drift_answer_0(question.answers[0], &cause);
        brace_can_unpack_drift_answer_1(question.answers[1], &loss);
        brace_can_unpack_drift_answer_2(question.answers[2], &since);
        *drift = (brace_client_drift_t){.state = cause.state,
                                        .cause = cause.cause,
                                        .could_be = cause.could_be,
                                        .next_step = cause.next_step,
                                        .evidence = cause.evidence,
                                        .loss_ratio = loss.loss_ratio,
                                        .loss_sigma_ratio = loss.loss_sigma_ratio,
                                        .since_readings = since.since_readings,
                                        .readings = since.readings};
    }
    return status;
}

brace_client_status_t brace_client_take_up(brace_client_t *client, uint32_t joint, int timeout_ms, int32_t *outcome)
{
    uint32_t value;
    if (joint > 2u) {
        return brace_client_fail(client, BRACE_CLIENT_E_USAGE, "joint %u: 0 coxa, 1 femur, 2 tibia", (unsigned)joint);
    }
    const uint32_t index = BRACE_CLIENT_ENTRY(take_up_coxa) + joint;
    const brace_client_status_t status = brace_client_entry_u32(client, index, timeout_ms, &value);
    if (status == BRACE_CLIENT_OK) {
        *outcome = brace_client_outcome(value);
    }
    return status;
}

/* ----------------------------------------------------------------------------------------- at the contact -- */

/* Asks a question of two numbers. */
static brace_client_status_t ask_two(brace_client_t *client, brace_question_t *question, uint32_t code,
                                     uint32_t limited, float a, float b, int timeout_ms)
{
    return brace_client_ask(client, question, code, limited + !is_number(a) + !is_number(b), timeout_ms);
}

brace_client_status_t brace_client_contact_force(brace_client_t *client, float dx_mm, float dz_mm, int timeout_ms,
                                                 brace_client_force_t *force)
{
    const brace_can_contact_force_request_t request = {.dx_mm = dx_mm, .dz_mm = dz_mm};
    brace_question_t question;
    const uint32_t limited = brace_can_pack_contact_force_request(&request, question.data);
    const brace_client_status_t status =
        ask_two(client, &question, BRACE_REQUEST_CONTACT_FORCE, limited, dx_mm, dz_mm, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        brace_can_contact_force_answer_0_t first;
        brace_can_contact_force_answer_1_t second;
        brace_can_unpack_contact_force_answer_0(question.answers[0], &first);
        brace_can_unpack_contact_force_answer_1(question.answers[1], &second);
        *force = (brace_client_force_t){
            .fx_n = first.fx_n, .fz_n = first.fz_n, .low_n = second.low_n, .high_n = second.high_n};
    }
    return status;
}

brace_client_status_t brace_client_sag(brace_client_t *client, float fx_n, float fz_n, int timeout_ms, float *dx_mm,
                                       float *dz_mm)
{
    const brace_can_sag_for_load_request_t request = {.fx_n = fx_n, .fz_n = fz_n};
    brace_question_t question;
    const uint32_t limited = brace_can_pack_sag_for_load_request(&request, question.data);
    const brace_client_status_t status =
        ask_two(client, &question, BRACE_REQUEST_SAG_FOR_LOAD, limited, fx_n, fz_n, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        brace_can_sag_for_load_answer_0_t answer;
        brace_can_unpack_sag_for_load_answer_0(question.answers[0], &answer);
        *dx_mm = answer.dx_mm;
        *dz_mm = answer.dz_mm;
    }
    return status;
}

brace_client_status_t brace_client_margin(brace_client_t *client, float normal_rad, float friction_ratio,
                                          int timeout_ms, brace_client_margin_t *margin)
{
    const brace_can_friction_margin_request_t request = {.normal_rad = normal_rad, .friction_ratio = friction_ratio};
    brace_question_t question;
    const uint32_t limited = brace_can_pack_friction_margin_request(&request, question.data);
    const brace_client_status_t status =
        ask_two(client, &question, BRACE_REQUEST_FRICTION_MARGIN, limited, normal_rad, friction_ratio, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        brace_can_friction_margin_answer_0_t answer;
        brace_can_unpack_friction_margin_answer_0(question.answers[0], &answer);
        *margin = (brace_client_margin_t){
            .margin_n = answer.margin_n, .angle_left_rad = answer.angle_left_rad, .contact = answer.contact};
    }
    return status;
}
