/* One request on its way to its answer.
 *
 * For each request of the dictionary there is a hand-written function can_answer_<name>. It does what the request asks
 * for and fills the whole answer; requests.c unpacks the request and sends the answer's frames.
 *   asked: the request's fields
 *   answer (out): the fields of all the answer's parts; untouched unless BRACE_OK is returned
 * returns BRACE_OK; CAN_ANSWER_LATER: transfer_tick answers when what was begun has ended; or why not, as
 * brace/refusals.h has it: then nothing has changed. */
#ifndef BRACE_WIRE_CAN_REQUEST_H
#define BRACE_WIRE_CAN_REQUEST_H

#include <stdint.h>

#include "brace/can_answering.h"
#include "brace/can_requests.h"
#include "brace/refusals.h"
#include "wire/can/answers.h"
#include "wire/can/session.h"
#include "wire/wire.h"

enum { CAN_ANSWER_LATER = 1 };

typedef struct {
    const uint8_t *data;    /* its eight bytes */
    uint32_t code, token;   /* the first two of them */
    uint32_t detail;        /* (out) what a refusal has to add; 0: nothing */
    uint32_t node_id;       /* of this node */
    const wire_tick_t *tick;
    can_session_t *session; /* of the port that it came through, as these: */
    can_answers_t *answers;
} can_request_t;

#define CAN_ANSWER_FUNCTION(CODE, name) \
    int32_t can_answer_##name(can_request_t *request, const brace_can_##name##_request_t *asked, \
                              brace_can_##name##_answer_t *answer);
BRACE_CAN_REQUESTS(CAN_ANSWER_FUNCTION)
#undef CAN_ANSWER_FUNCTION

#endif
