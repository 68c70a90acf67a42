#include "wire/can/answers.h"

#include <stddef.h>
#include <string.h>

#include "brace/can_messages.h"

bool can_answers_have_room(const can_answers_t *answers, uint32_t frames)
{
    return answers->count + frames <= (uint32_t)CAN_ANSWERS_ROOM;
}

/* The place of one frame more. */
static uint8_t *next_frame(can_answers_t *answers)
{
    answers->count = (uint8_t)(answers->count + can_answers_have_room(answers, 1));
    return answers->frame[(answers->first + answers->count - 1u) % (uint32_t)CAN_ANSWERS_ROOM];
}

void can_answers_add(can_answers_t *answers, uint8_t (*parts)[8], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) { /* at most BRACE_CAN_ANSWER_PARTS_MOST */
        memcpy(next_frame(answers), parts[i], sizeof answers->frame[0]);
    }
}

void can_answers_refuse(can_answers_t *answers, uint32_t code, uint32_t token, int32_t status, uint32_t detail)
{
    (void)brace_can_pack_refusal(&(brace_can_refusal_t){token, code, status, detail}, next_frame(answers));
}

const uint8_t *can_answers_next(const can_answers_t *answers)
{
    return answers->count > 0u ? answers->frame[answers->first] : NULL;
}

void can_answers_sent(can_answers_t *answers)
{
    answers->first = (uint8_t)((answers->first + 1u) % (uint32_t)CAN_ANSWERS_ROOM);
    answers->count = (uint8_t)(answers->count - (answers->count > 0u));
}
