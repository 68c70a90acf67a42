/* Requests over CAN: each is answered or refused at once. Costs are instructions on a Cortex-M4F. */
#ifndef BRACE_WIRE_CAN_REQUESTS_H
#define BRACE_WIRE_CAN_REQUESTS_H

#include "wire/can/request.h"

/* Answers or refuses a request. There must be room for BRACE_CAN_ANSWER_PARTS_MOST frames.
 *   request: code and token are filled in here
 * returns whether the dictionary has such a request; if not, it is refused too
 * At most 150 instructions and what requests.h says of the request; 2,400 where a set is to be stored. */
bool can_requests_answer(can_request_t *request);

#endif
