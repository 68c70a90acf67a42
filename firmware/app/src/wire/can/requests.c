#include "wire/can/requests.h"

#include <stddef.h>

/* From a request's bytes to the frames of its answer, by the function that answers it. */
#define ANSWER(CODE, name) \
    static int32_t answer_##name(can_request_t *request, uint8_t (*parts)[8]) \
    { \
        brace_can_##name##_request_t asked; \
        brace_can_##name##_answer_t answer; \
        brace_can_unpack_##name##_request(request->data, &asked); \
        const int32_t status = can_answer_##name(request, &asked, &answer); \
        if (status == BRACE_OK) { \
            brace_can_pack_##name##_answer(&answer, request->token, parts); \
        } \
        return status; \
    }
BRACE_CAN_REQUESTS(ANSWER)
#undef ANSWER

/* Who answers a request; null: the dictionary has none of this code. */
typedef struct {
    int32_t (*answer)(can_request_t *request, uint8_t (*parts)[8]);
} request_entry_t;

#define ENTRY(CODE, name) [CODE] = {answer_##name},
static const request_entry_t entries[BRACE_ANSWER_PART] = {BRACE_CAN_REQUESTS(ENTRY)};
#undef ENTRY

/* The highest code that the dictionary has: a refusal of an unknown one tells it. */
static uint32_t highest_code(void)
{
    uint32_t highest = (uint32_t)BRACE_ANSWER_PART - 1u;
    while (highest > 0u && entries[highest].answer == NULL) {
        highest--;
    }
    return highest;
}

bool can_requests_answer(can_request_t *request)
{
    request->code = request->data[0];
    request->token = request->data[1];
    const bool is_known = request->code < (uint32_t)BRACE_ANSWER_PART && entries[request->code].answer != NULL;
    uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
    int32_t status = BRACE_REFUSED_UNKNOWN;
    if (is_known) {
        status = entries[request->code].answer(request, parts);
    } else {
        request->detail = highest_code();
    }
    if (status == BRACE_OK) {
        can_answers_add(request->answers, parts, brace_can_answer_parts[request->code]);
    } else if (status != CAN_ANSWER_LATER) {
        can_answers_refuse(request->answers, request->code, request->token, status, request->detail);
    }
    return is_known;
}
