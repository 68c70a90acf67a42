/* Requests of one port over CAN: each is answered or refused at once, or when what it began has ended. Costs are
 * instructions on a Cortex-M4F. */
#ifndef BRACE_WIRE_CAN_REQUESTS_H
#define BRACE_WIRE_CAN_REQUESTS_H

#include "wire/answers/answer.h"
#include "wire/can/answers.h"
#include "wire/can/queue.h"
#include "wire/wire.h"

typedef struct {
    can_queue_t queue;      /* that have come and wait */
    can_answers_t answers;  /* on their way out */
    upload_t upload;
    download_t download[CAN_MASTERS];
    asked_force_t asked_force[CAN_MASTERS];
    uint8_t storing;        /* code of the commit or roll-back that is answered once the store has ended; 0: none */
    uint8_t storing_token;
    brace_seal_t seal[BRACE_SEALS_MOST]; /* that have come, each for the command with its token */
    uint8_t refusals_left;  /* of questions too many, in this tick */
    uint8_t seal_count;     /* that have come, at most BRACE_SEALS_MOST */
    uint8_t oldest_seal;    /* the next one to be given up */
    bool waits;             /* the queue's question is being worked out: it is asked again in each tick */
} can_requests_t;

/* Answers or refuses a request, or lets it wait. An answer that finds no room is counted.
 *   asker: this port
 *   node_id: of this node
 *   data: its eight bytes
 * returns whether the dictionary has such a request; if not, it is refused too
 * At most 150 instructions beside answer_request, and 120 for each frame of the answer. */
bool can_requests_answer(can_requests_t *requests, const wire_tick_t *tick, brace_asker_t asker, uint32_t node_id,
                         const uint8_t *data);

/* Each tick, before requests are answered: answers the commit or roll-back that this port has asked for, once the store
 * has ended. Takes two frames of room. At most 250 instructions. */
void can_requests_tick(can_requests_t *requests, const wire_tick_t *tick);

#endif
