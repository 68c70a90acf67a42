/* Entries of the dictionary one by one, and the mode in which parameters may be written. */
#include <stddef.h>

#include "wire/answers/answer.h"
#include "wire/measured.h"

#define KEY 0xc0deu /* of set_mode, so that no disturbed frame stops K */

int32_t answer_read_entry(request_t *request, const brace_read_entry_request_t *asked,
                          brace_read_entry_answer_t *answer)
{
    uint32_t value = 0;
    request->detail = asked->index;
    const brace_status_t status = asked->index < BRACE_ENTRY_MEASURED
                                      ? parameter_entry(brace_app_parameters(request->app), asked->index, &value)
                                      : measured_entry(request->measured, asked->index, &value);
    if (status == BRACE_OK) {
        *answer = (brace_read_entry_answer_t){asked->index, value};
    }
    return status;
}

#define COMMAND(member) (BRACE_ENTRY_COMMANDS + offsetof(brace_commands_t, member) / 4u)
#define TOKEN_BITS 8u

/* Commands that are written as entries: to stop, to end a test, the seal of the request that comes next. */
static int32_t write_command(request_t *request, const brace_write_entry_request_t *asked,
                             brace_write_entry_answer_t *answer)
{
    const brace_seal_t seal = {
        .is_there = true, .counter = request->token, .counter_bits = TOKEN_BITS, .mac = asked->value};
    int32_t status = BRACE_OK;
    switch (asked->index) {
    case COMMAND(stop): status = brace_app_stop(request->app); break;
    case COMMAND(end_test): status = brace_app_loading_stop(request->app); break;
    case COMMAND(seal_mac):
        if (request->brings != NULL) {
            *request->brings = seal;
        }
        break;
    default: return BRACE_E_RANGE;
    }
    request->detail = brace_app_mode(request->app);
    if (status == BRACE_OK) {
        brace_session_report_t session;
        brace_app_session(request->app, &session);
        answer->index = asked->index;
        answer->value = asked->index == COMMAND(end_test) ? session.begin : (uint32_t)session.setting;
    }
    return status;
}

int32_t answer_write_entry(request_t *request, const brace_write_entry_request_t *asked,
                           brace_write_entry_answer_t *answer)
{
    brace_app_t *app = request->app;
    request->detail = asked->index;
    if (asked->index >= BRACE_ENTRY_COMMANDS) {
        return write_command(request, asked, answer);
    }
    if (asked->index - BRACE_ENTRY_MEASURED < BRACE_MEASURED_COUNT) {
        return BRACE_REFUSED_READ_ONLY;
    }
    const brace_status_t status = brace_app_parameters_stage(app, asked->index, 1, &asked->value);
    if (status != BRACE_OK) {
        return status == BRACE_E_UNSUPPORTED ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)status;
    }
    answer->index = asked->index;
    return parameter_entry(brace_app_parameters_staged(app), asked->index, &answer->value);
}

/* Goes to CONFIGURATION or back. */
static int32_t go_to(brace_app_t *app, uint32_t wanted)
{
    const brace_mode_t mode = brace_app_mode(app);
    if (wanted == BRACE_MODE_CONFIGURATION) {
        return brace_app_configuration_enter(app); /* or keeps it going */
    }
    if (wanted == BRACE_MODE_MONITOR && mode == BRACE_MODE_CONFIGURATION) {
        return brace_app_is_storing(app) ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)brace_app_configuration_leave(app);
    }
    if (wanted == (uint32_t)mode) {
        return BRACE_OK;
    }
    return wanted == BRACE_MODE_MONITOR ? BRACE_E_MODE : BRACE_E_RANGE;
}

int32_t answer_set_mode(request_t *request, const brace_set_mode_request_t *asked, brace_set_mode_answer_t *answer)
{
    brace_app_t *app = request->app;
    request->detail = brace_app_mode(app);
    if (asked->key != KEY) {
        return BRACE_REFUSED_KEY;
    }
    const int32_t status = go_to(app, asked->mode);
    if (status == BRACE_OK) {
        answer->mode = brace_app_mode(app);
        answer->setting = brace_app_setting(app);
    }
    return status;
}
