#include "wire/can/requests.h"

#include <stddef.h>

/* An answer that finds no room is counted: its request was answered, but nobody hears. */
static void tell(can_answers_t *answers, const wire_tick_t *tick, uint32_t code, uint32_t token, int32_t status,
                 const brace_answer_t *answer, uint32_t detail)
{
    if (!can_answers_have_room(answers, status == BRACE_OK ? brace_can_answer_parts[code] : 1u)) {
        brace_count(&tick->counters->requests_lost);
        return;
    }
    uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
    if (status == BRACE_OK) {
        brace_can_pack_answer(code, answer, token, parts);
        can_answers_add(answers, parts, brace_can_answer_parts[code]);
    } else {
        can_answers_refuse(answers, code, token, status, detail);
    }
}

/* The seals that have come for the command with this token, each with the next one. Who repeats the owner's token sends
 * seals that do not fit; they take the owner's own away from nobody. null: none has come */
static const brace_seal_t *seals_for(can_requests_t *requests, uint32_t token)
{
    brace_seal_t *first = NULL;
    for (uint32_t i = 0; i < requests->seal_count; i++) { /* at most BRACE_SEALS_MOST */
        brace_seal_t *seal = &requests->seal[i];
        if (seal->counter == token) {
            seal->next = first;
            first = seal;
        }
    }
    return first;
}

/* Another seal has come: the oldest one gives its place. */
static void keep_seal(can_requests_t *requests, const brace_seal_t *seal)
{
    requests->seal[requests->oldest_seal] = *seal;
    requests->seal_count = (uint8_t)(requests->seal_count + (requests->seal_count < (uint32_t)BRACE_SEALS_MOST));
    requests->oldest_seal = (uint8_t)((requests->oldest_seal + 1u) % (uint32_t)BRACE_SEALS_MOST);
}

bool can_requests_answer(can_requests_t *requests, const wire_tick_t *tick, brace_asker_t asker, uint32_t node_id,
                         const uint8_t *data)
{
    const uint32_t master = can_master_of(data[1]);
    brace_seal_t new_seal = {.is_there = false};
    request_t request = {.app = tick->app,
                         .measured = tick->measured,
                         .asker = asker,
                         .asked_force = &requests->asked_force[master],
                         .upload = &requests->upload,
                         .download = &requests->download[master],
                         .who = {asker, master},
                         .seal = seals_for(requests, data[1]),
                         .brings = &new_seal,
                         .token = data[1],
                         .bytes = data,
                         .count = CAN_REQUEST_BYTES,
                         .node_id = node_id,
                         .detail = 0,
                         .is_of_now = false};
    const uint8_t code = data[0], token = data[1];
    brace_request_t asked;
    brace_answer_t answer;
    brace_can_unpack_request(data, &asked);
    const int32_t status = answer_request(&request, code, &asked, &answer);
    if (new_seal.is_there) {
        keep_seal(requests, &new_seal);
    }
    if (status == ANSWER_AGAIN) {
        requests->waits = true;
    } else if (status == ANSWER_LATER) {
        requests->storing = code;
        requests->storing_token = token;
    } else {
        tell(&requests->answers, tick, code, token, status, &answer, request.detail);
    }
    return status != BRACE_REFUSED_UNKNOWN;
}

void can_requests_tick(can_requests_t *requests, const wire_tick_t *tick)
{
    upload_tick(&requests->upload, tick->app);
    if (requests->storing != 0u && !brace_app_is_storing(tick->app)) {
        request_t request = {.app = tick->app};
        brace_answer_t answer; /* a commit and a roll-back have the same */
        const int32_t status = answer_of_storing(&request, &answer.commit);
        tell(&requests->answers, tick, requests->storing, requests->storing_token, status, &answer, request.detail);
        requests->storing = 0;
    }
}
