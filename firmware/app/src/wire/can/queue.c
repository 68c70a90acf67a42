#include "wire/can/queue.h"

#include <stddef.h>
#include <string.h>

void can_queue_clear(can_queue_t *queue)
{
    queue->session_count = queue->before_stop = 0;
    memset(queue->count, 0, sizeof queue->count);
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
