/* unpack_NAME and pack_NAME for every frame of BRACE_CAN_FRAMES. They treat a message as words of 32 bits. */
#ifndef BRACE_TEST_FRAME_CODECS_H
#define BRACE_TEST_FRAME_CODECS_H

#include <stdint.h>
#include <string.h>

#include "brace/can_frames.h"

#define BOTH(name, bytes) \
    static void unpack_##name(const uint8_t *data, uint32_t *words) \
    { \
        brace_can_##name##_t message; \
        brace_can_unpack_##name(data, &message); \
        memcpy(words, &message, sizeof message); \
    } \
    static uint32_t pack_##name(const uint32_t *words, uint8_t *data) \
    { \
        brace_can_##name##_t message; \
        memcpy(&message, words, sizeof message); \
        return brace_can_pack_##name(&message, data); \
    }
BRACE_CAN_FRAMES(BOTH)
#undef BOTH

#endif
