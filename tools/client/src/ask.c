/* Questions in general, and the dictionary's entries by their numbers. */
#include "ask.h"
#include "client_can.h"
#include "client_modbus.h"

#include "brace/can_messages.h"

brace_client_status_t brace_client_ask(brace_client_t *client, brace_question_t *question, uint32_t code,
                                       uint32_t limited, int timeout_ms)
{
    if (limited != 0u) {
        return brace_client_out_of_range(client);
    }
    if (client->bus == NULL) {
        return brace_client_fail(client, BRACE_CLIENT_E_UNSUPPORTED,
                                 "%s: not over Modbus; connect over CAN, or ask for K in the limb's plane at a posture",
                                 client->url);
    }
    question->code = code;
    return brace_can_ask(client, question, brace_client_deadline_after(timeout_ms));
}

brace_client_status_t brace_client_entry_u32(brace_client_t *client, uint32_t index, int timeout_ms, uint32_t *value)
{
    const brace_can_read_entry_request_t request = {.index = index};
    brace_question_t question;
    const uint32_t limited = brace_can_pack_read_entry_request(&request, question.data);
    if (client->bus == NULL && limited == 0u) {
        return brace_modbus_entry(client, index, brace_client_deadline_after(timeout_ms), value);
    }
    const brace_client_status_t status =
        brace_client_ask(client, &question, BRACE_REQUEST_READ_ENTRY, limited, timeout_ms);
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
