/* Entries of the dictionary one by one, and the mode in which parameters may be written. */
#include "wire/can/request.h"
#include "wire/measured.h"

#define KEY 0xc0deu /* of set_mode, so that no disturbed frame stops K */

int32_t can_answer_read_entry(can_request_t *request, const brace_can_read_entry_request_t *asked,
                              brace_can_read_entry_answer_t *answer)
{
    uint32_t value = 0;
    request->detail = asked->index;
    const brace_status_t status =
        asked->index < BRACE_ENTRY_MEASURED
            ? parameter_entry(request_parameters(request->tick->controller), asked->index, &value)
            : measured_entry(request->tick->measured, asked->index, &value);
    if (status == BRACE_OK) {
        *answer = (brace_can_read_entry_answer_t){asked->index, value};
    }
    return status;
}

int32_t can_answer_write_entry(can_request_t *request, const brace_can_write_entry_request_t *asked,
                               brace_can_write_entry_answer_t *answer)
{
    controller_t *controller = request->tick->controller;
    request->detail = asked->index;
    if (asked->index - BRACE_ENTRY_MEASURED < BRACE_MEASURED_COUNT) {
        return BRACE_REFUSED_READ_ONLY;
    }
    const brace_status_t status = request_stage(controller, asked->index, asked->value);
    if (status != BRACE_OK) {
        return status == BRACE_E_UNSUPPORTED ? (int32_t)BRACE_REFUSED_BUSY : (int32_t)status;
    }
    answer->index = asked->index;
    return parameter_entry(request_staged(controller), asked->index, &answer->value);
}

/* Goes to CONFIGURATION or back. */
static int32_t go_to(controller_t *controller, uint32_t wanted)
{
    const brace_mode_t mode = request_mode(controller);
    if (wanted == BRACE_MODE_CONFIGURATION && mode != BRACE_MODE_CONFIGURATION) {
        return request_configuration_enter(controller);
    }
    if (wanted == BRACE_MODE_MONITOR && mode == BRACE_MODE_CONFIGURATION) {
        return request_is_storing(controller) ? (int32_t)BRACE_REFUSED_BUSY
                                              : (int32_t)request_configuration_leave(controller);
    }
    if (wanted == (uint32_t)mode) {
        return BRACE_OK;
    }
    return wanted == BRACE_MODE_MONITOR ? BRACE_E_MODE : BRACE_E_RANGE;
}

int32_t can_answer_set_mode(can_request_t *request, const brace_can_set_mode_request_t *asked,
                            brace_can_set_mode_answer_t *answer)
{
    controller_t *controller = request->tick->controller;
    request->detail = request_mode(controller);
    if (asked->key != KEY) {
        return BRACE_REFUSED_KEY;
    }
    const int32_t status = go_to(controller, asked->mode);
    if (status == BRACE_OK) {
        request_configuration_keep(controller); /* so CONFIGURATION can be kept going by asking for it again */
        answer->mode = request_mode(controller);
    }
    return status;
}
