#include "wire/modbus/ask.h"

#include <string.h>

#include "wire/modbus/command.h"
#include "wire/modbus/refusal.h"

static void k_is_unknown(brace_answered_t *answered)
{
    const float unknown = __builtin_nanf("");
    answered->asked_k_xx_n_per_mm = answered->asked_k_xz_n_per_mm = answered->asked_k_zz_n_per_mm = unknown;
    answered->asked_lambda_min_n_per_mm = answered->asked_lambda_max_n_per_mm = unknown;
    answered->asked_stiff_axis_rad = unknown;
    answered->asked_flags = UINT32_MAX;
}

static void force_is_unknown(brace_answered_t *answered)
{
    const float unknown = __builtin_nanf("");
    answered->asked_force_x_n = answered->asked_force_z_n = unknown;
    answered->asked_force_low_n = answered->asked_force_high_n = unknown;
}

static void sag_is_unknown(brace_answered_t *answered)
{
    answered->asked_sag_x_mm = answered->asked_sag_z_mm = __builtin_nanf("");
}

static void grip_is_unknown(brace_answered_t *answered)
{
    answered->asked_margin_n = answered->asked_angle_left_rad = __builtin_nanf("");
    answered->asked_contact = UINT32_MAX;
}

static void k_was_not_asked(brace_commands_t *written)
{
    const float unknown = __builtin_nanf("");
    written->asked_theta1_rad = written->asked_theta2_rad = unknown;
    written->asked_tip_x_mm = written->asked_tip_z_mm = unknown;
    written->asked_knee = UINT32_MAX;
}

void modbus_ask_nothing(modbus_server_t *server)
{
    brace_commands_t *written = &server->written;
    const float unknown = __builtin_nanf("");
    k_was_not_asked(written);
    written->asked_dx_mm = written->asked_dz_mm = unknown;
    written->asked_load_x_n = written->asked_load_z_n = unknown;
    written->asked_normal_rad = written->asked_friction = unknown;
    k_is_unknown(&server->answered);
    force_is_unknown(&server->answered);
    sag_is_unknown(&server->answered);
    grip_is_unknown(&server->answered);
}

/* K at a posture and K at a tip are answered in the same registers, so only the last of these questions stands. A limb
 * that has no K there is an answer too: NaN. */
static modbus_exception_t answer_k(modbus_server_t *server, brace_status_t status, const brace_stiffness_t *k)
{
    brace_answered_t *answered = &server->answered;
    if (modbus_refusal_of(status) == MODBUS_E_VALUE) {
        return MODBUS_E_VALUE;
    }
    k_was_not_asked(&server->written);
    k_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_k_xx_n_per_mm = k->k_xx_n_per_mm;
        answered->asked_k_xz_n_per_mm = k->k_xz_n_per_mm;
        answered->asked_k_zz_n_per_mm = k->k_zz_n_per_mm;
        answered->asked_lambda_min_n_per_mm = k->lambda_min_n_per_mm;
        answered->asked_lambda_max_n_per_mm = k->lambda_max_n_per_mm;
        answered->asked_stiff_axis_rad = k->stiff_axis_rad;
        answered->asked_flags = k->flags;
    }
    return MODBUS_FINE;
}

static modbus_exception_t ask_posture(modbus_server_t *server, brace_app_t *app, const brace_commands_t *asked)
{
    brace_stiffness_t k;
    const brace_status_t status =
        brace_app_k_at_posture(app, asked->asked_theta1_rad, asked->asked_theta2_rad, &k);
    return answer_k(server, status, &k);
}

static modbus_exception_t ask_tip(modbus_server_t *server, brace_app_t *app, const brace_commands_t *asked)
{
    brace_stiffness_t k;
    if (asked->asked_knee > 1u) {
        return MODBUS_E_VALUE;
    }
    const brace_point_t tip = {asked->asked_tip_x_mm, asked->asked_tip_z_mm};
    const brace_status_t status =
        brace_app_k_at_tip(app, tip, asked->asked_knee == 0u ? BRACE_KNEE_UP : BRACE_KNEE_DOWN, &k);
    return answer_k(server, status, &k);
}

/* These questions are about K and force of now. Where there is none the mode is not to blame for the master: it could
 * not be done. */
static modbus_exception_t refusal_of_now(brace_status_t status)
{
    return status == BRACE_E_MODE ? MODBUS_E_DEVICE : modbus_refusal_of(status);
}

static modbus_exception_t ask_force(modbus_server_t *server, brace_app_t *app, const brace_commands_t *asked)
{
    brace_answered_t *answered = &server->answered;
    brace_contact_force_t contact;
    const brace_displacement_t displacement = {asked->asked_dx_mm, asked->asked_dz_mm};
    const brace_status_t status = brace_app_contact_force(app, displacement, &contact);
    force_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_force_x_n = contact.force.x_n;
        answered->asked_force_z_n = contact.force.z_n;
        answered->asked_force_low_n = contact.low_n;
        answered->asked_force_high_n = contact.high_n;
    }
    return refusal_of_now(status);
}

static modbus_exception_t ask_sag(modbus_server_t *server, brace_app_t *app, const brace_commands_t *asked)
{
    brace_answered_t *answered = &server->answered;
    brace_displacement_t sag;
    const brace_status_t status =
        brace_app_sag(app, (brace_force_t){asked->asked_load_x_n, asked->asked_load_z_n}, &sag);
    sag_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_sag_x_mm = sag.x_mm;
        answered->asked_sag_z_mm = sag.z_mm;
    }
    return refusal_of_now(status);
}

static modbus_exception_t ask_grip(modbus_server_t *server, brace_app_t *app, const brace_commands_t *asked)
{
    const brace_snapshot_t *now = brace_app_snapshot(app);
    brace_answered_t *answered = &server->answered;
    brace_contact_grip_t grip;
    const bool force_is_known = now->force_x_n == now->force_x_n && now->force_z_n == now->force_z_n;
    const brace_status_t status =
        force_is_known ? brace_app_grip(app, asked->asked_normal_rad, asked->asked_friction, &grip) : BRACE_E_MODE;
    grip_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_margin_n = grip.margin_n;
        answered->asked_angle_left_rad = grip.angle_left_rad;
        answered->asked_contact = grip.state;
    }
    return refusal_of_now(status);
}

/* How many values the question has that begins at this command; 0: none begins there. */
static uint32_t question_values(uint32_t first)
{
    switch (first) {
    case MODBUS_COMMAND(asked_tip_x_mm): return 3;
    case MODBUS_COMMAND(asked_theta1_rad):
    case MODBUS_COMMAND(asked_dx_mm):
    case MODBUS_COMMAND(asked_load_x_n):
    case MODBUS_COMMAND(asked_normal_rad): return 2;
    default: return 0;
    }
}

static modbus_exception_t answer(modbus_server_t *server, brace_app_t *app, uint32_t first,
                                 const brace_commands_t *asked)
{
    switch (first) {
    case MODBUS_COMMAND(asked_theta1_rad): return ask_posture(server, app, asked);
    case MODBUS_COMMAND(asked_tip_x_mm): return ask_tip(server, app, asked);
    case MODBUS_COMMAND(asked_dx_mm): return ask_force(server, app, asked);
    case MODBUS_COMMAND(asked_load_x_n): return ask_sag(server, app, asked);
    case MODBUS_COMMAND(asked_normal_rad): return ask_grip(server, app, asked);
    default: return MODBUS_E_VALUE;
    }
}

modbus_exception_t modbus_ask(modbus_server_t *server, brace_app_t *app, uint32_t first, uint32_t count,
                              const uint32_t *words)
{
    brace_commands_t asked = server->written;
    if (count == 0u || count != question_values(first)) {
        return MODBUS_E_VALUE;
    }
    memcpy((uint8_t *)&asked + 4u * first, words, 4u * count);
    const modbus_exception_t why = answer(server, app, first, &asked);
    if (why == MODBUS_FINE) {
        memcpy((uint8_t *)&server->written + 4u * first, words, 4u * count);
    }
    return why;
}
