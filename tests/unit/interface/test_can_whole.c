/* Requests and answers as a whole go the way of their frames: every member says what the frame's field says. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "brace/answering.h"
#include "brace/can_frames.h"
#include "frame_codecs.h"
#include "brace/status.h"
#include "unity.h"

enum { TRIES = 200, MOST_WORDS = 20, TOKEN = 0x5a };

/* A frame's message is its token and its fields, 32 bits each. */
typedef struct {
    const char *name;
    uint32_t words;
    void (*unpack)(const uint8_t *data, uint32_t *words);
    uint32_t (*pack)(const uint32_t *words, uint8_t *data);
} frame_t;

#define ROW(name, bytes) {#name, sizeof(brace_can_##name##_t) / 4u, unpack_##name, pack_##name},
static const frame_t frames[] = {BRACE_CAN_FRAMES(ROW)};
#undef ROW

typedef struct {
    uint32_t code;
    const char *name;
    uint32_t request_words, answer_words;
} request_t;

#define ROW(code, name) {code, #name, sizeof(brace_##name##_request_t) / 4u, sizeof(brace_##name##_answer_t) / 4u},
static const request_t requests[] = {BRACE_REQUESTS(ROW)};
#undef ROW

static uint32_t seed;

void setUp(void)
{
    seed = 1u;
}

void tearDown(void) {}

static uint8_t any_byte(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint8_t)(seed >> 24);
}

static const frame_t *frame_named(const char *name)
{
    for (uint32_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        if (strcmp(frames[f].name, name) == 0) {
            return &frames[f];
        }
    }
    return NULL;
}

static const frame_t *part_of(const request_t *request, uint32_t part)
{
    char name[80];
    (void)snprintf(name, sizeof name, "%s_answer_%u", request->name, (unsigned)part);
    return frame_named(name);
}

static void test_a_request_has_what_its_frame_says(void)
{
    uint32_t with_fields = 0;
    for (uint32_t r = 0; r < sizeof requests / sizeof *requests; r++) {
        char name[80];
        (void)snprintf(name, sizeof name, "%s_request", requests[r].name);
        const frame_t *frame = frame_named(name);
        if (frame == NULL || frame->words == 1u) { /* it asks without a field */
            continue;
        }
        with_fields++;
        for (uint32_t i = 0; i < TRIES; i++) {
            uint32_t words[MOST_WORDS];
            uint8_t data[8] = {(uint8_t)requests[r].code, TOKEN};
            brace_request_t asked;
            for (uint32_t byte = 2; byte < 8u; byte++) {
                data[byte] = any_byte();
            }
            frame->unpack(data, words);
            brace_can_unpack_request(data, &asked);
            TEST_ASSERT_EQUAL_MESSAGE(frame->words - 1u, requests[r].request_words, name);
            TEST_ASSERT_EQUAL_HEX32_ARRAY_MESSAGE(words + 1, asked.word, frame->words - 1u, name);
        }
    }
    TEST_ASSERT_GREATER_THAN(15, with_fields);
}

/* What a frame can carry comes from frames of any bytes; all of an answer's parts give all of its members. */
static void test_an_answer_says_what_its_frames_say(void)
{
    for (uint32_t r = 0; r < sizeof requests / sizeof *requests; r++) {
        const uint32_t code = requests[r].code, parts = brace_can_answer_parts[code];
        for (uint32_t i = 0; i < TRIES; i++) {
            brace_answer_t answer;
            uint8_t wanted[BRACE_CAN_ANSWER_PARTS_MOST][8], packed[BRACE_CAN_ANSWER_PARTS_MOST][8];
            uint32_t count = 0;
            memset(&answer, 0, sizeof answer);
            for (uint32_t part = 0; part < parts; part++) {
                const frame_t *frame = part_of(&requests[r], part);
                uint32_t words[MOST_WORDS] = {TOKEN};
                TEST_ASSERT_NOT_NULL_MESSAGE(frame, requests[r].name);
                if (frame->words > 1u) {
                    uint8_t any[8];
                    for (uint32_t byte = 0; byte < 8u; byte++) {
                        any[byte] = any_byte();
                    }
                    any[1] = TOKEN;
                    frame->unpack(any, words);
                    memcpy(answer.word + count, words + 1, 4u * (frame->words - 1u));
                    count += frame->words - 1u;
                }
                (void)frame->pack(words, wanted[part]);
            }
            brace_can_pack_answer(code, &answer, TOKEN, packed);
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wanted, packed, 8u * parts, requests[r].name);
            TEST_ASSERT_TRUE_MESSAGE(count == requests[r].answer_words || count == 0u, requests[r].name);
        }
    }
}

/* Each number that an answer with flags tells, far beyond its range: SATURATED, and nothing else in the flags. */
static void test_a_value_beyond_its_range_is_flagged(void)
{
    static const float far = 1e9f;
    brace_k_under_load_at_posture_answer_t k = {.flags = 0};
    for (uint32_t member = 0; member < 7u; member++) {
        brace_answer_t answer;
        uint8_t packed[BRACE_CAN_ANSWER_PARTS_MOST][8];
        memset(&answer, 0, sizeof answer);
        k.buckling_factor = 5.0f;
        answer.k_under_load_at_posture = k;
        memcpy(answer.word + member, &far, 4);
        brace_can_pack_answer(BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, &answer, TOKEN, packed);
        brace_can_k_under_load_at_posture_answer_4_t last;
        brace_can_unpack_k_under_load_at_posture_answer_4(packed[4], &last);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(BRACE_FLAG_SATURATED, last.flags, "flags");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_request_has_what_its_frame_says);
    RUN_TEST(test_an_answer_says_what_its_frames_say);
    RUN_TEST(test_a_value_beyond_its_range_is_flagged);
    return UNITY_END();
}
