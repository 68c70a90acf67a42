#include "wire/can/queue.h"

#include <stddef.h>
#include <string.h>

void can_queue_clear(can_queue_t *queue)
{
    queue->session_count = queue->before_stop = 0;
    memset(queue->count, 0, sizeof queue->count);
}

bool can_queue_put_session(can_queue_t *queue, const uint8_t data[CAN_REQUEST_BYTES])
{
    if (queue->session_count == (uint32_t)CAN_SESSION_ROOM) {
        return false;
    }
    const uint32_t place = ((uint32_t)queue->session_first + queue->session_count) % (uint32_t)CAN_SESSION_ROOM;
    memcpy(queue->session[place], data, CAN_REQUEST_BYTES);
    queue->session_count++;
    return true;
}

bool can_queue_put_question(can_queue_t *queue, const uint8_t data[CAN_REQUEST_BYTES])
{
    const uint32_t master = can_master_of(data[1]);
    if (queue->count[master] == (uint32_t)CAN_QUESTIONS_EACH) {
        return false;
    }
    const uint32_t place = ((uint32_t)queue->first[master] + queue->count[master]) % (uint32_t)CAN_QUESTIONS_EACH;
    memcpy(queue->question[master][place], data, CAN_REQUEST_BYTES);
    queue->count[master]++;
    return true;
}

const uint8_t *can_queue_take_session(can_queue_t *queue, bool *came_before_stop)
{
    if (queue->session_count == 0u) {
        return NULL;
    }
    const uint8_t *data = queue->session[queue->session_first];
    queue->session_first = (uint8_t)((queue->session_first + 1u) % (uint32_t)CAN_SESSION_ROOM);
    queue->session_count--;
    *came_before_stop = queue->before_stop > 0u;
    queue->before_stop = (uint8_t)(queue->before_stop - *came_before_stop);
    return data;
}

void can_queue_stop(can_queue_t *queue)
{
    queue->before_stop = queue->session_count;
}

const uint8_t *can_queue_next_question(can_queue_t *queue)
{
    for (uint32_t i = 1; i <= (uint32_t)CAN_MASTERS; i++) {
        const uint32_t master = (queue->master + i) % (uint32_t)CAN_MASTERS;
        if (queue->count[master] > 0u) {
            queue->master = (uint8_t)master;
            return can_queue_question(queue);
        }
    }
    return NULL;
}

const uint8_t *can_queue_question(const can_queue_t *queue)
{
    return queue->question[queue->master][queue->first[queue->master]];
}

void can_queue_question_done(can_queue_t *queue)
{
    const uint32_t master = queue->master;
    queue->first[master] = (uint8_t)((queue->first[master] + 1u) % (uint32_t)CAN_QUESTIONS_EACH);
    queue->count[master]--;
}
