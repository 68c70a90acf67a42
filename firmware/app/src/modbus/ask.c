#include <string.h>

#include "measure/hypothetical.h"
#include "measure/questions.h"
#include "modbus/bytes.h"
#include "modbus/command.h"

enum { QUESTION_MOST = 3 };

static void k_is_unknown(brace_answered_t *answered)
{
    answered->asked_k_xx_n_per_mm = answered->asked_k_xz_n_per_mm = answered->asked_k_zz_n_per_mm = __builtin_nanf("");
    answered->asked_lambda_min_n_per_mm = answered->asked_lambda_max_n_per_mm = __builtin_nanf("");
    answered->asked_stiff_axis_rad = __builtin_nanf("");
    answered->asked_flags = UINT32_MAX;
}

static void force_is_unknown(brace_answered_t *answered)
{
    answered->asked_force_x_n = answered->asked_force_z_n = __builtin_nanf("");
    answered->asked_force_low_n = answered->asked_force_high_n = __builtin_nanf("");
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

/* Of the first so many: those that ask for K, or all. */
static void ask_nothing(brace_app_t *app, uint32_t count)
{
    const float nan = __builtin_nanf("");
    for (uint32_t i = 0; i < count; i++) { /* at most BRACE_APP_ASKED */
        memcpy(&app->modbus.asked[i], &nan, 4);
    }
    app->modbus.asked[COMMAND_ASKED_KNEE - COMMAND_ASKED_THETA1] = UINT32_MAX;
}

void command_ask_nothing(brace_app_t *app)
{
    ask_nothing(app, BRACE_APP_ASKED);
    k_is_unknown(&app->modbus.answered);
    force_is_unknown(&app->modbus.answered);
    sag_is_unknown(&app->modbus.answered);
    grip_is_unknown(&app->modbus.answered);
}

static void take_k(brace_answered_t *answered, brace_status_t status, const brace_stiffness_t *k)
{
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
}

static modbus_exception_t k_refusal(brace_status_t status)
{
    switch (status) {
    case BRACE_E_MODE: return MODBUS_E_BUSY; /* the model is being made anew */
    case BRACE_E_NOT_FINITE:
    case BRACE_E_RANGE:
    case BRACE_E_PARAMETER:
    case BRACE_E_UNREACHABLE: return MODBUS_E_VALUE;
    default: return MODBUS_FINE; /* there is no K there, and that is the answer */
    }
}

static modbus_exception_t refusal_of(brace_status_t status)
{
    return status == BRACE_OK ? MODBUS_FINE : status == BRACE_E_MODE ? MODBUS_E_DEVICE : MODBUS_E_VALUE;
}

static float real(uint32_t word)
{
    float value;
    memcpy(&value, &word, 4);
    return value;
}

static modbus_exception_t ask_posture(brace_app_t *app, const uint32_t asked[])
{
    brace_stiffness_t k;
    const brace_status_t status = hypothetical_stiffness(app, real(asked[0]), real(asked[1]), &k);
    const modbus_exception_t why = k_refusal(status);
    if (why == MODBUS_FINE) {
        take_k(&app->modbus.answered, status, &k);
    }
    return why;
}

static modbus_exception_t ask_tip(brace_app_t *app, const uint32_t asked[])
{
    brace_stiffness_t k;
    if (asked[2] > 1u) {
        return MODBUS_E_VALUE;
    }
    const brace_status_t status = question_k_at_tip(app, (brace_point_t){real(asked[0]), real(asked[1])},
                                                    asked[2] == 0u ? BRACE_KNEE_UP : BRACE_KNEE_DOWN, &k);
    const modbus_exception_t why = k_refusal(status);
    if (why == MODBUS_FINE) {
        take_k(&app->modbus.answered, status, &k);
    }
    return why;
}

static modbus_exception_t ask_force(brace_app_t *app, const uint32_t asked[])
{
    brace_answered_t *answered = &app->modbus.answered;
    brace_contact_force_t contact;
    const brace_status_t status =
        question_contact_force(app, (brace_displacement_t){real(asked[0]), real(asked[1])}, &contact);
    force_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_force_x_n = contact.force.x_n;
        answered->asked_force_z_n = contact.force.z_n;
        answered->asked_force_low_n = contact.low_n;
        answered->asked_force_high_n = contact.high_n;
    }
    return refusal_of(status);
}

static modbus_exception_t ask_sag(brace_app_t *app, const uint32_t asked[])
{
    brace_answered_t *answered = &app->modbus.answered;
    brace_displacement_t sag;
    const brace_status_t status = question_sag(app, (brace_force_t){real(asked[0]), real(asked[1])}, &sag);
    sag_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_sag_x_mm = sag.x_mm;
        answered->asked_sag_z_mm = sag.z_mm;
    }
    return refusal_of(status);
}

static modbus_exception_t ask_grip(brace_app_t *app, const uint32_t asked[])
{
    const brace_snapshot_t *now = brace_app_snapshot(app);
    brace_answered_t *answered = &app->modbus.answered;
    brace_contact_grip_t grip;
    const bool known = now->force_x_n == now->force_x_n && now->force_z_n == now->force_z_n;
    const brace_status_t status = known ? question_grip(app, real(asked[0]), real(asked[1]), &grip) : BRACE_E_MODE;
    grip_is_unknown(answered);
    if (status == BRACE_OK) {
        answered->asked_margin_n = grip.margin_n;
        answered->asked_angle_left_rad = grip.angle_left_rad;
        answered->asked_contact = grip.state;
    }
    return refusal_of(status);
}

/* How many registers of 32 bits the question that begins at a register has; 0: none begins there. */
static uint32_t length_of(uint32_t first)
{
    switch (first) {
    case COMMAND_ASKED_TIP_X: return 3;
    case COMMAND_ASKED_THETA1:
    case COMMAND_ASKED_DX:
    case COMMAND_ASKED_LOAD_X:
    case COMMAND_ASKED_NORMAL: return 2;
    default: return 0;
    }
}

static modbus_exception_t ask(brace_app_t *app, uint32_t first, const uint32_t asked[])
{
    switch (first) {
    case COMMAND_ASKED_THETA1: return ask_posture(app, asked);
    case COMMAND_ASKED_TIP_X: return ask_tip(app, asked);
    case COMMAND_ASKED_DX: return ask_force(app, asked);
    case COMMAND_ASKED_LOAD_X: return ask_sag(app, asked);
    case COMMAND_ASKED_NORMAL: return ask_grip(app, asked);
    default: return MODBUS_E_VALUE;
    }
}

modbus_exception_t command_ask(brace_app_t *app, uint32_t index, uint32_t count, const uint8_t *data)
{
    uint32_t asked[QUESTION_MOST];
    if (count == 0u || count != length_of(index)) {
        return MODBUS_E_VALUE;
    }
    for (uint32_t i = 0; i < count; i++) { /* at most QUESTION_MOST */
        asked[i] = get_32(data + 4u * i);
    }
    const modbus_exception_t why = ask(app, index, asked);
    if (why == MODBUS_FINE) {
        /* K at a posture and at a tip are answered in the same place: one question stands */
        if (index <= COMMAND_ASKED_KNEE) {
            ask_nothing(app, COMMAND_ASKED_KNEE - COMMAND_ASKED_THETA1 + 1u);
        }
        memcpy(&app->modbus.asked[index - COMMAND_ASKED_THETA1], asked, 4u * count);
    }
    return why;
}
