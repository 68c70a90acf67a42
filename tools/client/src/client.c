#include "client_internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "brace/can_messages.h"
#include "brace/status.h"

brace_client_status_t brace_client_fail(brace_client_t *client, brace_client_status_t status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(client->why, sizeof client->why, format, arguments);
    va_end(arguments);
    return status;
}

brace_client_status_t brace_client_fail_version(brace_client_t *client, uint32_t node, uint32_t hash)
{
    return brace_client_fail(
        client, BRACE_CLIENT_E_VERSION,
        "%s: controller %u speaks dictionary 0x%08x, this library 0x%08x; build the client from the "
        "firmware's version, or flash the controller with this one's ('brace flash')",
        client->url, (unsigned)node, (unsigned)hash, (unsigned)BRACE_DICTIONARY_HASH);
}

uint64_t brace_client_deadline_after(int timeout_ms)
{
    return brace_bus_now_us() + (uint64_t)(timeout_ms < 1 ? 1 : timeout_ms) * 1000u;
}

brace_client_status_t brace_client_open(const char *url, uint32_t node, uint32_t bit_rate, int timeout_ms,
                                        brace_client_t **client, char *why, unsigned why_room)
{
    if (client == NULL) {
        return BRACE_CLIENT_E_USAGE;
    }
    *client = NULL;
    if (url == NULL || url[0] == '\0' || strlen(url) >= sizeof(*client)->url || node > 127u || timeout_ms < 100 ||
        timeout_ms > 60000) {
        brace_bus_say(why, why_room, "needs a bus URL (can0, slcan:/dev/ttyACM0, tcp://host:port, modbus:/dev/ttyUSB0, "
                                     "modbus-tcp://host:port), a node of 0 to 127, a time-out of 100 to 60000 ms");
        return BRACE_CLIENT_E_USAGE;
    }
    brace_client_t *opened = calloc(1, sizeof *opened);
    if (opened == NULL) {
        brace_bus_say(why, why_room, "out of memory");
        return BRACE_CLIENT_E_NO_DEVICE;
    }
    strcpy(opened->url, url);
    const uint64_t deadline_us = brace_client_deadline_after(timeout_ms);
    const brace_client_status_t status = brace_modbus_is_url(url)
                                             ? brace_modbus_open(opened, deadline_us)
                                             : brace_can_open(opened, node, bit_rate, deadline_us);
    if (status != BRACE_CLIENT_OK) {
        brace_bus_say(why, why_room, "%s", opened->why);
        brace_client_close(opened);
        return status;
    }
    *client = opened;
    return BRACE_CLIENT_OK;
}

void brace_client_close(brace_client_t *client)
{
    if (client != NULL) {
        brace_bus_close(client->bus);
        brace_modbus_close(client);
        free(client);
    }
}

void brace_client_identity(const brace_client_t *client, brace_client_identity_t *identity)
{
    *identity = client->identity;
}

const char *brace_client_why(const brace_client_t *client)
{
    return client == NULL ? "no client" : client->why;
}

int32_t brace_client_refusal(const brace_client_t *client)
{
    return client->refusal;
}

int brace_client_exit_code(brace_client_status_t status)
{
    switch (status) {
    case BRACE_CLIENT_OK: return 0;
    case BRACE_CLIENT_E_USAGE:
    case BRACE_CLIENT_E_UNSUPPORTED: return 2;
    case BRACE_CLIENT_E_VERSION: return 6;
    case BRACE_CLIENT_E_REFUSED: return 5;
    default: return 4;
    }
}

brace_client_status_t brace_client_read(brace_client_t *client, uint32_t wanted, int timeout_ms,
                                        brace_client_snapshot_t *snapshot)
{
    if (wanted == 0u || wanted > PARTS_MOST) {
        return brace_client_fail(client, BRACE_CLIENT_E_USAGE,
                                 "parts 0x%x: want BRACE_PART_K or more of BRACE_PART_ALL, _SPACE, _LOAD, _LOAD_ACROSS",
                                 (unsigned)wanted);
    }
    return client->bus != NULL ? brace_can_read(client, wanted, brace_client_deadline_after(timeout_ms), snapshot)
                               : brace_modbus_read(client, wanted, brace_client_deadline_after(timeout_ms), snapshot);
}

static brace_client_status_t out_of_range(brace_client_t *client)
{
    return brace_client_fail(client, BRACE_CLIENT_E_USAGE, "a value lies outside its range; client.h states them");
}

/* Asks a question that only CAN's frames carry; refuses it over Modbus. limited: how many values did not fit. */
static brace_client_status_t ask(brace_client_t *client, brace_question_t *question, uint32_t code, uint32_t limited,
                                 int timeout_ms)
{
    if (limited != 0u) {
        return out_of_range(client);
    }
    if (client->bus == NULL) {
        return brace_client_fail(client, BRACE_CLIENT_E_UNSUPPORTED,
                                 "%s: not over Modbus; connect over CAN, or ask for K in the limb's plane at a posture",
                                 client->url);
    }
    question->code = code;
    return brace_can_ask(client, question, brace_client_deadline_after(timeout_ms));
}

static bool is_number(float value)
{
    return value - value == 0.0f; /* neither NaN, which would be sent as 'not known', nor infinite */
}

/* Asks a question of two numbers. */
static brace_client_status_t ask_two(brace_client_t *client, brace_question_t *question, uint32_t code,
                                     uint32_t limited, float a, float b, int timeout_ms)
{
    return ask(client, question, code, limited + !is_number(a) + !is_number(b), timeout_ms);
}

static void take_k(const brace_question_t *question, brace_client_k_t *k)
{
    brace_can_k_at_posture_answer_0_t first;
    brace_can_k_at_posture_answer_1_t second;
    brace_can_k_at_posture_answer_2_t third;
    brace_can_unpack_k_at_posture_answer_0(question->answers[0], &first);
    brace_can_unpack_k_at_posture_answer_1(question->answers[1], &second);
    brace_can_unpack_k_at_posture_answer_2(question->answers[2], &third);
    *k = (brace_client_k_t){.k_xx_n_per_mm = first.k_xx_n_per_mm,
                            .k_xz_n_per_mm = first.k_xz_n_per_mm,
                            .k_zz_n_per_mm = second.k_zz_n_per_mm,
                            .lambda_min_n_per_mm = second.lambda_min_n_per_mm,
                            .lambda_max_n_per_mm = third.lambda_max_n_per_mm,
                            .stiff_axis_rad = third.stiff_axis_rad,
                            .flags = third.flags};
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
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
    const uint32_t limited = brace_can_pack_k_at_posture_request(&request, question.data) + !is_number(theta1_rad) +
                             !is_number(theta2_rad);
    if (client->bus == NULL && limited == 0u) {
        const uint32_t values[] = {bits_of(theta1_rad), bits_of(theta2_rad)};
        return ask_modbus_for_k(client, BRACE_CLIENT_COMMAND_PLACE(asked_theta1_rad), values, 2u, timeout_ms, k);
    }
    const brace_client_status_t status = ask(client, &question, BRACE_REQUEST_K_AT_POSTURE, limited, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        take_k(&question, k);
    }
    return status;
}

brace_client_status_t brace_client_drift(brace_client_t *client, int timeout_ms, brace_client_drift_t *drift)
{
    const brace_can_drift_request_t request = {0};
    brace_question_t question;
    if (client->bus == NULL) {
        return brace_modbus_drift(client, brace_client_deadline_after(timeout_ms), drift);
    }
    const uint32_t limited = brace_can_pack_drift_request(&request, question.data);
    const brace_client_status_t status = ask(client, &question, BRACE_REQUEST_DRIFT, limited, timeout_ms);
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
        *outcome = value < 128u ? (int32_t)value : (int32_t)value - 256; /* a negative outcome is sent as 256 plus it */
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
    const brace_client_status_t status = ask(client, &question, code, limited, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        take_k(&question, k); /* the three answers have the same layout */
    }
    return status;
}

/* ------------------------------------------------------------------------------------------ under a load -- */

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
    brace_question_t told = {.code = BRACE_REQUEST_TIP_FORCE};
    if (limited + brace_can_pack_tip_force_request(&force, told.data) + !is_number(fx_n) + !is_number(fz_n) != 0u) {
        return out_of_range(client);
    }
    if (client->bus != NULL) {
        const brace_client_status_t status =
            brace_can_ask_under_force(client, &told, question, brace_client_deadline_after(timeout_ms));
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
    return ask_under_force(client, &question, limited, BRACE_CLIENT_COMMAND_PLACE(asked_posture_force_x_n), values,
                           4u, fx_n, fz_n, timeout_ms, k);
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
    return ask_under_force(client, &question, limited, BRACE_CLIENT_COMMAND_PLACE(asked_tip_force_x_n), values,
                           5u, fx_n, fz_n, timeout_ms, k);
}

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
    const brace_client_status_t status = brace_client_entry_f32(client, BRACE_CLIENT_ENTRY(theta0_rad),
                                                                brace_bus_left_ms(deadline_us), &theta0_rad);
    if (status != BRACE_CLIENT_OK) {
        return status;
    }
    client->refusal = is_number(theta0_rad) ? BRACE_E_SINGULAR : BRACE_E_UNSUPPORTED;
    return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: unit %u has no K there: %s", client->url,
                             (unsigned)client->unit,
                             is_number(theta0_rad) ? BRACE_CLIENT_FOLDS : BRACE_CLIENT_NO_COXA);
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
    const brace_can_tip_force_in_space_request_t force = {
        .fx_n = force_n[0], .fy_n = force_n[1], .fz_n = force_n[2]};
    brace_question_t told = {.code = BRACE_REQUEST_TIP_FORCE_IN_SPACE};
    brace_question_t question = {.code = BRACE_REQUEST_K_IN_SPACE_AT_POSTURE};
    uint32_t limited = brace_can_pack_k_in_space_at_posture_request(&request, question.data) +
                       brace_can_pack_tip_force_in_space_request(&force, told.data);
    for (int i = 0; i < 3; i++) {
        limited += (uint32_t)!is_number(theta_rad[i]) + (uint32_t)!is_number(force_n[i]);
    }
    if (limited != 0u) {
        return out_of_range(client);
    }
    if (client->bus == NULL) {
        return ask_modbus_for_space_k(client, theta_rad, force_n, deadline_us, k);
    }
    const brace_client_status_t status = brace_can_ask_under_force(client, &told, &question, deadline_us);
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
        const brace_client_status_t status = brace_client_entry_f32(
            client, entries[i].index, brace_bus_left_ms(deadline_us), entries[i].value);
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
        return out_of_range(client);
    }
    return brace_client_command(client, &command, brace_client_deadline_after(timeout_ms));
}

/* --------------------------------------------------------------------------------- at the contact, as of now -- */

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
        *force = (brace_client_force_t){.fx_n = first.fx_n, .fz_n = first.fz_n, .low_n = second.low_n,
                                        .high_n = second.high_n};
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

brace_client_status_t brace_client_entry_u32(brace_client_t *client, uint32_t index, int timeout_ms, uint32_t *value)
{
    const brace_can_read_entry_request_t request = {.index = index};
    brace_question_t question;
    const uint32_t limited = brace_can_pack_read_entry_request(&request, question.data);
    if (client->bus == NULL && limited == 0u) {
        return brace_modbus_entry(client, index, brace_client_deadline_after(timeout_ms), value);
    }
    const brace_client_status_t status = ask(client, &question, BRACE_REQUEST_READ_ENTRY, limited, timeout_ms);
    if (status == BRACE_CLIENT_OK) {
        brace_can_read_entry_answer_0_t answer;
        brace_can_unpack_read_entry_answer_0(question.answers[0], &answer);
        if (answer.index != index) {
            return brace_client_fail(client, BRACE_CLIENT_E_REFUSED, "%s: asked for entry %u, answered entry %u",
                                     client->url, (unsigned)index, (unsigned)answer.index);
        }
        *value = answer.value;
    }
    return status;
}

brace_client_status_t brace_client_entry_f32(brace_client_t *client, uint32_t index, int timeout_ms, float *value)
{
    uint32_t bits;
    const brace_client_status_t status = brace_client_entry_u32(client, index, timeout_ms, &bits);
    if (status == BRACE_CLIENT_OK) {
        memcpy(value, &bits, sizeof bits);
    }
    return status;
}
