/* Answers on their way out through one port, frame by frame. */
#ifndef BRACE_WIRE_CAN_ANSWERS_H
#define BRACE_WIRE_CAN_ANSWERS_H

#include <stdbool.h>
#include <stdint.h>

enum { CAN_ANSWERS_ROOM = 32 }; /* frames: answers to two questions and a commit, and what a session is answered */

typedef struct {
    uint8_t frame[CAN_ANSWERS_ROOM][8];
    uint8_t first; /* the oldest [0, 31] */
    uint8_t count; /* [0, 32] */
} can_answers_t;

/* Is there room for so many frames more? */
bool can_answers_have_room(const can_answers_t *answers, uint32_t frames);

/* Adds the frames of an answer. Whoever takes a request makes sure of room for BRACE_CAN_ANSWER_PARTS_MOST before;
 * without room the newest frame is replaced. */
void can_answers_add(can_answers_t *answers, uint8_t (*parts)[8], uint32_t count);

/* Adds a refusal.
 *   detail: what the request's page of docs/protocol.md says */
void can_answers_refuse(can_answers_t *answers, uint32_t code, uint32_t token, int32_t status, uint32_t detail);

/* The eight bytes of the oldest frame; null: there is none. */
const uint8_t *can_answers_next(const can_answers_t *answers);

/* The oldest frame has left. */
void can_answers_sent(can_answers_t *answers);

#endif
