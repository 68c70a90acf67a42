#include "wire/can/requests.h"

#include <string.h>

enum { CAN_REQUEST_BYTES = 8, MASTER_SHIFT = 4 };

static void tell(can_answers_t *answers, uint32_t code, uint32_t token, int32_t status, const brace_answer_t *answer,
                 uint32_t detail)
{
    uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
    if (status == BRACE_OK) {
        brace_can_pack_answer(code, answer, token, parts);
        can_answers_add(answers, parts, brace_can_answer_parts[code]);
    } else {
        can_answers_refuse(answers, code, token, status, detail);
    }
}

bool can_requests_answer(can_requests_t *requests, const wire_tick_t *tick, brace_asker_t asker, uint32_t node_id,
                         const uint8_t *data)
{
    request_t request = {.app = tick->app,
                         .measured = tick->measured,
                         .asker = asker,
                         .asked_force = &requests->asked_force,
                         .transfer = &requests->transfer,
                         .who = {asker, data[1] >> MASTER_SHIFT},
                         .seal = &requests->seal,
                         .token = data[1],
                         .bytes = data,
                         .count = CAN_REQUEST_BYTES,
                         .node_id = node_id,
                         .detail = 0,
                         .is_of_now = false};
    const uint8_t code = data[0], token = data[1];
    requests->seal.is_there = requests->seal.is_there && requests->seal.counter == token;
    brace_request_t asked;
    brace_answer_t answer;
    brace_can_unpack_request(data, &asked);
    const int32_t status = answer_request(&request, code, &asked, &answer);
    requests->waits = false;
    if (status == ANSWER_AGAIN) {
        memmove(requests->waiting, data, sizeof requests->waiting);
        requests->waits = true;
    } else if (status == ANSWER_LATER) {
        requests->storing = code;
        requests->storing_token = token;
    } else {
        tell(&requests->answers, code, token, status, &answer, request.detail);
    }
    return status != BRACE_REFUSED_UNKNOWN;
}

void can_requests_tick(can_requests_t *requests, const wire_tick_t *tick)
{
    transfer_tick(&requests->transfer, tick->app);
    if (requests->storing != 0u && !brace_app_is_storing(tick->app)) {
        request_t request = {.app = tick->app};
        brace_answer_t answer; /* a commit and a roll-back have the same */
        const int32_t status = answer_of_storing(&request, &answer.commit);
        tell(&requests->answers, requests->storing, requests->storing_token, status, &answer, request.detail);
        requests->storing = 0;
    }
}
