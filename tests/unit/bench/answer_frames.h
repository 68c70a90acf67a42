/* Frames of answers: whose they are, and what number a frame of one has. */
#ifndef ANSWER_FRAMES_H
#define ANSWER_FRAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/can_messages.h"

static inline bool is_refusal(const uint8_t *data)
{
    return data[0] == BRACE_ANSWER_REFUSED;
}

/* The code of the request that a frame answers or refuses; 0: a frame of no answer. */
static inline uint32_t answered_code(const uint8_t *data)
{
    return is_refusal(data) ? data[2] : brace_can_answer_frames[data[0]].code;
}

/* The number of a frame of an answer; 0: there is none. */
static inline uint32_t answer_number(uint32_t code, uint32_t part)
{
    for (uint32_t number = 1; number < 255u; number++) {
        const brace_can_answer_frame_t *is = &brace_can_answer_frames[number];
        if (is->parts > 0u && is->code == code && is->part == part) {
            return number;
        }
    }
    return 0;
}

#endif
