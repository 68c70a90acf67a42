/* Requests that have come over one port of CAN and wait for their turn.
 *
 * Whatever belongs to a session (signs of life, seals, commands) waits in one queue, in the order in which it came.
 * Questions wait in a small queue for each master: the upper four bits of a token say which master it is. Masters are
 * answered in turn, one question each, so that nobody's questions starve another's. A token is only what its sender
 * says; so ports take turns first, and only then masters of one port.
 *
 * Pure functions. Costs are instructions on a Cortex-M4F. */
#ifndef BRACE_WIRE_CAN_QUEUE_H
#define BRACE_WIRE_CAN_QUEUE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum {
    CAN_REQUEST_BYTES = 8,
    CAN_MASTERS = 16,
    CAN_QUESTIONS_EACH = 8, /* of one master */
    CAN_SESSION_ROOM = 64   /* as many requests as the STM32's ring holds */
};

typedef struct {
    uint8_t session[CAN_SESSION_ROOM][CAN_REQUEST_BYTES];
    uint8_t session_first, session_count;
    uint8_t before_stop; /* so many of them, the oldest, came before a stop */
    uint8_t question[CAN_MASTERS][CAN_QUESTIONS_EACH][CAN_REQUEST_BYTES];
    uint8_t first[CAN_MASTERS], count[CAN_MASTERS];
    uint8_t master; /* whose question is being answered, or was answered last */
} can_queue_t;

/* The master that sends with such a token. */
static inline uint32_t can_master_of(uint32_t token)
{
    return token >> 4;
}

/* Nothing waits. */
void can_queue_clear(can_queue_t *queue);

/* Both return whether there was room. Inline, because a burst has 72 of them: 12 instructions. */
static inline bool can_queue_put_session(can_queue_t *queue, const uint8_t data[CAN_REQUEST_BYTES])
{
    const uint32_t count = queue->session_count;
    if (count == (uint32_t)CAN_SESSION_ROOM) {
        return false;
    }
    memcpy(queue->session[(queue->session_first + count) % (uint32_t)CAN_SESSION_ROOM], data, CAN_REQUEST_BYTES);
    queue->session_count = (uint8_t)(count + 1u);
    return true;
}

static inline bool can_queue_put_question(can_queue_t *queue, const uint8_t data[CAN_REQUEST_BYTES])
{
    const uint32_t master = can_master_of(data[1]), count = queue->count[master];
    if (count == (uint32_t)CAN_QUESTIONS_EACH) {
        return false;
    }
    const uint32_t place = (queue->first[master] + count) % (uint32_t)CAN_QUESTIONS_EACH;
    memcpy(queue->question[master][place], data, CAN_REQUEST_BYTES);
    queue->count[master] = (uint8_t)(count + 1u);
    return true;
}

/* The oldest request of the session, which leaves the queue; its bytes stay until the next one is put. null: there is
 * none.
 *   came_before_stop (out): whether a stop has come after it */
const uint8_t *can_queue_take_session(can_queue_t *queue, bool *came_before_stop);

/* A stop has come: whatever waits came before it. */
void can_queue_stop(can_queue_t *queue);

/* The next master's oldest question. It stays in the queue until can_queue_question_done. null: there is none. At most
 * 100 instructions. */
const uint8_t *can_queue_next_question(can_queue_t *queue);

/* The question that can_queue_next_question gave last. */
const uint8_t *can_queue_question(const can_queue_t *queue);

/* It has been answered or refused. */
void can_queue_question_done(can_queue_t *queue);

#endif
